// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <random>
#include <string>

#include "oca/models/robot/robot_model.h"

namespace oca::robot::test {

using Random = std::mt19937;

double Uniform(Random& random, double low, double high);
Eigen::Vector3d RandomUnitVector(Random& random);
Eigen::Isometry3d RandomPose(Random& random);
Eigen::VectorXd RandomPositions(const RobotModel& model, Random& random);

/// A robot of `num_joints` joints of all types with random poses and axes, some of them along
/// coordinate axes, some without rotation, some mimics. A chain, or else a tree.
RobotModel RandomRobot(Random& random, int num_joints, bool chain, bool mimics = true);

/// Path of the shared test data, whether it exists or not.
std::string SharedRobot(const std::string& file);
/// Path of a model of the product.
std::string ProductFile(const std::string& file);

}  // namespace oca::robot::test
