// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// The posture 0 as far as the limits allow it: of each joint 0, or the limit nearest to it.
Eigen::VectorXd ZeroPosture(const RobotModel& model);

/// Positions of some joints by their names, rad or m.
using NamedPositions = std::vector<std::pair<std::string, double>>;

/// `q` with these joints moved.
/// throws ModelError naming the joints of the robot if a name is none of a joint that has a
///        position
Eigen::VectorXd WithPositions(const RobotModel& model, const NamedPositions& positions,
                              Eigen::VectorXd q);

/// `q` with the joints of a state (RobotModel::states) moved; what it says of joints that are held,
/// fixed or mimics is not looked at. A state's name alone will do unless groups share it, else
/// GROUP/STATE is meant.
/// throws ModelError naming the states if there is none of that name, or several, or if it moves
///        nothing
Eigen::VectorXd WithState(const RobotModel& model, std::string_view state, Eigen::VectorXd q);

/// `3, one a joint of 'arm': joint_1, joint_2, joint_3`
std::string OneAJoint(const RobotModel& model);

}  // namespace oca::robot
