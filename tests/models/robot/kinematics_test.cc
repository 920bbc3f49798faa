// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/kinematics.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "oca/models/error.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace kinematics_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

RobotModel Planar3() { return LoadUrdf(ProductFile("robots/planar3/planar3.urdf")); }

TEST(KinematicsTest, PlanarArmReachesWhatTrigonometrySays) {
  const RobotModel model = Planar3();
  // A right angle up, then a right angle back, then straight on.
  const Eigen::Vector3d q(std::numbers::pi / 2, -std::numbers::pi / 2, 0.0);
  const auto X_WL = LinkPoses(model, q);
  const Eigen::Vector3d tip = X_WL[model.FindLink("planar3_tip")].translation();
  EXPECT_LT((tip - Eigen::Vector3d(0.4 + 0.3, 0.5, 0.0)).norm(), 1e-15);
}

TEST(KinematicsTest, PlanarJacobianIsTheLeverOfEachJoint) {
  const RobotModel model = Planar3();
  const auto X_WL = LinkPoses(model, Eigen::Vector3d::Zero());
  Matrix6X J(6, 3);
  LinkJacobian(model, X_WL, model.FindLink("planar3_tip"), J);
  Matrix6X expected = Matrix6X::Zero(6, 3);
  expected.row(1) << 1.2, 0.7, 0.3;
  expected.row(5).setOnes();
  EXPECT_LT((J - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(KinematicsTest, BasePoseMovesEverything) {
  LoadOptions options;
  options.X_WB.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  const RobotModel model = LoadUrdf(ProductFile("robots/planar3/planar3.urdf"), options);
  const auto X_WL = LinkPoses(model, Eigen::Vector3d::Zero());
  EXPECT_LT((X_WL[0].translation() - Eigen::Vector3d(1.0, 2.0, 3.0)).norm(), 1e-15);
  EXPECT_LT((X_WL.back().translation() - Eigen::Vector3d(2.2, 2.0, 3.0)).norm(), 1e-15);
}

TEST(KinematicsTest, PosesAreRotations) {
  Random random(11);
  for (int i = 0; i < 50; ++i) {
    const RobotModel model = RandomRobot(random, 20, true);
    for (const auto& X : LinkPoses(model, RandomPositions(model, random))) {
      const Eigen::Matrix3d R = X.linear();
      EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-13);
      EXPECT_EQ(X.matrix().row(3), Eigen::RowVector4d(0, 0, 0, 1));
    }
  }
}

TEST(KinematicsTest, WhatThePosesHeldBeforeDoesNotMatter) {
  const RobotModel model = Planar3();
  const Eigen::Vector3d q(0.1, 0.2, 0.3);
  std::vector<Eigen::Isometry3d> X_WL(model.num_links());
  for (auto& X : X_WL) X.matrix().setConstant(std::nan(""));
  ForwardKinematics(model, q, X_WL);
  const auto expected = LinkPoses(model, q);
  for (int i = 0; i < model.num_links(); ++i) EXPECT_EQ(X_WL[i].matrix(), expected[i].matrix());
}

// Central difference of the point of `link` that is at p_L in the link's frame.
Eigen::Matrix3Xd NumericPointJacobian(const RobotModel& model, const Eigen::VectorXd& q, int link,
                                      const Eigen::Vector3d& p_L) {
  constexpr double kStep = 1e-5;
  Eigen::Matrix3Xd J(3, q.size());
  for (int i = 0; i < q.size(); ++i) {
    Eigen::VectorXd ahead = q, behind = q;
    ahead[i] += kStep;
    behind[i] -= kStep;
    J.col(i) =
        (LinkPoses(model, ahead)[link] * p_L - LinkPoses(model, behind)[link] * p_L) / (2 * kStep);
  }
  return J;
}

TEST(KinematicsTest, PointJacobianIsTheDerivativeOfThePoint) {
  Random random(13);
  for (int i = 0; i < 50; ++i) {
    const RobotModel model = RandomRobot(random, 10, i % 2 == 0);
    const Eigen::VectorXd q = RandomPositions(model, random);
    const auto X_WL = LinkPoses(model, q);
    const int link = i % model.num_links();
    const Eigen::Vector3d p_L = RandomPose(random).translation();
    Eigen::Matrix3Xd J(3, q.size());
    PointJacobian(model, X_WL, link, X_WL[link] * p_L, J);
    EXPECT_LT((J - NumericPointJacobian(model, q, link, p_L)).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST(KinematicsTest, NumericCheckNoticesAWrongJacobian) {
  const RobotModel model = Planar3();
  const Eigen::Vector3d q(0.3, 0.2, 0.1);
  const auto X_WL = LinkPoses(model, q);
  Eigen::Matrix3Xd J(3, 3);
  PointJacobian(model, X_WL, 2, X_WL[2].translation(), J);  // of link 2 instead of link 3
  EXPECT_GT((J - NumericPointJacobian(model, q, 3, {0.1, 0, 0})).cwiseAbs().maxCoeff(), 0.05);
}

TEST(KinematicsTest, AngularRowsAreTheDerivativeOfTheRotation) {
  Random random(14);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 20; ++i) {
    const RobotModel model = RandomRobot(random, 8, true);
    const Eigen::VectorXd q = RandomPositions(model, random);
    const auto X_WL = LinkPoses(model, q);
    Matrix6X J(6, q.size());
    LinkJacobian(model, X_WL, 8, J);
    for (int k = 0; k < q.size(); ++k) {
      Eigen::VectorXd ahead = q, behind = q;
      ahead[k] += kStep;
      behind[k] -= kStep;
      const Eigen::Matrix3d spin =
          (LinkPoses(model, ahead)[8].linear() - LinkPoses(model, behind)[8].linear()) /
          (2 * kStep) * X_WL[8].linear().transpose();
      const Eigen::Vector3d omega(spin(2, 1), spin(0, 2), spin(1, 0));
      EXPECT_LT((J.col(k).tail<3>() - omega).norm(), 1e-8);
    }
  }
}

TEST(KinematicsTest, MimicJointFollowsItsMasterInPoseAndJacobian) {
  const std::string text = R"(<robot name="gripper"><link name="palm"/>
    <link name="left"/><link name="right"/>
    <joint name="open" type="prismatic"><parent link="palm"/><child link="left"/>
      <axis xyz="0 1 0"/><limit lower="0" upper="0.04" velocity="1" effort="1"/></joint>
    <joint name="follow" type="prismatic"><parent link="palm"/><child link="right"/>
      <axis xyz="0 1 0"/><limit lower="-0.1" upper="0.1" velocity="1" effort="1"/>
      <mimic joint="open" multiplier="-2" offset="0.01"/></joint></robot>)";
  const RobotModel model = ParseUrdf(text, "gripper.urdf");
  ASSERT_EQ(model.num_positions(), 1);
  const auto X_WL = LinkPoses(model, Eigen::VectorXd::Constant(1, 0.03));
  EXPECT_NEAR(X_WL[model.FindLink("right")].translation().y(), -2 * 0.03 + 0.01, 1e-16);
  Eigen::MatrixXd J(12, 1);
  StackedJacobian(model, X_WL, J);
  EXPECT_EQ(J(1, 0), 1.0);
  EXPECT_EQ(J(7, 0), -2.0);
}

TEST(KinematicsTest, RefusesPositionsOfWrongLengthOnEitherSide) {
  const RobotModel model = Planar3();
  for (const int length : {0, 2, 4}) {
    EXPECT_THAT([&] { LinkPoses(model, Eigen::VectorXd::Zero(length)); },
                ThrowsMessage<models::ModelError>(HasSubstr("expected 3")));
  }
  EXPECT_NO_THROW(LinkPoses(model, Eigen::VectorXd::Zero(3)));
}

TEST(KinematicsTest, RefusesPositionsThatAreNotFiniteNamingTheJoint) {
  const RobotModel model = Planar3();
  for (const double bad : {std::nan(""), kUnlimited, -kUnlimited}) {
    EXPECT_THAT([&] { LinkPoses(model, Eigen::Vector3d(0.0, bad, 0.0)); },
                ThrowsMessage<models::ModelError>(HasSubstr("'planar3_joint_2'")));
  }
}

TEST(KinematicsTest, LinkVelocitiesAreTheSlopesOfThePoses) {
  Random random(61);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 100; ++i) {
    const RobotModel model = RandomRobot(random, 8, i % 2 == 0);
    const Eigen::VectorXd q = RandomPositions(model, random);
    const Eigen::VectorXd qdot = RandomPositions(model, random);
    const auto X_WL = LinkPoses(model, q);
    const auto later = LinkPoses(model, q + kStep * qdot);
    const auto earlier = LinkPoses(model, q - kStep * qdot);
    std::vector<LinkVelocity> velocities(model.num_links());
    LinkVelocities(model, X_WL, qdot, velocities);
    for (int link = 0; link < model.num_links(); ++link) {
      const Eigen::Vector3d linear =
          (later[link].translation() - earlier[link].translation()) / (2.0 * kStep);
      // R(t) = exp(w t) R: the skew part of dR/dt R^T is w.
      const Eigen::Matrix3d W = (later[link].linear() - earlier[link].linear()) / (2.0 * kStep) *
                                X_WL[link].linear().transpose();
      const Eigen::Vector3d angular(W(2, 1), W(0, 2), W(1, 0));
      EXPECT_LT((velocities[link].linear - linear).norm(), 1e-6 * (1.0 + linear.norm()));
      EXPECT_LT((velocities[link].angular - angular).norm(), 1e-6 * (1.0 + angular.norm()));
    }
  }
}

TEST(KinematicsTest, DistanceRowIsTheLeverOfTheJointsBetweenTwoLinks) {
  const RobotModel model = Planar3();
  // Folded into a U: link 3 comes back at y = 0.4, above link 1. Joint 2 at (0.5, 0), joint 3 at
  // (0.5, 0.4); the points are 0.2 m left of both.
  const Eigen::Vector3d q(0.0, std::numbers::pi / 2, std::numbers::pi / 2);
  const auto X_WL = LinkPoses(model, q);
  const Eigen::Vector3d p_A(0.3, 0.4, 0.0), p_B(0.3, 0.0, 0.0), n(0.0, 1.0, 0.0);
  Eigen::VectorXd row(3);
  DistanceRow(model, X_WL, 3, p_A, 1, p_B, n, row);
  EXPECT_LT((row - Eigen::Vector3d(0.0, -0.2, -0.2)).norm(), 1e-15);
  DistanceRow(model, X_WL, 1, p_B, 3, p_A, -n, row);
  EXPECT_LT((row - Eigen::Vector3d(0.0, -0.2, -0.2)).norm(), 1e-15);
  // The ground does not turn with joint 1.
  DistanceRow(model, X_WL, 3, p_A, -1, p_B, n, row);
  EXPECT_LT((row - Eigen::Vector3d(0.3, -0.2, -0.2)).norm(), 1e-15);
}

// Two points of two links, the line between them as the normal: the slope of their distance.
TEST(KinematicsTest, DistanceRowIsTheSlopeOfTheDistanceOfTwoPoints) {
  Random random(62);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 300; ++i) {
    const RobotModel model = RandomRobot(random, 8, i % 2 == 0);
    const Eigen::VectorXd q = RandomPositions(model, random);
    const int a = std::uniform_int_distribution<int>(0, 8)(random);
    const int b = std::uniform_int_distribution<int>(0, 8)(random);
    const Eigen::Vector3d p_a = RandomUnitVector(random), p_b = 2.0 * RandomUnitVector(random);
    const auto distance = [&](const Eigen::VectorXd& at) {
      const auto X_WL = LinkPoses(model, at);
      return (X_WL[a] * p_a - X_WL[b] * p_b).norm();
    };
    const auto X_WL = LinkPoses(model, q);
    const Eigen::Vector3d p_A = X_WL[a] * p_a, p_B = X_WL[b] * p_b;
    Eigen::VectorXd row(model.num_positions());
    DistanceRow(model, X_WL, a, p_A, b, p_B, (p_A - p_B).normalized(), row);
    for (int j = 0; j < model.num_positions(); ++j) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(q.size(), j);
      const double slope = (distance(q + step) - distance(q - step)) / (2.0 * kStep);
      EXPECT_NEAR(row[j], slope, 1e-6 * (1.0 + std::abs(slope))) << a << " " << b << " " << j;
    }
  }
}

}  // namespace kinematics_test
}  // namespace oca::robot::test
