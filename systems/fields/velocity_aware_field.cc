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

// With y = -c and u = -v . n: d(|v| y^b)/du = y^(b-1) (b - (b-1) y^2), largest at y^2 = b / (b+1).
double WorstRate(double b) {
  return std::pow(b / (b + 1.0), 0.5 * (b - 1.0)) * 2.0 * b / (b + 1.0);
}

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
    : params_(WithRange(params)),
      worst_(WorstRate(params_.exponent)),
      proximities(DeclareInput<ProximitySet>("proximities")),
      links(DeclareInput<LinkPoses>("links")),
      forces(DeclareOutput<LinkForceSet, &VelocityAwareField::CalcForces>("forces", {}, proximities,
                                                                          links)),
      slopes(DeclareOutput<ContactSlopes, &VelocityAwareField::CalcSlopes>("slopes", {},
                                                                           proximities, links)) {
  DeclareRole(Repels{params_.max_distance});
  DeclareRole(Limits{.shown = Limits::Shown::kListed,
                     .signal = forces,
                     .member = "forces",
                     .how = "pushed, approaching"});
}

double VelocityAwareField::Potential(const Eigen::Vector3d& x, const Eigen::Vector3d& v) const {
  const double p = x.norm();
  const double speed = v.norm();
  const double approach = -v.dot(x) / p;
  if (p >= params_.max_distance || approach <= 0.0) return 0.0;
  const double fade = 1.0 - p / params_.max_distance;
  return params_.velocity_gain * speed * std::pow(approach / speed, params_.exponent) * fade *
         fade / p;
}

Eigen::Vector3d VelocityAwareField::Force(double distance, const Eigen::Vector3d& normal,
                                          const Eigen::Vector3d& v) const {
  const double speed = v.norm();
  const double approach = -v.dot(normal);
  const double rho0 = params_.max_distance;
  if (distance >= rho0 || approach <= 0.0) return Eigen::Vector3d::Zero();
  const double p = std::max(distance, params_.min_distance);
  const double y = approach / speed;
  const double s = (1.0 - p / rho0) * (1.0 - p / rho0) / p;
  const double minus_ds = 1.0 / (p * p) - 1.0 / (rho0 * rho0);
  const Eigen::Vector3d sideways = v + approach * normal;
  const double common = params_.velocity_gain * std::pow(y, params_.exponent - 1.0);
  return common * (params_.exponent * s / p * sideways + approach * minus_ds * normal);
}

Eigen::Vector3d VelocityAwareField::SlopeOf(const Proximity& proximity, double distance,
                                            const Eigen::Vector3d& v) const {
  const double approach = -v.dot(proximity.normal);
  const double rho0 = params_.max_distance;
  if (approach <= 0.0) return Eigen::Vector3d::Zero();
  const double p = std::max(distance, params_.min_distance);
  const double s = (1.0 - p / rho0) * (1.0 - p / rho0) / p;
  const double minus_ds = 1.0 / (p * p) - 1.0 / (rho0 * rho0);
  const Eigen::Vector3d sideways = v + approach * proximity.normal;
  const double common =
      params_.velocity_gain * std::pow(approach / v.norm(), params_.exponent - 1.0);
  return common * (params_.exponent * (minus_ds / p + s / (p * p)) * sideways +
                   approach * 2.0 / (p * p * p) * proximity.normal);
}

void VelocityAwareField::CalcForces(const ProximitySet& set, const LinkPoses& poses,
                                    LinkForceSet& result) const {
  int hint = 0;
  ForcePerProximity(set, result, [&](const Proximity& proximity) {
    const Eigen::Vector3d v = RelativeVelocity(proximity, poses, hint);
    return Force(SeenDistance(proximity, params_.max_distance), proximity.normal, v);
  });
}

void VelocityAwareField::CalcSlopes(const ProximitySet& set, const LinkPoses& poses,
                                    ContactSlopes& result) const {
  int hint = 0;
  SlopePerProximity(set, result, [&](const Proximity& proximity) -> std::optional<ContactSlope> {
    const double share = robot::RangeShare(proximity, params_.max_distance);
    const double seen = proximity.distance / share;
    if (seen >= params_.max_distance) return std::nullopt;
    const Eigen::Vector3d v = RelativeVelocity(proximity, poses, hint);
    const double p = std::max(seen, params_.min_distance);
    const double rate = params_.velocity_gain * worst_ *
                        (1.0 / (p * p) - 1.0 / (params_.max_distance * params_.max_distance));
    return SlopeAt(proximity, SlopeOf(proximity, seen, v) / share, rate * proximity.normal);
  });
}

}  // namespace oca::systems
