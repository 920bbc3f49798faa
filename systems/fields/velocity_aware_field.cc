// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/velocity_aware_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/fields/force_per_proximity.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

/// How fast the link's point moves as seen from the obstacle's.
Eigen::Vector3d RelativeVelocity(const Proximity& proximity, const LinkPoses& poses, int& hint) {
  const auto at = [&](models::Name link, const Eigen::Vector3d& point) -> Eigen::Vector3d {
    hint = poses.Find(link, std::max(hint, 0));
    if (hint < 0) {
      throw ConfigError(
          fmt::format("proximities: got one of '{}'; expected a link of `links`", link.text()));
    }
    return poses.VelocityAt(hint, point);
  };
  if (poses.velocities.size() != poses.size()) {
    throw ConfigError(
        "links: got no velocities; expected them (connect `velocity` of the RobotKinematics)");
  }
  if (proximity.own_link.empty()) {
    return at(proximity.link, proximity.point_on_link) - proximity.obstacle_velocity;
  }
  const Eigen::Vector3d other = at(proximity.own_link, proximity.point_on_obstacle);
  return at(proximity.link, proximity.point_on_link) - other;
}

}  // namespace

void VelocityAwareField::Params::Describe(Fields<Params>& fields) {
  fields.Add("velocity_gain", &Params::velocity_gain, "N m s", "gain lambda of the potential")
      .AtLeast(0.0);
  fields
      .Add("exponent", &Params::exponent, "",
           "beta; the larger, the more only a head-on way counts")
      .AtLeast(2.0);
  AddRange(fields);
}

VelocityAwareField::VelocityAwareField(const Params& params)
    : law_{WithRange(params).velocity_gain, params.exponent, params.max_distance,
           params.min_distance},
      proximities(DeclareInput<ProximitySet>("proximities")),
      links(DeclareInput<LinkPoses>("links")),
      forces(DeclareOutput<LinkForceSet, &VelocityAwareField::CalcForces>("forces", {}, proximities,
                                                                          links)),
      slopes(DeclareOutput<ContactSlopes, &VelocityAwareField::CalcSlopes>("slopes", {},
                                                                           proximities, links)) {
  DeclareRole(Repels{params.max_distance});
  DeclareRole(Limits{.shown = Limits::Shown::kListed,
                     .signal = forces,
                     .member = "forces",
                     .how = "pushed, approaching"});
}

void VelocityAwareField::CalcForces(const ProximitySet& set, const LinkPoses& poses,
                                    LinkForceSet& result) const {
  int hint = 0;
  ForcePerProximity(set, result, [&](const Proximity& proximity) {
    const Eigen::Vector3d v = RelativeVelocity(proximity, poses, hint);
    return law_.Force(SeenDistance(proximity, law_.range), proximity.normal, v);
  });
}

void VelocityAwareField::CalcSlopes(const ProximitySet& set, const LinkPoses& poses,
                                    ContactSlopes& result) const {
  int hint = 0;
  SlopePerProximity(set, result, [&](const Proximity& proximity) -> std::optional<ContactSlope> {
    const double share = robot::RangeShare(proximity, law_.range);
    const double seen = proximity.distance / share;
    if (seen >= law_.range) return std::nullopt;
    const Eigen::Vector3d v = RelativeVelocity(proximity, poses, hint);
    return SlopeAt(proximity, law_.Slope(seen, proximity.normal, v) / share,
                   law_.Damping(seen) * proximity.normal);
  });
}

}  // namespace oca::systems
