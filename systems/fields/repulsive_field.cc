// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/repulsive_field.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

RepulsiveField::Params Checked(const RepulsiveField::Params& params) {
  Validated(params);
  if (params.min_distance >= params.max_distance) {
    throw ConfigError(fmt::format("min_distance: got {} m; expected less than max_distance, {} m",
                                  params.min_distance, params.max_distance));
  }
  return params;
}

}  // namespace

void RepulsiveField::Params::Describe(Fields<Params>& fields) {
  fields.Add("force_gain", &Params::force_gain, "N m^3", "gain eta of eq. (3.1)").AtLeast(0.0);
  fields
      .Add("max_distance", &Params::max_distance, "m",
           "limit distance rho0 of the field, beyond which the force is 0")
      .Above(0.0);
  fields
      .Add("min_distance", &Params::min_distance, "m",
           "distance below which the force stays the same, so that it is finite in contact")
      .Above(0.0);
}

RepulsiveField::RepulsiveField(const Params& params)
    : params_(Checked(params)),
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
  force_set.forces.clear();
  force_set.forces.reserve(proximity_set.proximities.capacity());  // so no later tick allocates
  for (const Proximity& proximity : proximity_set.proximities) {
    force_set.forces.push_back({proximity.link, proximity.obstacle,
                                Magnitude(proximity.distance) * proximity.normal,
                                proximity.point_on_link});
  }
}

void RepulsiveField::CalcSlopes(const ProximitySet& proximity_set,
                                ContactSlopes& contact_slopes) const {
  contact_slopes.slopes.clear();
  contact_slopes.slopes.reserve(proximity_set.proximities.capacity());
  for (const Proximity& proximity : proximity_set.proximities) {
    if (proximity.distance > params_.max_distance) continue;
    contact_slopes.slopes.push_back(
        SlopeAt(proximity, Slope(proximity.distance) * proximity.normal));
  }
}

}  // namespace oca::systems
