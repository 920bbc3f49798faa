// SPDX-License-Identifier: BSD-3-Clause
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {

double Uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Eigen::Vector3d RandomUnitVector(Random& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

Eigen::Isometry3d RandomPose(Random& random) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() =
      Eigen::AngleAxisd(Uniform(random, -3.0, 3.0), RandomUnitVector(random)).toRotationMatrix();
  X.translation() = Uniform(random, 0.1, 0.6) * RandomUnitVector(random);
  return X;
}

Eigen::VectorXd RandomPositions(const RobotModel& model, Random& random) {
  Eigen::VectorXd q(model.num_positions());
  for (double& position : q) position = Uniform(random, -3.0, 3.0);
  return q;
}

RobotModel RandomRobot(Random& random, int num_joints, bool chain, bool mimics) {
  const auto one_of = [&random](int count) {
    return std::uniform_int_distribution<int>(0, count - 1)(random);
  };
  std::vector<Link> links(num_joints + 1);
  std::vector<Joint> joints(num_joints);
  links[0].name = models::Name("link_0");
  for (int j = 0; j < num_joints; ++j) {
    links[j + 1].name = models::Name("link_" + std::to_string(j + 1));
    Joint& joint = joints[j];
    joint.name = models::Name("joint_" + std::to_string(j));
    joint.type = static_cast<JointType>(one_of(4));
    // The first one moves, so that every robot has a position.
    if (j == 0 && joint.type == JointType::kFixed) joint.type = JointType::kRevolute;
    joint.parent_link = chain ? j : one_of(j + 1);
    joint.child_link = j + 1;
    joint.X_PJ = RandomPose(random);
    if (one_of(3) == 0) joint.X_PJ.linear().setIdentity();
    joint.axis = RandomUnitVector(random);
    if (one_of(2) == 0)
      joint.axis = (one_of(2) == 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(one_of(3));
    if (mimics && j > 0 && joint.movable() && one_of(4) == 0) {
      joint.mimic = Mimic{0, Uniform(random, -2.0, 2.0), Uniform(random, -1.0, 1.0)};
    }
  }
  return {models::Name("random"), std::move(links), std::move(joints), RandomPose(random)};
}

std::string SharedRobot(const std::string& file) {
  return OCA_SOURCE_DIR "/../shared/data/robots/" + file;
}

std::string ProductFile(const std::string& file) { return OCA_SOURCE_DIR "/models/" + file; }

}  // namespace oca::robot::test
