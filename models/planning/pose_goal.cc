// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/pose_goal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/models/error.h"
#include "oca/models/robot/inverse_kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/unseen_links.h"

namespace oca::planning {
namespace {

// How many postures that reach the goal are compared.
constexpr int kSolutions = 20;
// Share of a joint's speed limit that the mean speed may be: a cubic's highest is 1.5 times it, a
// quintic's 1.875 times.
constexpr double kSpeedShare = 0.25;
constexpr double kLeastDuration = 1.0;  // s

void CheckBefore(const motion::KeyPoint& before, const robot::RobotModel& model) {
  if (before.position.size() == model.num_positions()) return;
  throw models::ModelError(
      fmt::format("goal: the key point before; got {} numbers; expected {}, one a "
                  "joint of '{}'",
                  before.position.size(), model.num_positions(), model.name().text()));
}

void CheckClearance(const PoseGoal& goal, const robot::RobotModel& model) {
  if (goal.clearance == 0.0 || !robot::NothingToSee(model)) return;
  throw models::ModelError(
      fmt::format("goal.clearance: got {} m; expected a robot that distances see: {}",
                  goal.clearance, robot::DescribeUnseen(model, "visual_as_collision: missing")));
}

double ArrivalTime(const PoseGoal& goal, const motion::KeyPoint& before,
                   const robot::RobotModel& model, const Eigen::VectorXd& position) {
  if (goal.time) {
    if (*goal.time > before.time && std::isfinite(*goal.time)) return *goal.time;
    throw models::ModelError(
        fmt::format("goal.time: not later than the key point before; got {}; "
                    "expected > {}",
                    *goal.time, before.time));
  }
  double duration = kLeastDuration;
  for (Eigen::Index j = 0; j < position.size(); ++j) {
    const double way = std::fabs(position[j] - before.position[j]);
    if (way == 0.0) continue;
    const double limit = model.velocity_limits()[j];
    if (!std::isfinite(limit) || limit <= 0.0) {
      throw models::ModelError(
          fmt::format("goal.time: missing; got none, and joint '{}' has no limit of "
                      "its speed; expected a time",
                      model.position_names()[j].text()));
    }
    duration = std::max(duration, way / (kSpeedShare * limit));
  }
  return before.time + duration;
}

/// The posture, and the number of the link that it brings to the goal.
std::pair<robot::PostureSolution, int> FindPosture(
    const PoseGoal& goal, const motion::KeyPoint& before,
    const std::shared_ptr<const robot::RobotModel>& model) {
  try {
    const int link = goal.link.empty() ? robot::TipLink(*model) : model->FindLink(goal.link);
    robot::InverseKinematicsSettings settings;
    settings.solutions = kSolutions;
    settings.clearance = goal.clearance;
    settings.turns_freely = goal.turns_freely;
    std::vector<robot::PlacedBody> bodies;
    if (goal.bodies) bodies = goal.bodies(goal.time.value_or(before.time));
    robot::Clearance surroundings(model, true, std::move(bodies));
    if (goal.clearance > 0.0) {
      const auto rest = motion::Trajectory::Linear({before});
      surroundings.KeepOwn(robot::OwnRangesAlong(model, &rest, robot::kSelfDistance),
                           goal.clearance);
    }
    return {robot::SolveInverseKinematics(*model, link, goal.X_WG, before.position, settings,
                                          &surroundings),
            link};
  } catch (const models::ModelError& error) {
    throw models::ModelError(fmt::format("goal: {}", error.what()));
  }
}

}  // namespace

motion::KeyPoint KeyPointAt(const PoseGoal& goal, const motion::KeyPoint& before,
                            const std::shared_ptr<const robot::RobotModel>& model) {
  CheckBefore(before, *model);
  CheckClearance(goal, *model);
  if (goal.time) ArrivalTime(goal, before, *model, before.position);
  const auto [found, link] = FindPosture(goal, before, model);
  if (!found.reached) {
    throw models::ModelError(fmt::format(
        "goal.{}: out of reach; got one that {} misses by at least {:.3g} m{}; expected one within "
        "the joints' limits",
        goal.turns_freely ? "point" : "pose",
        model->links()[static_cast<std::size_t>(link)].name.text(), found.position_error,
        goal.turns_freely ? "" : fmt::format(" and {:.3g} rad", found.rotation_error)));
  }
  motion::KeyPoint point;
  point.position = found.q;
  point.time = ArrivalTime(goal, before, *model, found.q);
  return point;
}

}  // namespace oca::planning
