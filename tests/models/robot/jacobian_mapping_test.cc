// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/jacobian_mapping.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace jacobian_mapping_test {

// A robot at random positions under random wrenches, with its explicit stack.
struct Case {
  Case(RobotModel robot, Random& random)
      : model(std::move(robot)),
        X_WL(LinkPoses(model, RandomPositions(model, random))),
        wrenches(model.num_bodies()),
        J(6 * model.num_bodies(), model.num_positions()),
        w(6 * model.num_bodies()),
        workspace(model) {
    StackedJacobian(model, X_WL, J);
    for (int b = 0; b < model.num_bodies(); ++b) {
      wrenches[b] = {10.0 * RandomUnitVector(random), RandomUnitVector(random)};
      w.segment<6>(6 * b) << wrenches[b].force, wrenches[b].torque;
    }
  }

  Eigen::VectorXd Map(const MappingSettings& settings) {
    Eigen::VectorXd delta = Eigen::VectorXd::Constant(model.num_positions(), std::nan(""));
    status = MapWrenches(model, X_WL, wrenches, settings, workspace, delta);
    return delta;
  }

  RobotModel model;
  std::vector<Eigen::Isometry3d> X_WL;
  std::vector<BodyWrench> wrenches;
  Eigen::MatrixXd J;
  Eigen::VectorXd w;
  MappingWorkspace workspace;
  MappingStatus status{MappingStatus::kNotFinite};
};

std::vector<Case> RandomCases(int seed) {
  Random random(seed);
  std::vector<Case> cases;
  for (int i = 0; i < 60; ++i) {
    cases.emplace_back(RandomRobot(random, 1 + i % 12, i % 2 == 0), random);
  }
  for (int i = 0; i < 10; ++i) {
    cases.emplace_back(LoadUrdf(ProductFile("robots/lwr4/lwr4.urdf")), random);
    cases.emplace_back(LoadUrdf(ProductFile("robots/lwr4_dual/lwr4_dual.urdf")), random);
  }
  return cases;
}

double RelativeError(const Eigen::MatrixXd& got, const Eigen::MatrixXd& expected) {
  return (got - expected).norm() / (1.0 + expected.norm());
}

TEST(JacobianMappingTest, PlanarArmUnderATipForceByHand) {
  // Links 0.5 and 0.4 m along x; 1 N along y at the origin of link 2: only joint 1 has a lever.
  const RobotModel model = LoadUrdf(ProductFile("robots/planar2/planar2.urdf"));
  const auto X_WL = LinkPoses(model, Eigen::Vector2d::Zero());
  const std::vector<BodyWrench> wrenches{{}, {Eigen::Vector3d(0, 1, 0), Eigen::Vector3d::Zero()}};
  MappingWorkspace workspace(model);
  Eigen::VectorXd delta(2);
  EXPECT_EQ(
      MapWrenches(model, X_WL, wrenches, {MappingMethod::kTranspose, 2.0, 0.0}, workspace, delta),
      MappingStatus::kOk);
  EXPECT_LT((delta - Eigen::Vector2d(1.0, 0.0)).norm(), 1e-15);
  // J^T J: body 1 turns with joint 1; body 2 moves by 0.5 and turns with joint 1, turns with 2.
  ComputeNormalMatrix(model, X_WL, workspace);
  Eigen::Matrix2d expected;
  expected << 1.0 + 0.25 + 1.0, 1.0, 1.0, 1.0;
  EXPECT_LT((workspace.normal - expected).norm(), 1e-15);
  // Its inverse is (1, -1; -1, 2.25) / 1.25, times J^T w = (0.5, 0).
  MapWrenches(model, X_WL, wrenches, {MappingMethod::kPseudoInverse, 1.0, 0.0}, workspace, delta);
  EXPECT_LT((delta - Eigen::Vector2d(0.4, -0.4)).norm(), 1e-15);
}

