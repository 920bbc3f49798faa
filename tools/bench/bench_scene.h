// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "oca/models/robot/robot_model.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/signals/signals.h"

namespace oca::bench {

/// The LWR 4 of seven joints on a base 0.85 m high, its links capsules.
std::shared_ptr<const robot::RobotModel> PrimitiveArm();
/// The same arm with the public convex meshes as links ("lean" hulls); nullptr if they are not
/// beside the source folder.
std::shared_ptr<const robot::RobotModel> MeshArm();

/// The same arm with the meshes of OCA's own model.
std::shared_ptr<const robot::RobotModel> OwnMeshArm();

/// Configurations along a swing of joints 1 and 3, 10 ms apart.
std::vector<Eigen::VectorXd> PathConfigurations(int count);
/// Configurations anywhere within the joints' limits.
std::vector<Eigen::VectorXd> RandomConfigurations(const robot::RobotModel& model, int count);

/// An obstacle in the words of a diagram file.
struct BenchObstacle {
  std::string id;
  systems::ShapeParams shape;
  Eigen::Vector3d position;
};

/// `count` boxes, spheres, cylinders and capsules of 0.05 to 0.15 m, within 1.5 m of the arm and
/// clear of it along PathConfigurations. The same seed every time.
std::vector<BenchObstacle> MakeObstacles(const robot::RobotModel& arm, int count);
systems::ObstacleSet ToSet(const std::vector<BenchObstacle>& obstacles);
/// The same as a list in YAML.
std::string ToYaml(const std::vector<BenchObstacle>& obstacles);

}  // namespace oca::bench
