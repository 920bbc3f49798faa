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
      proximities(DeclareInput<ProximitySet>("proximities")),
      forces(DeclareOutput<LinkForceSet, &RepulsiveField::CalcForces>("forces", {}, proximities)),
      slopes(DeclareOutput<ContactSlopes, &RepulsiveField::CalcSlopes>("slopes", {}, proximities)) {
  DeclareRole(Repels{params_.max_distance});
  DeclareRole(Limits{
      .shown = Limits::Shown::kBelow, .signal = proximities, .bound = {params_.max_distance}});
}

double RepulsiveField::Magnitude(double distance) const {
  if (distance > params_.max_distance) return 0.0;
  const double rho = std::max(distance, params_.min_distance);
  return params_.force_gain * (1.0 / rho - 1.0 / params_.max_distance) / (rho * rho);
}

double RepulsiveField::Slope(double distance) const {
  if (distance > params_.max_distance) return 0.0;
  const double rho = std::max(distance, params_.min_distance);
  return params_.force_gain * (3.0 / rho - 2.0 / params_.max_distance) / (rho * rho * rho);
}

void RepulsiveField::CalcForces(const ProximitySet& proximity_set, LinkForceSet& force_set) const {
  ForcePerProximity(proximity_set, force_set, [&](const Proximity& proximity) -> Eigen::Vector3d {
    return Magnitude(SeenDistance(proximity, params_.max_distance)) * proximity.normal;
  });
}

void RepulsiveField::CalcSlopes(const ProximitySet& proximity_set,
                                ContactSlopes& contact_slopes) const {
  SlopePerProximity(proximity_set, contact_slopes,
                    [&](const Proximity& proximity) -> std::optional<ContactSlope> {
                      const double share = robot::RangeShare(proximity, params_.max_distance);
                      const double seen = proximity.distance / share;
                      if (seen > params_.max_distance) return std::nullopt;
                      return SlopeAt(proximity, Slope(seen) / share * proximity.normal);
                    });
}

}  // namespace oca::systems
