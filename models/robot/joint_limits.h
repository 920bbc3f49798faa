// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

// What the limits in a description mean, the same for all that reads them.

/// A range of positions that is wider counts as one that nobody measured: exporters write 1e9 where
/// nothing is known. It is kept, but postures are not drawn from it. 100 turns and 100 m are beyond
/// what arms, turntables and rails have.
inline constexpr double kWidestTurn = 628.3185307179587;  // rad
inline constexpr double kWidestSlide = 100.0;             // m

/// Limits that are given and smaller than these are refused: below them a motion can hardly be told
/// from standing still.
inline constexpr double kLeastVelocity = 1e-6;      // rad/s, m/s; a radian in ten days
inline constexpr double kLeastAcceleration = 1e-6;  // rad/s^2, m/s^2
inline constexpr double kLeastJerk = 1e-6;          // rad/s^3, m/s^3

/// A robot's state farther beyond a limit than this is none of that robot's.
inline constexpr double kFarthestTurnBeyond = 6.283185307179586;  // rad
inline constexpr double kFarthestSlideBeyond = 10.0;              // m

/// The two, for messages.
inline constexpr char kPossibleRule[] =
    "no joint more than 2 pi rad or 10 m beyond its limits, nor beyond 1e6";

/// Of a joint's position, for messages: m of a slider, else rad.
const char* PositionUnit(const Joint& joint);

/// What one entry of q may do, infinite where nothing is given.
struct PositionLimits {
  double lower{-kUnlimited};
  double upper{kUnlimited};
  double velocity{kUnlimited};
  double effort{kUnlimited};
  double acceleration{kUnlimited};
  double jerk{kUnlimited};
};

/// The limits of each entry of q: those of its joint, and those of all joints that mimic it,
/// directly or not. A mimic that stands at m q + o, within [a, b] and no faster than v, binds
///
///     q to [(a - o) / m, (b - o) / m] (ends swapped if m < 0),   |q'| to v / |m|,
///
/// acceleration and jerk likewise; its effort is its own. A velocity or effort limit of 0 counts as
/// not given: exporters write it for "not filled in".
/// throws ModelError naming both joints if a mimic leaves its leader no position
std::vector<PositionLimits> LimitsOfPositions(models::Name robot, const std::vector<Joint>& joints,
                                              const std::vector<KinematicStep>& steps);

/// Gives the joints that move by themselves, in their order, a limit of one kind each, at least
/// `least`: one for all, one a joint, or none, which changes nothing. `what` begins the message.
/// throws ModelError for another number of limits, or one below
void GiveLimits(std::vector<Joint>& joints, const Eigen::VectorXd& limits, const std::string& what,
                double least, double Joint::*field);

/// A line for all that these rules make of a description and its author may not have meant:
/// velocity and effort limits of 0, no velocity limit, ranges too wide to be drawn from, leaders
/// that their mimics bind.
std::vector<std::string> LimitWarnings(const RobotModel& model);

/// If the positions of number `index` are a range, and not wider than the widest, nor are those of
/// the joints that mimic it.
bool HasOwnRange(const RobotModel& model, Eigen::Index index);

/// From where postures that stand for all there are can be drawn: the range itself, if it is not
/// too wide; for joints that come back after a turn, all mimics included, the turn [-pi, pi] as far
/// as the limits have it, or one that begins at a limit if they do not; nullopt for others, which
/// no number of draws covers.
std::optional<std::pair<double, double>> DrawnRange(const RobotModel& model, Eigen::Index index);

/// What position number `index` can be at all: no joint that it moves farther beyond a limit than
/// kFarthestTurnBeyond or kFarthestSlideBeyond, nor beyond motion::kFarthestPosition.
std::pair<double, double> PossibleRange(const RobotModel& model, Eigen::Index index);

/// Empty if q can be a state of the robot, else "position of joint 'x'; got ...; expected ...": for
/// one that is not finite or out of its PossibleRange.
std::string ImpossibleState(const RobotModel& model, const Eigen::Ref<const Eigen::VectorXd>& q);

}  // namespace oca::robot
