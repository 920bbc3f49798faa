// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "oca/diagrams/drafts/draft.h"
#include "oca/models/scenes/planning_scene.h"

namespace oca::drafts::internal {

/// What two states say, `over` wherever it says something.
scenes::JointPositions Over(const scenes::JointPositions& over, scenes::JointPositions under);

/// One a position of the arm. A line for each that is beyond its limits goes to `told`; without it
/// those are refused that are so by more than digits of a file take.
/// throws ModelError `file:line: what: joint ...`, a line for each that is missing or refused, and,
///        if some are missing, for each that the robot does not have; `file` stands for the place
///        of a state that says nothing
Eigen::VectorXd PositionsOf(const robot::RobotModel& model, const scenes::JointPositions& joints,
                            const std::string& file, const char* what,
                            std::vector<std::string>* told);
/// At 0, or the limit nearest to it.
Eigen::VectorXd NeutralPositions(const robot::RobotModel& model);

/// What a state says of joints that the arm does not have, or that stand elsewhere, a line each.
std::vector<std::string> OtherJoints(const DraftRobot& robot, const scenes::JointPositions& joints,
                                     const char* what);

/// s; of a straight line from rest to rest, a quintic, which is within the limits; `accelerations`
/// bounds those of joints that have no limit.
double StraightTime(const robot::RobotModel& model, const Eigen::VectorXd& start,
                    const Eigen::VectorXd& goal, double accelerations);

}  // namespace oca::drafts::internal
