// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/task_priority_law.h"

#include <algorithm>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"

namespace oca::robot {
namespace {

// A row that falls short by this much counts in full, m/s.
constexpr double kFullShortfall = 0.1;
// Share of activation_distance within which a row counts in full.
constexpr double kFullShare = 0.5;
// Where a row begins to weigh more than others that are far, and what bounds that at contact, m.
constexpr double kCloseRow = 0.05;
constexpr double kTouchingRow = 0.01;

/// The normal equations of the proximities' rows.
struct EvadingRows {
  JointMatrix M;  ///< sum a J_o^T J_o
  JointVector b;  ///< sum a J_o^T e
  double swap{0.0};
  int count{0};
};

void AddEvadingRow(const TaskPriorityLaw& law, const RobotModel& model,
                   std::span<const Eigen::Isometry3d> X_WL,
                   const Eigen::Ref<const Eigen::VectorXd>& wish, const Proximity& proximity,
                   EvadingRows& sums) {
  const double share = RangeShare(proximity, law.activation_distance);
  const double d = proximity.distance / share;
  sums.swap = std::max(sums.swap, Fade(d, law.contact_distance, law.swap_distance));
  const double near = Fade(d, kFullShare * law.activation_distance, law.activation_distance);
  if (near <= 0.0) return;
  const JointVector J = DistanceRow(model, X_WL, proximity);
  const double speed =
      std::min(law.approach_gain * share * (law.safe_distance - d), law.retreat_speed);
  const double asked = proximity.normal.dot(proximity.obstacle_velocity) + speed;
  const double e = asked - J.dot(wish);
  if (e <= 0.0) return;
  const double closeness = kCloseRow / (std::max(d, 0.0) + kTouchingRow);
  const double weight = near * std::min(1.0, e / kFullShortfall) * (1.0 + closeness * closeness);
  sums.M += (weight * J).lazyProduct(J.transpose());
  sums.b += weight * e * J;
  ++sums.count;
}

/// J_e^T J_e
JointMatrix TipTaskMatrix(const TaskPriorityLaw& law, const RobotModel& model,
                          std::span<const Eigen::Isometry3d> X_WL) {
  Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMostFilteredJoints> J(6, model.num_positions());
  LinkJacobian(model, X_WL, law.tip, J);
  if (!law.keeps_orientation) J.bottomRows<3>().setZero();
  return J.transpose().lazyProduct(J);
}

}  // namespace

void TaskPriorityLaw::Choose(const RobotModel& model, const ProximitySet& set,
                             std::span<const Eigen::Isometry3d> X_WL,
                             const Eigen::Ref<const Eigen::VectorXd>& wish,
                             AvoidanceVelocity& result) const {
  const Eigen::Index n = wish.size();
  EvadingRows sums{JointMatrix::Zero(n, n), JointVector::Zero(n)};
  for (const Proximity& proximity : set.proximities) {
    AddEvadingRow(*this, model, X_WL, wish, proximity, sums);
  }
  result.velocity = wish;
  result.share = sums.swap;
  result.rows = sums.count;
  if (sums.count == 0) return;
  if (sums.swap < 1.0) {
    const JointMatrix N = FilteredNullspace(TipTaskMatrix(*this, model, X_WL), damping);
    const JointMatrix NM = N.lazyProduct(sums.M);
    const JointVector aside = SolveFiltered(NM.lazyProduct(N), N * sums.b, damping);
    result.velocity += (1.0 - sums.swap) * (N * aside);
  }
  if (sums.swap > 0.0) result.velocity += sums.swap * SolveFiltered(sums.M, sums.b, damping);
}

}  // namespace oca::robot
