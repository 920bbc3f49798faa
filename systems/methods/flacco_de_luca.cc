// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/flacco_de_luca.h"

#include <algorithm>
#include <cmath>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/motion_limits.h"
#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/saturated_task.h"

namespace oca::systems {
namespace {

// An entry of a row that is as good as none, m/rad.
constexpr double kNoLever = 1e-9;

}  // namespace

struct FlaccoDeLucaLaw::Motion {
  robot::JointMatrix M;  ///< sum J^T J of the repulsed points
  robot::JointVector b;  ///< sum J^T (J r + v)
  robot::JointVector lower;
  robot::JointVector upper;
};

void FlaccoDeLucaLaw::Params::Describe(Fields<Params>& fields) {
  AddModelAndTip(fields, "link that is repulsed; may be left out if one is last");
  fields.Add("repulsion", &Params::repulsion, "",
             "which links are repulsed: tip, as published, or all");
  fields.Add("repulsion_speed", &Params::repulsion_speed, "m/s", "of a repulsed point near contact")
      .AtLeast(0.0);
  fields
      .Add("influence_distance", &Params::influence_distance, "m",
           "up to which obstacles count; half of the effect is at half of it")
      .Above(0.0);
  fields.Add("alpha", &Params::alpha, "", "steepness of the risk over the distance").Above(0.0);
  fields
      .Add("max_joint_velocity", &Params::max_joint_velocity, "rad/s",
           "bound on every joint's speed, beside the model's limits")
      .Above(0.0);
  AddDamping(fields);
}

FlaccoDeLucaLaw::FlaccoDeLucaLaw(const Params& params, const ModelSet& models)
    : params_(WithDamping(params)),
      model_(FilteredModel(models, params.model)),
      tip_(TipNumber(*model_, params.tip)),
      damping_{params.most_damping, params.damping_threshold} {}

double FlaccoDeLucaLaw::Seen(const Proximity& proximity) const {
  return proximity.distance / robot::RangeShare(proximity, params_.influence_distance);
}

double FlaccoDeLucaLaw::Risk(double distance) const {
  return 1.0 / (1.0 + std::exp(params_.alpha * (2.0 * distance / params_.influence_distance - 1)));
}

bool FlaccoDeLucaLaw::Repulsed(int link) const {
  return params_.repulsion == Repulsion::kAll || model_->body(link) == model_->body(tip_);
}

void FlaccoDeLucaLaw::AddLink(const ProximitySet& set, std::size_t first, int link,
                              std::span<const Eigen::Isometry3d> X_WL, VectorView wish,
                              Motion& motion) const {
  const Proximity* nearest = &set.proximities[first];
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (std::size_t i = first; i < set.proximities.size(); ++i) {
    const Proximity& proximity = set.proximities[i];
    if (proximity.link != nearest->link) continue;
    if (Seen(proximity) < Seen(*nearest)) nearest = &proximity;
    if (Seen(proximity) > params_.influence_distance) continue;
    direction += Risk(Seen(proximity)) * proximity.normal;
  }
  if (Seen(*nearest) > params_.influence_distance) return;
  const double risk = Risk(Seen(*nearest));
  if (Repulsed(link)) {
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, robot::kMostFilteredJoints> J(
        3, model_->num_positions());
    robot::PointJacobian(*model_, X_WL, link, nearest->point_on_link, J);
    const double length = direction.norm();
    const Eigen::Vector3d away = length > 1e-9 ? direction / length : nearest->normal;
    const Eigen::Vector3d v = J.lazyProduct(wish) + params_.repulsion_speed * risk * away;
    motion.M += J.transpose().lazyProduct(J);
    motion.b += J.transpose().lazyProduct(v);
  }
  if (model_->body(link) == model_->body(tip_)) return;
  const robot::JointVector row = RowOf(*model_, X_WL, *nearest);
  for (Eigen::Index j = 0; j < row.size(); ++j) {
    const double limit = std::min(robot::LimitsOf(*model_, j).velocity, params_.max_joint_velocity);
    if (row[j] < -kNoLever) motion.upper[j] = std::min(motion.upper[j], limit * (1.0 - risk));
    if (row[j] > kNoLever) motion.lower[j] = std::max(motion.lower[j], -limit * (1.0 - risk));
  }
}

void FlaccoDeLucaLaw::Choose(const ProximitySet& set, std::span<const Eigen::Isometry3d> X_WL,
                             VectorView wish, AvoidanceVelocity& result) const {
  const Eigen::Index n = wish.size();
  Motion motion{robot::JointMatrix::Zero(n, n), robot::JointVector::Zero(n), robot::JointVector(n),
                robot::JointVector(n)};
  for (Eigen::Index j = 0; j < n; ++j) {
    motion.upper[j] = std::min(robot::LimitsOf(*model_, j).velocity, params_.max_joint_velocity);
  }
  motion.lower = -motion.upper;
  result.share = 0.0;
  result.rows = 0;
  const auto& all = set.proximities;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (Seen(all[i]) <= params_.influence_distance) {
      result.share = std::max(result.share, Risk(Seen(all[i])));
      ++result.rows;
    }
    const auto same = [&](const Proximity& before) { return before.link == all[i].link; };
    const auto here = all.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::any_of(all.begin(), here, same)) continue;
    const int link = robot::NumberOfLink(*model_, all[i].link);
    AddLink(set, i, link, X_WL, wish, motion);
  }
  result.velocity = robot::SaturateInNullspace(motion.M, motion.b, robot::JointVector(wish),
                                               motion.lower, motion.upper, damping_);
}

}  // namespace oca::systems
