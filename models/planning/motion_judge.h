// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "oca/models/planning/band_curve.h"
#include "oca/models/planning/band_optimizer.h"
#include "oca/models/robot/clearance.h"

namespace oca::planning {

inline constexpr double kMotionGrid = 1e-3;  ///< s

/// What is true of a motion at the times that were looked at.
struct MotionVerdict {
  double min_distance{0.0};  ///< m, signed; the judge's reach if everything is farther
  double time{0.0};          ///< s, of the nearest
  models::Name link{};       ///< the nearest pair; of no meaning if all is beyond the reach
  models::Name body{};
  double position{0.0};  ///< largest share of the way from the middle to a limit; 0 without any
  double speed{0.0};     ///< largest share of a velocity limit; 0 without any
  double acceleration{0.0};
  double final_error{0.0};  ///< rad, m; of any joint from the request at the end
  double shortfall{0.0};    ///< s; integral of what lacks, in shares of the limits and in cm
  /// First and last times at which something lacks, s, of events at least kMotionPause apart.
  std::vector<std::pair<double, double>> troubles{};

  bool within_limits() const;
  /// Free of contact, and within the limits.
  bool clear() const { return min_distance > 0.0 && within_limits(); }
};

inline constexpr double kMotionPause = 0.5;  ///< s

/// Looks at a motion, request + deviation, on a grid of times: distances of the robot to bodies
/// that move as they do and of its own links, and the limits of the joints. It shares nothing with
/// the search that found the motion but the geometry.
class MotionJudge {
 public:
  /// What is farther than `reach` (m) counts as at `reach`. `ignored`: links and bodies, by their
  /// numbers, whose distance does not count.
  MotionJudge(std::shared_ptr<const robot::RobotModel> model, BandRequest request,
              std::span<const BandBody> bodies, bool self_collision,
              std::span<const std::pair<int, int>> ignored, double reach);

  /// Every `step` from 0 to `duration`, both included; all in s.
  MotionVerdict Judge(const BandCurve& deviation, double duration, double step);
  /// The least distance of a configuration at a time, up to the reach.
  double Distance(const Eigen::VectorXd& q, double time) { return Nearest(q, time).distance; }

 private:
  robot::NearPair Nearest(const Eigen::VectorXd& q, double time);
  /// What lacks at a time, of the limits; the shares go into the verdict.
  double Excess(const Eigen::VectorXd motion[3], const Eigen::VectorXd& start,
                MotionVerdict& verdict) const;

  const std::shared_ptr<const robot::RobotModel> model_;
  const BandRequest request_;
  const std::vector<BandBody> bodies_;
  const double reach_;
  robot::Clearance clearance_;
};

}  // namespace oca::planning
