// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/pose_goal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/models/error.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/inverse_kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/unseen_links.h"

namespace oca::systems {
namespace {

// How many postures that reach the goal are compared.
constexpr int kSolutions = 20;
// Share of a joint's speed limit that the mean speed may be: a cubic's highest is 1.5 times it, a
// quintic's 1.875 times.
constexpr double kSpeedShare = 0.25;
constexpr double kShortest = 1.0;  // s

std::vector<robot::PlacedBody> BodiesAt(const std::vector<ObstacleSource::Params>& sources,
                                        double time) {
  std::vector<robot::PlacedBody> bodies;
  for (const ObstacleSource::Params& params : sources) {
    auto owned = std::make_unique<ObstacleSource>(params);
    const ObstacleSource& source = *owned;
    const auto diagram = MakeDiagramOf(std::move(owned));
    Context context = diagram->MakeContext();
    context.SetTime(time);
    for (const Obstacle& obstacle : source.obstacles.Eval(context).obstacles) {
      bodies.push_back({obstacle.body->collider, obstacle.X_WO});
    }
  }
  return bodies;
}

void CheckBefore(const KeyPoint& before, const robot::RobotModel& model) {
  if (before.position.size() == model.num_positions()) return;
  throw ConfigError(
      fmt::format("goal: the key point before; got {} numbers; expected {}, one a "
                  "joint of '{}'",
                  before.position.size(), model.num_positions(), model.name().text()));
}

void CheckClearance(const PoseGoal& goal, const robot::RobotModel& model) {
  if (goal.clearance == 0.0 || !robot::NothingToSee(model)) return;
  throw ConfigError(fmt::format("goal.clearance: got {} m; expected a robot that distances see: {}",
                                goal.clearance,
                                robot::DescribeUnseen(model, "visual_as_collision: missing")));
}

double ArrivalTime(const PoseGoal& goal, const KeyPoint& before, const robot::RobotModel& model,
                   const Eigen::VectorXd& position) {
  if (goal.time) {
    if (*goal.time > before.time && std::isfinite(*goal.time)) return *goal.time;
    throw ConfigError(
        fmt::format("goal.time: not later than the key point before; got {}; "
                    "expected > {}",
                    *goal.time, before.time));
  }
  double duration = kShortest;
  for (Eigen::Index j = 0; j < position.size(); ++j) {
    const double way = std::fabs(position[j] - before.position[j]);
    if (way == 0.0) continue;
    const double limit = model.velocity_limits()[j];
    if (!std::isfinite(limit) || limit <= 0.0) {
      throw ConfigError(
          fmt::format("goal.time: missing; got none, and joint '{}' has no limit of "
                      "its speed; expected a time",
                      model.position_names()[j].text()));
    }
    duration = std::max(duration, way / (kSpeedShare * limit));
  }
  return before.time + duration;
}

}  // namespace

void PoseGoal::Describe(Fields<PoseGoal>& fields) {
  fields.Add("pose", &PoseGoal::pose, "", "of the link, in the world").Required();
  fields.Add("link", &PoseGoal::link, "", "the link; may be left out if the robot has one tip");
  fields.Add("time", &PoseGoal::time, "s",
             "of arrival; absent: with a quarter of the joints' speed limits");
  fields
      .Add("clearance", &PoseGoal::clearance, "m",
           "kept from obstacles and own links, if that can be; 0: not looked at")
      .AtLeast(0.0);
  fields.Add("around", &PoseGoal::around, "",
             "obstacles, as parameters of ObstacleSources; absent: those of the file");
}

KeyPoint KeyPointAt(const PoseGoal& goal, const KeyPoint& before,
                    const std::shared_ptr<const robot::RobotModel>& model) {
  CheckBefore(before, *model);
  CheckClearance(goal, *model);
  const Eigen::Isometry3d X_WG = goal.pose.Pose("goal.pose");
  if (goal.time) ArrivalTime(goal, before, *model, before.position);
  try {
    const int link = goal.link.empty() ? robot::TipLink(*model) : model->FindLink(goal.link);
    robot::InverseKinematicsSettings settings;
    settings.solutions = kSolutions;
    settings.clearance = goal.clearance;
    robot::Clearance surroundings(model, true,
                                  BodiesAt(goal.around, goal.time.value_or(before.time)));
    const robot::PostureSolution found =
        robot::SolveInverseKinematics(*model, link, X_WG, before.position, settings, &surroundings);
    if (!found.reached) {
      throw ConfigError(fmt::format(
          "goal.pose: out of reach; got one that {} misses by at least {:.3g} m and {:.3g} rad; "
          "expected one within the joints' limits",
          model->links()[link].name.text(), found.position_error, found.rotation_error));
    }
    KeyPoint point;
    point.position = found.q;
    point.time = ArrivalTime(goal, before, *model, found.q);
    return point;
  } catch (const models::ModelError& error) {
    throw ConfigError(fmt::format("goal: {}", error.what()));
  }
}

}  // namespace oca::systems
