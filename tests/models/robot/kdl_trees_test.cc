// SPDX-License-Identifier: BSD-3-Clause
// Kinematics of 100,000 random trees against Orocos KDL, each along the path to one of its links.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <vector>

#include "oca/models/robot/kinematics.h"
#include "tests/kdl_convert.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace kdl_trees_test {

using oca::test::ToKdl;

// The joints from the root to `link`, as numbers.
std::vector<int> PathTo(const RobotModel& model, int link) {
  std::vector<int> path;
  for (int at = link; at > 0; at = model.joints()[at - 1].parent_link) path.push_back(at - 1);
  std::reverse(path.begin(), path.end());
  return path;
}

// What one path looks like to KDL, where each movable joint has a position of its own.
struct KdlPath {
  KDL::Chain chain;
  std::vector<double> positions;
  std::vector<double> rates;  // of the position to that of its master
  std::vector<int> columns;   // of the master
  double reach{1.0};          // m; nothing lies farther from the root
  double gain{1.0};           // sum of the rates
};

KdlPath MakePath(const RobotModel& model, int link, const Eigen::VectorXd& q) {
  KdlPath path;
  path.chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), ToKdl(model.X_WB())));
  path.reach += model.X_WB().translation().norm();
  for (const int j : PathTo(model, link)) {
    const Joint& joint = model.joints()[j];
    const KDL::Frame tip = ToKdl(joint.X_PJ);
    path.reach += joint.X_PJ.translation().norm();
    if (!joint.movable()) {
      path.chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), tip));
      continue;
    }
    const bool slides = joint.type == JointType::kPrismatic;
    path.chain.addSegment(
        KDL::Segment(KDL::Joint(tip.p, tip.M * ToKdl(joint.axis),
                                slides ? KDL::Joint::TransAxis : KDL::Joint::RotAxis),
                     tip));
    const Mimic rule = joint.mimic.value_or(Mimic{});
    const Joint& master = joint.mimic ? model.joints()[rule.joint] : joint;
    path.positions.push_back(rule.multiplier * q[master.position_index] + rule.offset);
    path.rates.push_back(rule.multiplier);
    path.columns.push_back(master.position_index);
    path.gain += std::abs(rule.multiplier);
    if (slides) path.reach += std::abs(path.positions.back());
  }
  return path;
}

// Largest difference of the pose and the Jacobian of a link, as a share of the size of the numbers
// that went into it.
double Difference(const RobotModel& model, int link, const Eigen::VectorXd& q) {
  const KdlPath path = MakePath(model, link, q);
  KDL::JntArray positions(static_cast<unsigned>(path.positions.size()));
  for (std::size_t i = 0; i < path.positions.size(); ++i) {
    positions(static_cast<unsigned>(i)) = path.positions[i];
  }
  KDL::ChainFkSolverPos_recursive pose(path.chain);
  KDL::ChainJntToJacSolver jacobian(path.chain);
  KDL::Frame frame;
  KDL::Jacobian columns(path.chain.getNrOfJoints());
  EXPECT_GE(pose.JntToCart(positions, frame), 0);
  EXPECT_GE(jacobian.JntToJac(positions, columns), 0);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, model.num_positions());
  for (std::size_t i = 0; i < path.columns.size(); ++i) {
    expected.col(path.columns[i]) += path.rates[i] * columns.data.col(static_cast<int>(i));
  }
  const std::vector<Eigen::Isometry3d> X_WL = LinkPoses(model, q);
  Matrix6X J(6, model.num_positions());
  LinkJacobian(model, X_WL, link, J);
  double difference = (J - expected).cwiseAbs().maxCoeff() / path.gain;
  for (int row = 0; row < 3; ++row) {
    difference = std::max(difference, std::abs(X_WL[link].translation()[row] - frame.p(row)));
    for (int column = 0; column < 3; ++column) {
      difference =
          std::max(difference, std::abs(X_WL[link].linear()(row, column) - frame.M(row, column)));
    }
  }
  return difference / path.reach;
}

// Split, so that the parts run side by side.
class KdlTreesTest : public testing::TestWithParam<int> {};

TEST_P(KdlTreesTest, AgreeToThirteenDigits) {
  Random random(1000 + GetParam());
  double worst = 0.0;
  for (int i = 0; i < 25000; ++i) {
    const RobotModel model = RandomRobot(random, 1 + i % 12, i % 3 == 0);
    const int link = std::uniform_int_distribution<int>(0, model.num_links() - 1)(random);
    worst = std::max(worst, Difference(model, link, RandomPositions(model, random)));
  }
  EXPECT_LT(worst, 1e-13);
  EXPECT_GT(worst, 1e-17) << "nothing was compared";
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

INSTANTIATE_TEST_SUITE_P(Quarters, KdlTreesTest, testing::Range(0, 4));

}  // namespace kdl_trees_test
}  // namespace oca::robot::test