TEST(JacobianMappingTest, TransposeIsThatOfTheExplicitStack) {
  for (Case& c : RandomCases(21)) {
    const Eigen::VectorXd delta = c.Map({MappingMethod::kTranspose, 0.7, 0.0});
    EXPECT_EQ(c.status, MappingStatus::kOk);
    EXPECT_LT(RelativeError(delta, 0.7 * c.J.transpose() * c.w), 1e-13);
  }
}

TEST(JacobianMappingTest, NormalMatrixIsThatOfTheExplicitStack) {
  for (Case& c : RandomCases(22)) {
    ComputeNormalMatrix(c.model, c.X_WL, c.workspace);
    EXPECT_LT(RelativeError(c.workspace.normal, c.J.transpose() * c.J), 1e-13);
  }
}

TEST(JacobianMappingTest, PseudoInverseIsThatOfAnOrthogonalDecomposition) {
  for (Case& c : RandomCases(23)) {
    const Eigen::VectorXd expected =
        c.J.completeOrthogonalDecomposition().solve(c.w);  // minimum norm, least squares
    const Eigen::VectorXd delta = c.Map({MappingMethod::kPseudoInverse, 1.0, 0.0});
    EXPECT_EQ(c.status, MappingStatus::kOk);
    EXPECT_LT(RelativeError(delta, expected), 1e-9);
  }
}

TEST(JacobianMappingTest, DampedSolvesTheAugmentedLeastSquares) {
  constexpr double kDamping = 0.3;
  for (Case& c : RandomCases(24)) {
    const int n = c.model.num_positions();
    Eigen::MatrixXd augmented(c.J.rows() + n, n);
    augmented << c.J, kDamping * Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd right(c.w.size() + n);
    right << c.w, Eigen::VectorXd::Zero(n);
    const Eigen::VectorXd expected = augmented.colPivHouseholderQr().solve(right);
    EXPECT_LT(RelativeError(c.Map({MappingMethod::kDamped, 1.0, kDamping}), expected), 1e-10);
  }
}

TEST(JacobianMappingTest, DampedWithoutDampingIsThePseudoInverse) {
  Random random(25);
  Case c(LoadUrdf(ProductFile("robots/lwr4/lwr4.urdf")), random);
  EXPECT_EQ(c.Map({MappingMethod::kDamped, 1.0, 0.0}), c.Map({MappingMethod::kPseudoInverse}));
}

TEST(JacobianMappingTest, WrenchesGiveTheJointTorquesOfTheirForce) {
  // J^T w == J_p^T F wherever on whatever link the force acts.
  Random random(26);
  for (int i = 0; i < 100; ++i) {
    const RobotModel model = RandomRobot(random, 8, i % 2 == 0);
    const auto X_WL = LinkPoses(model, RandomPositions(model, random));
    const int link = i % model.num_links();
    if (model.body(link) < 0) continue;
    const Eigen::Vector3d p_W = RandomPose(random).translation();
    const Eigen::Vector3d force = 100.0 * RandomUnitVector(random);
    std::vector<BodyWrench> wrenches(model.num_bodies());
    const Eigen::Vector3d lever = p_W - X_WL[model.body(link)].translation();
    wrenches[model.body_index(link)] = {force, lever.cross(force)};
    MappingWorkspace workspace(model);
    Eigen::VectorXd torques(model.num_positions());
    MultiplyTransposed(model, X_WL, wrenches, workspace, torques);
    Eigen::Matrix3Xd J_p(3, model.num_positions());
    PointJacobian(model, X_WL, link, p_W, J_p);
    EXPECT_LT((torques - J_p.transpose() * force).norm(), 1e-11);
  }
}

