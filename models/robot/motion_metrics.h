// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "oca/models/name.h"

namespace oca::robot {

/// What a run has been like so far; a metric without a source has no value.
struct MotionMetricsValue {
  std::optional<double> min_distance;  ///< signed, m
  models::Name min_distance_link;
  models::Name min_distance_obstacle;
  std::optional<double> min_distance_time;       ///< s
  std::optional<double> certified_min_distance;  ///< not above the distance at any time, m
  std::optional<double> contact_time;            ///< total time at distance <= 0, s
  std::optional<double> first_contact_time;      ///< s; none if there was no contact
  std::optional<double> max_abs_delta;           ///< of the applied delta; rad, m
  std::optional<double> final_error;             ///< max norm against the goal; rad, m
  std::optional<double> time_to_goal;  ///< since the first sample, s; none unless it is there
  std::optional<double> delta_sign_changes_per_second;  ///< mean over joints; 1/s
  std::optional<double> total_variation_ratio;  ///< path of q over path of the request, joint space
  std::optional<double> path_length;            ///< of q, the 2-norm of each step; rad, m
  std::optional<double> max_joint_speed;        ///< rad/s, m/s
  std::optional<double> final_speed;  ///< of the fastest joint in the last step; rad/s, m/s
  std::optional<double> max_joint_acceleration;  ///< rad/s^2, m/s^2
  std::optional<double> limit_violations;        ///< joints beyond a limit, summed over samples
  std::optional<double> stuck_time;              ///< longest standstill off the goal, s; 0: none
  /// m, how far apart stuck_link and stuck_obstacle were; or how far the goal is beyond a limit
  std::optional<double> stuck_amount;
  models::Name stuck_link;      ///< nearest then, or a joint; empty if nothing was near
  models::Name stuck_obstacle;  ///< "limit" of the joint

  bool operator==(const MotionMetricsValue&) const = default;
};

}  // namespace oca::robot
