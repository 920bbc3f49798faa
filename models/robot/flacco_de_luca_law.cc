// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/flacco_de_luca_law.h"

#include <algorithm>
#include <cmath>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/motion_limits.h"
#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/saturated_task.h"

namespace oca::robot {
namespace {

// An entry of a row that is as good as none, m/rad.
constexpr double kNoLever = 1e-9;

/// The problem of a tick.
class RepulsedMotion {
 public:
  RepulsedMotion(const FlaccoDeLucaLaw& law, const RobotModel& model,
                 std::span<const Eigen::Isometry3d> X_WL,
                 const Eigen::Ref<const Eigen::VectorXd>& wish)
      : law_(law), model_(model), X_WL_(X_WL), wish_(wish) {
    const Eigen::Index n = wish.size();
    M_ = JointMatrix::Zero(n, n);
    b_ = JointVector::Zero(n);
    upper_.resize(n);
    for (Eigen::Index j = 0; j < n; ++j) upper_[j] = FullSpeed(j);
    lower_ = -upper_;
  }

  void Add(const ProximitySet& set, AvoidanceVelocity& result) {
    const auto& all = set.proximities;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (Seen(all[i]) <= law_.influence_distance) {
        result.share = std::max(result.share, law_.Risk(Seen(all[i])));
        ++result.rows;
      }
      const auto same = [&](const Proximity& before) { return before.link == all[i].link; };
      const auto here = all.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::any_of(all.begin(), here, same)) continue;
      AddLink(set, i, NumberOfLink(model_, all[i].link));
    }
  }

  JointVector Solve() const {
    return SaturateInNullspace(M_, b_, JointVector(wish_), lower_, upper_, law_.damping);
  }

 private:
  double FullSpeed(Eigen::Index j) const {
    return std::min(LimitsOf(model_, j).velocity, law_.max_joint_velocity);
  }
  /// The distance as it counts: of own links so that they begin to at their range.
  double Seen(const Proximity& proximity) const {
    return proximity.distance / RangeShare(proximity, law_.influence_distance);
  }
  bool MovesWithTip(int link) const { return model_.body(link) == model_.body(law_.tip); }

  /// All of one link, `first` being the first of them.
  void AddLink(const ProximitySet& set, std::size_t first, int link) {
    const Proximity* nearest = &set.proximities[first];
    Eigen::Vector3d direction = Eigen::Vector3d::Zero();
    for (std::size_t i = first; i < set.proximities.size(); ++i) {
      const Proximity& proximity = set.proximities[i];
      if (proximity.link != nearest->link) continue;
      if (Seen(proximity) < Seen(*nearest)) nearest = &proximity;
      if (Seen(proximity) > law_.influence_distance) continue;
      direction += law_.Risk(Seen(proximity)) * proximity.normal;
    }
    if (Seen(*nearest) > law_.influence_distance) return;
    const double risk = law_.Risk(Seen(*nearest));
    if (law_.all_links || MovesWithTip(link)) Repulse(*nearest, link, direction, risk);
    if (!MovesWithTip(link)) HoldBack(*nearest, risk);
  }

  void Repulse(const Proximity& nearest, int link, const Eigen::Vector3d& direction, double risk) {
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMostFilteredJoints> J(3,
                                                                          model_.num_positions());
    PointJacobian(model_, X_WL_, link, nearest.point_on_link, J);
    const double length = direction.norm();
    const Eigen::Vector3d away = length > 1e-9 ? direction / length : nearest.normal;
    const Eigen::Vector3d v = J.lazyProduct(wish_) + law_.repulsion_speed * risk * away;
    M_ += J.transpose().lazyProduct(J);
    b_ += J.transpose().lazyProduct(v);
  }

  void HoldBack(const Proximity& nearest, double risk) {
    const JointVector row = DistanceRow(model_, X_WL_, nearest);
    for (Eigen::Index j = 0; j < row.size(); ++j) {
      const double limit = FullSpeed(j);
      if (row[j] < -kNoLever) upper_[j] = std::min(upper_[j], limit * (1.0 - risk));
      if (row[j] > kNoLever) lower_[j] = std::max(lower_[j], -limit * (1.0 - risk));
    }
  }

  const FlaccoDeLucaLaw& law_;
  const RobotModel& model_;
  const std::span<const Eigen::Isometry3d> X_WL_;
  const Eigen::Ref<const Eigen::VectorXd>& wish_;
  JointMatrix M_;  ///< sum J^T J of the repulsed points
  JointVector b_;  ///< sum J^T (J r + v)
  JointVector lower_;
  JointVector upper_;
};

}  // namespace

double FlaccoDeLucaLaw::Risk(double distance) const {
  return 1.0 / (1.0 + std::exp(alpha * (2.0 * distance / influence_distance - 1)));
}

void FlaccoDeLucaLaw::Choose(const RobotModel& model, const ProximitySet& set,
                             std::span<const Eigen::Isometry3d> X_WL,
                             const Eigen::Ref<const Eigen::VectorXd>& wish,
                             AvoidanceVelocity& result) const {
  result.share = 0.0;
  result.rows = 0;
  RepulsedMotion motion(*this, model, X_WL, wish);
  motion.Add(set, result);
  result.velocity = motion.Solve();
}

}  // namespace oca::robot