// Three parallel axes, the first two `gap` m apart, the third `reach` m further on: seen from
// the third body the first two joints do the same when gap / reach is small.
RobotModel LongArm(double gap, double reach) {
  std::vector<Link> links(4);
  std::vector<Joint> joints(3);
  for (int j = 0; j < 3; ++j) {
    joints[j].type = JointType::kRevolute;
    joints[j].parent_link = j;
    joints[j].child_link = j + 1;
    joints[j].axis = Eigen::Vector3d::UnitZ();
  }
  joints[1].X_PJ.translation().x() = gap;
  joints[2].X_PJ.translation().x() = reach;
  return {models::Name("long"), std::move(links), std::move(joints)};
}

MappingStatus StatusOfLongArm(double reach, Eigen::VectorXd& delta) {
  const RobotModel model = LongArm(0.1, reach);
  const auto X_WL = LinkPoses(model, Eigen::Vector3d::Zero());
  std::vector<BodyWrench> wrenches(3);
  wrenches[2].torque.z() = 1.0;
  MappingWorkspace workspace(model);
  delta.resize(3);
  return MapWrenches(model, X_WL, wrenches, {}, workspace, delta);
}

TEST(JacobianMappingTest, TellsWhenJointsCannotBeToldApart) {
  Eigen::VectorXd delta;
  EXPECT_EQ(StatusOfLongArm(3e5, delta), MappingStatus::kOk);
  // At 3e6 Cholesky still succeeds, at 1e9 it does not.
  for (const double reach : {3e6, 1e9}) {
    EXPECT_EQ(StatusOfLongArm(reach, delta), MappingStatus::kRegularised);
    EXPECT_TRUE(delta.allFinite());
    EXPECT_LT(delta.norm(), 10.0);
  }
}

TEST(JacobianMappingTest, WhatIsRegularisedForLongLeversLeavesASliderAlone) {
  // A slider along the axes of the long arm: all four bodies rise by it, so 1 N lifts it by 1/4.
  std::vector<Link> links(5);
  std::vector<Joint> joints(4);
  joints[0].type = JointType::kPrismatic;
  for (int j = 0; j < 4; ++j) {
    if (j > 0) joints[j].type = JointType::kRevolute;
    joints[j].parent_link = j;
    joints[j].child_link = j + 1;
    joints[j].axis = Eigen::Vector3d::UnitZ();
  }
  joints[2].X_PJ.translation().x() = 0.1;
  joints[3].X_PJ.translation().x() = 1e9;
  const RobotModel model{models::Name("long"), std::move(links), std::move(joints)};
  const auto X_WL = LinkPoses(model, Eigen::Vector4d::Zero());
  std::vector<BodyWrench> wrenches(4);
  wrenches[3].force.z() = 1.0;
  MappingWorkspace workspace(model);
  Eigen::VectorXd delta(4);
  EXPECT_EQ(MapWrenches(model, X_WL, wrenches, {}, workspace, delta), MappingStatus::kRegularised);
  EXPECT_NEAR(delta[0], 0.25, 1e-8);
}

TEST(JacobianMappingTest, ForcesThatAreNotFiniteGiveNoMotionAndSaySo) {
  Random random(27);
  for (const double bad : {std::nan(""), kUnlimited}) {
    for (const auto method :
         {MappingMethod::kTranspose, MappingMethod::kPseudoInverse, MappingMethod::kDamped}) {
      Case c(LoadUrdf(ProductFile("robots/lwr4/lwr4.urdf")), random);
      c.wrenches[3].force.x() = bad;
      EXPECT_EQ(c.Map({method, 1.0, 0.1}), Eigen::VectorXd::Zero(7));
      EXPECT_EQ(c.status, MappingStatus::kNotFinite);
    }
  }
}

TEST(JacobianMappingTest, RobotThatCannotMoveHasAnEmptyAnswer) {
  Random random(28);
  Case c(LoadUrdf(ProductFile("worlds/table_frame/table_frame.urdf")), random);
  EXPECT_EQ(c.Map({}).size(), 0);
  EXPECT_EQ(c.status, MappingStatus::kOk);
}

}  // namespace jacobian_mapping_test
}  // namespace oca::robot::test
