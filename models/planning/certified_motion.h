// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "oca/models/planning/batch_clearance.h"
#include "oca/models/robot/clearance.h"

namespace oca::planning {

/// Looks at straight motions of a robot's joints among bodies at rest: at samples, which prove
/// nothing, and for a proof that it stays clear everywhere.
///
/// For the proof a motion is cut into pieces, eight of which are looked at at once: one is clear
/// if, from its middle, no link can travel as near to anything as the margin (BatchClearance), else
/// it is halved.
/// source Schwarzer, Saha, Latombe, Adaptive Dynamic Collision Checking for Single and Multiple
///        Articulated Robots in Complex Environments, 2005; the bound: robot::TravelBound
class CertifiedMotion {
 public:
  /// Every pair has to stay at least `margin` (m, >= 0) apart, as the clearance counts it. The
  /// clearance must outlive this.
  CertifiedMotion(robot::Clearance& clearance, double margin);

  /// Whether the position itself is clear.
  bool Clear(const Eigen::Ref<const Eigen::VectorXd>& q);
  /// Whether the motion from q_0 to q_1 is proved clear; samples, which say no at little cost,
  /// first. With `room` (m) it says no, too, where these do not keep so much more than the margin.
  bool Clear(const Eigen::Ref<const Eigen::VectorXd>& q_0,
             const Eigen::Ref<const Eigen::VectorXd>& q_1, double room = 0.0);
  /// The share of the motion from q_0 to q_1, from its start, that is proved clear; 0 to 1.
  double ClearShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                    const Eigen::Ref<const Eigen::VectorXd>& q_1);
  /// How much more than the margin, m, samples may keep, that a proof may succeed between them: up
  /// to `most`, as far as both positions leave twice that.
  double RoomOf(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                const Eigen::Ref<const Eigen::VectorXd>& q_1, double most);
  /// Whether all samples on the way are farther from anything than margin and `room`: these are at
  /// most `spacing` (2-norm of the joints) apart, q_1 included and q_0 not, but no more than 1000.
  bool SamplesClear(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                    const Eigen::Ref<const Eigen::VectorXd>& q_1, double spacing, double room);
  /// The share before the first of these samples that is not.
  double SampledShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                      const Eigen::Ref<const Eigen::VectorXd>& q_1, double spacing, double room);

  /// How often something was looked at so far: eight configurations at once, or fewer.
  long evaluations() const { return evaluations_; }
  /// What looks at samples and pieces; made anew after the clearance has changed.
  BatchClearance& batch();

 private:
  /// Of a motion, shares of it.
  struct Piece {
    double from, to;
  };
  /// Ends early, with some share below 1, if it is to be all or nothing.
  double ProvedShare(const Eigen::Ref<const Eigen::VectorXd>& q_0,
                     const Eigen::Ref<const Eigen::VectorXd>& q_1, bool all);

  robot::Clearance& clearance_;
  const double margin_;
  long evaluations_{0};
  std::optional<BatchClearance> batch_;
  long batch_version_{0};
  Eigen::VectorXd way_;
  Eigen::MatrixXd samples_, paths_;  // n x lanes
  std::vector<Piece> pieces_;        // the first on top
};

}  // namespace oca::planning
