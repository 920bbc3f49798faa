// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/task_priority.h"

#include <algorithm>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/basics/require.h"

namespace oca::systems {
namespace {

// A row that falls short by this much counts in full, m/s.
constexpr double kFullShortfall = 0.1;
// Share of activation_distance within which a row counts in full.
constexpr double kFullShare = 0.5;
// Where a row begins to weigh more than others that are far, and what bounds that at contact, m.
constexpr double kClose = 0.05;
constexpr double kContact = 0.01;

TaskPriorityLaw::Params Checked(const TaskPriorityLaw::Params& params) {
  WithDamping(params);
  RequireAbove("swap_distance", params.swap_distance, params.contact_distance);
  return params;
}

}  // namespace

struct TaskPriorityLaw::Rows {
  robot::JointMatrix M;  ///< sum a J_o^T J_o
  robot::JointVector b;  ///< sum a J_o^T e
  double swap{0.0};
  int count{0};
};

void TaskPriorityLaw::Params::Describe(Fields<Params>& fields) {
  AddModelAndTip(fields, "link whose motion is kept; may be left out if one is last");
  fields.Add("tip_task", &Params::tip_task, "", "what of it is kept: position or pose");
  fields.Add("safe_distance", &Params::safe_distance, "m", "distance that is aimed at").AtLeast(0);
  fields
      .Add("approach_gain", &Params::approach_gain, "1/s",
           "share of the distance left that may be used up in a second")
      .Above(0.0);
  fields
      .Add("retreat_speed", &Params::retreat_speed, "m/s",
           "largest speed of a retreat from an obstacle at rest")
      .AtLeast(0.0);
  fields
      .Add("activation_distance", &Params::activation_distance, "m",
           "from where on a proximity counts; in full at half of it")
      .Above(0.0);
  fields
      .Add("swap_distance", &Params::swap_distance, "m",
           "from where on the roles of tip and avoidance swap; above contact_distance")
      .Above(0.0);
  fields.Add("contact_distance", &Params::contact_distance, "m", "where they have swapped")
      .AtLeast(0.0);
  AddDamping(fields);
}

TaskPriorityLaw::TaskPriorityLaw(const Params& params, const ModelSet& models)
    : params_(Checked(params)),
      model_(FilteredModel(models, params.model)),
      tip_(TipNumber(*model_, params.tip)),
      damping_{params.most_damping, params.damping_threshold} {}

robot::JointMatrix TaskPriorityLaw::TipTaskMatrix(std::span<const Eigen::Isometry3d> X_WL) const {
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, robot::kMostFilteredJoints> J(
      6, model_->num_positions());
  robot::LinkJacobian(*model_, X_WL, tip_, J);
  if (params_.tip_task == TipTask::kPosition) J.bottomRows<3>().setZero();
  return J.transpose().lazyProduct(J);
}

void TaskPriorityLaw::AddRow(const Proximity& proximity, std::span<const Eigen::Isometry3d> X_WL,
                             VectorView wish, Rows& sums) const {
  const double share = robot::RangeShare(proximity, params_.activation_distance);
  const double d = proximity.distance / share;
  sums.swap = std::max(sums.swap, robot::Fade(d, params_.contact_distance, params_.swap_distance));
  const double near =
      robot::Fade(d, kFullShare * params_.activation_distance, params_.activation_distance);
  if (near <= 0.0) return;
  const robot::JointVector J = RowOf(*model_, X_WL, proximity);
  const double speed =
      std::min(params_.approach_gain * share * (params_.safe_distance - d), params_.retreat_speed);
  const double asked = proximity.normal.dot(proximity.obstacle_velocity) + speed;
  const double e = asked - J.dot(wish);
  if (e <= 0.0) return;
  const double closeness = kClose / (std::max(d, 0.0) + kContact);
  const double weight = near * std::min(1.0, e / kFullShortfall) * (1.0 + closeness * closeness);
  sums.M += (weight * J).lazyProduct(J.transpose());
  sums.b += weight * e * J;
  ++sums.count;
}

void TaskPriorityLaw::Choose(const ProximitySet& set, std::span<const Eigen::Isometry3d> X_WL,
                             VectorView wish, AvoidanceVelocity& result) const {
  const Eigen::Index n = wish.size();
  Rows sums{robot::JointMatrix::Zero(n, n), robot::JointVector::Zero(n)};
  for (const Proximity& proximity : set.proximities) AddRow(proximity, X_WL, wish, sums);
  result.velocity = wish;
  result.share = sums.swap;
  result.rows = sums.count;
  if (sums.count == 0) return;
  if (sums.swap < 1.0) {
    const robot::JointMatrix N = robot::FilteredNullspace(TipTaskMatrix(X_WL), damping_);
    const robot::JointMatrix NM = N.lazyProduct(sums.M);
    const robot::JointVector aside = robot::SolveFiltered(NM.lazyProduct(N), N * sums.b, damping_);
    result.velocity += (1.0 - sums.swap) * (N * aside);
  }
  if (sums.swap > 0.0) {
    result.velocity += sums.swap * robot::SolveFiltered(sums.M, sums.b, damping_);
  }
}

}  // namespace oca::systems
