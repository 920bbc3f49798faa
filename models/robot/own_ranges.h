// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>

#include "oca/models/motion/trajectory.h"
#include "oca/models/robot/robot_model.h"

namespace oca::robot {

inline constexpr double kSelfDistance = 0.01;  ///< m; that own links keep if nothing is said

/// The most that is asked of the distance of two own links, m, by the links' numbers, in either
/// order. Empty: as much as of obstacles.
///
/// Links two joints apart stand millimetres from each other by design. What an arm keeps from
/// obstacles cannot be had there: where it is asked for, no motion arrives.
class OwnRanges {
 public:
  OwnRanges() = default;
  /// All pairs of `num_links` links the same.
  OwnRanges(int num_links, double range) : ranges_(num_links, num_links) {
    ranges_.setConstant(range);
  }

  bool empty() const { return ranges_.size() == 0; }
  double of(int link, int other) const { return empty() ? kUnlimited : ranges_(link, other); }
  void Set(int link, int other, double range) {
    ranges_(link, other) = range;
    ranges_(other, link) = range;
  }

 private:
  Eigen::MatrixXd ranges_;
};

/// What self_distance (m) and a request leave to be asked of own links:
///
///     range = min(self_distance, L / 3)
///
/// L is the least distance of the pair along the request, looked at every 0.05 rad or m of the
/// joint that goes farthest; if that is a contact, the lesser of its ends; if that is one too, L is
/// unlimited: what is asked for in contact cannot be given, and elsewhere there is room. Contact is
/// what is nearer than 0.3 mm. A third, so that even what pushes from some way beyond the range on
/// does not push on the request itself.
///
/// `request` may be null: self_distance it is. Empty if self_distance is 0. Allocates.
/// throws ModelError if the request has another number of joints, or a solid is refused
OwnRanges OwnRangesAlong(const std::shared_ptr<const RobotModel>& model,
                         const motion::Trajectory* request, double self_distance);

}  // namespace oca::robot
