// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/repulsive_field.h"

#include <algorithm>

#include "oca/systems/fields/force_per_proximity.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
void RepulsiveField::Params::Describe(Fields<Params>& fields) {
  fields.Add("force_gain", &Params::force_gain, "N m^3", "gain eta of eq. (3.1)").AtLeast(0.0);
  AddRange(fields);
}

RepulsiveField::RepulsiveField(const Params& params)
    : params_(WithRange(params)),
      law_{params_.force_gain, params_.max_distance, params_.min_distance},
      proximities(DeclareInput<ProximitySet>("proximities")),
      forces(DeclareOutput<LinkForceSet, &RepulsiveField::CalcForces>("forces", {}, proximities)),
      slopes(DeclareOutput<ContactSlopes, &RepulsiveField::CalcSlopes>("slopes", {}, proximities)) {
  DeclareRole(Repels{params_.max_distance});
  DeclareRole(Limits{
      .shown = Limits::Shown::kBelow, .signal = proximities, .bound = {params_.max_distance}});
}

void RepulsiveField::CalcForces(const ProximitySet& proximity_set, LinkForceSet& force_set) const {
  ForcePerProximity(proximity_set, force_set, [&](const Proximity& proximity) -> Eigen::Vector3d {
    return law_.Force(SeenDistance(proximity, params_.max_distance)) * proximity.normal;
  });
}

void RepulsiveField::CalcSlopes(const ProximitySet& proximity_set,
                                ContactSlopes& contact_slopes) const {
  SlopePerProximity(proximity_set, contact_slopes,
                    [&](const Proximity& proximity) -> std::optional<ContactSlope> {
                      const double share = robot::RangeShare(proximity, params_.max_distance);
                      const double seen = proximity.distance / share;
                      if (seen > params_.max_distance) return std::nullopt;
                      return SlopeAt(proximity, law_.Slope(seen) / share * proximity.normal);
                    });
}

}  // namespace oca::systems
