// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/vortex_field.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "oca/models/robot/kinematics.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/fields/force_per_proximity.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

// Share of `up` in the way around, for requests that lead straight at the obstacle.
constexpr double kUpShare = 0.05;
// Time within which the distance to the request counts as a velocity, s.
constexpr double kCatchUp = 1.0;
// Less than this is no direction.
constexpr double kNothing = 1e-9;

}  // namespace

struct VortexField::Axes {
  Eigen::Matrix3Xd axes;
  Eigen::VectorXd wish;
  Eigen::Matrix3Xd J_v;
  std::vector<Eigen::Isometry3d> reordered;
  std::vector<const Proximity*> nearest;
};

void VortexField::Params::Describe(Fields<Params>& fields) {
  AddModel(fields);
  fields.Add("force_gain", &Params::force_gain, "N m^3", "as of a RepulsiveField").AtLeast(0.0);
  fields.Add("max_distance", &Params::max_distance, "m", "as of a RepulsiveField").Above(0.0);
  fields.Add("min_distance", &Params::min_distance, "m", "as of a RepulsiveField").Above(0.0);
  fields
      .Add("turn", &Params::turn, "rad",
           "by how much the force is turned off the normal far from contact; 0 is a RepulsiveField")
      .AtLeast(0.0)
      .AtMost(1.5);
  AddControlPeriod(fields);
}

VortexField::VortexField(const Params& params, const ModelSet& models)
    : params_(WithRange(params)),
      model_(MovableModel(models, params.model)),
      law_{params_.force_gain, params_.max_distance, params_.min_distance},
      held_(DeclareDiscreteState("held", {3 * model_->num_links(), Unit::Any()}, 0.0)),
      proximities(DeclareInput<ProximitySet>("proximities")),
      links(DeclareInput<LinkPoses>("links")),
      position(DeclareInput<Vector>("position", DeltaSpec(*model_))),
      velocity(DeclareOptionalInput<Vector>("velocity", RateSpec(*model_))),
      measured_position(DeclareInput<Vector>("measured_position", PositionSpec(*model_))),
      axes_(DeclareCached<&VortexField::CalcAxes>(proximities, links, position, velocity,
                                                  measured_position, held_)),
      forces(
          DeclareOutput<LinkForceSet, &VortexField::CalcForces>("forces", {}, proximities, axes_)),
      slopes(DeclareOutput<ContactSlopes, &VortexField::CalcSlopes>("slopes", {}, proximities,
                                                                    axes_)) {
  DeclareUpdate<&VortexField::Update>(Every{params_.period}, Writes(held_), axes_);
  DeclareRole(Repels{params_.max_distance});
  DeclareRole(Limits{
      .shown = Limits::Shown::kBelow, .signal = proximities, .bound = {params_.max_distance}});
}

double VortexField::Angle(double distance) const {
  return params_.turn * std::clamp(2.0 * distance / params_.max_distance, 0.0, 1.0);
}

Eigen::Vector3d VortexField::Force(const Proximity& proximity, const Eigen::Vector3d& axis) const {
  const double seen = SeenDistance(proximity, params_.max_distance);
  const double phi = Angle(seen);
  return law_.Force(seen) *
         (std::cos(phi) * proximity.normal + std::sin(phi) * axis.cross(proximity.normal));
}

Eigen::Vector3d VortexField::ChooseAxis(const Proximity& nearest, const Eigen::Vector3d& way,
                                        const Eigen::Matrix3d& R_WB) const {
  const double length = way.norm();
  Eigen::Vector3d towards = kUpShare * R_WB.col(2);
  if (length > kNothing) towards += way / length;
  Eigen::Vector3d axis = nearest.normal.cross(towards);
  if (axis.norm() < kNothing) axis = nearest.normal.cross(R_WB.col(0));
  if (axis.norm() < kNothing) axis = nearest.normal.cross(R_WB.col(1));
  return axis.normalized();
}

void VortexField::CalcAxes(const ProximitySet& set, const LinkPoses& poses, VectorView request,
                           OptionalVector rate, VectorView measured, VectorView held,
                           Axes& result) const {
  result.axes.resize(3, model_->num_links());
  result.J_v.resize(3, model_->num_positions());
  result.nearest.assign(model_->links().size(), nullptr);
  for (const Proximity& proximity : set.proximities) {
    const double seen = SeenDistance(proximity, params_.max_distance);
    if (seen > params_.max_distance) continue;
    const Proximity*& nearest = result.nearest[LinkNumber(*model_, proximity.link, "proximities")];
    if (nearest == nullptr || seen < SeenDistance(*nearest, params_.max_distance)) {
      nearest = &proximity;
    }
  }
  result.wish = (request - measured) / kCatchUp;
  if (rate) result.wish += *rate;
  const auto X_WL = PosesInOrder(*model_, poses, result.reordered);
  for (int link = 0; link < model_->num_links(); ++link) {
    const Proximity* const nearest = result.nearest[link];
    auto axis = result.axes.col(link);
    axis = held.segment<3>(3 * link);
    if (nearest == nullptr) {
      axis.setZero();
    } else if (axis.isZero(0.0)) {
      robot::PointJacobian(*model_, X_WL, link, nearest->point_on_link, result.J_v);
      Eigen::Vector3d way = -nearest->obstacle_velocity;
      way.noalias() += result.J_v * result.wish;
      axis = ChooseAxis(*nearest, way, X_WL[0].linear());
    }
  }
}

void VortexField::CalcForces(const ProximitySet& set, const Axes& about,
                             LinkForceSet& result) const {
  ForcePerProximity(set, result, [&](const Proximity& proximity) {
    return Force(proximity, about.axes.col(LinkNumber(*model_, proximity.link, "proximities")));
  });
}

void VortexField::CalcSlopes(const ProximitySet& set, const Axes& about,
                             ContactSlopes& result) const {
  SlopePerProximity(set, result, [&](const Proximity& proximity) -> std::optional<ContactSlope> {
    const double share = robot::RangeShare(proximity, params_.max_distance);
    const double seen = proximity.distance / share;
    if (seen > params_.max_distance) return std::nullopt;
    const Eigen::Vector3d axis = about.axes.col(LinkNumber(*model_, proximity.link, "proximities"));
    const Eigen::Vector3d& n = proximity.normal;
    const Eigen::Vector3d t = axis.cross(n);
    const double phi = Angle(seen);
    const bool turning = seen > 0.0 && phi < params_.turn;
    const double dphi = turning ? 2.0 * params_.turn / params_.max_distance : 0.0;
    const Eigen::Vector3d slope = law_.Slope(seen) * (std::cos(phi) * n + std::sin(phi) * t) -
                                  law_.Force(seen) * dphi * (std::cos(phi) * t - std::sin(phi) * n);
    return SlopeAt(proximity, slope / share);
  });
}

void VortexField::Update(const Axes& about, MutableVectorView next) const {
  next = about.axes.reshaped();
}

}  // namespace oca::systems
