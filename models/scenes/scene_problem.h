// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "oca/models/robot/robot_model.h"
#include "oca/models/scenes/planning_scene.h"

namespace oca::scenes {

/// A task for an arm that has a way.
struct SceneProblem {
  std::vector<SceneObject> objects{};
  Eigen::VectorXd start, goal;  ///< n; rad or m
  int tries{0};                 ///< scenes that were drawn
};

/// How far start and goal are from everything, m.
inline constexpr double kProblemClearance = 0.01;

/// Draws scenes of a family (Furnish) around the robot, its root at the origin, until a hand at
/// `tip` reaches for something in it from the posture of rest, or from below the table, and
/// RrtConnect knows a way there, 4 mm from everything. Start and goal are kProblemClearance from
/// all bodies and own links. The hand is taken to point along z of the tip. The same arguments give
/// the same problem.
/// throws ModelError if none of `most_tries` scenes has such a task, or for an arm that cannot come
///        to a posture of rest, its tip down in front of it
SceneProblem MakeSceneProblem(const std::shared_ptr<const robot::RobotModel>& model, int tip,
                              std::string_view family, std::uint64_t seed, int most_tries = 5000);

/// As MoveIt's messages print, numbers in lists.
std::string SceneYaml(const robot::RobotModel& model, const SceneProblem& problem);
std::string RequestYaml(const robot::RobotModel& model, const SceneProblem& problem);

}  // namespace oca::scenes
