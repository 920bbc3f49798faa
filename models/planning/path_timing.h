// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::planning {

// Of SmoothStep: its largest slope and curvature.
inline constexpr double kStepSlope = 15.0 / 8.0;
inline constexpr double kStepBend = 5.7735;

/// When a path of straight pieces reaches each of its positions at the earliest, s, within the
/// limits of speed and 2 rad/s in the 2-norm: more takes more points of a band.
std::vector<double> TimesAlong(const robot::RobotModel& model,
                               const std::vector<Eigen::VectorXd>& path);

/// In which SmoothStep goes along a path within a share of the limits of speed and acceleration,
/// but for its corners, s.
double DurationAlong(const robot::RobotModel& model, const std::vector<Eigen::VectorXd>& path,
                     double limit_share);

/// How far SmoothStep takes each joint in a duration (s) within a share of those limits, rad or m.
/// No limit is none.
Eigen::VectorXd WayWithin(const robot::RobotModel& model, double duration, double limit_share);

}  // namespace oca::planning
