// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/tip_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"

namespace oca::planning {
namespace tip_path_test {

using Eigen::Vector3d;
using ::testing::HasSubstr;

/// Links of 0.5 and 0.4 m in a plane, 0.2 m above the world's.
robot::RobotModel Arm() {
  robot::LoadOptions options;
  options.X_WB.translation().z() = 0.2;
  return robot::LoadUrdf(OCA_SOURCE_DIR "/models/robots/planar2/planar2.urdf", options);
}

const Eigen::Vector2d kPosture{0.1, 0.8};

std::string RefusalOf(const TipPath& path, const Eigen::VectorXd& posture) {
  const robot::RobotModel arm = Arm();
  try {
    KeyPointsAlong(arm, arm.FindLink("planar2_tip"), path, posture, {});
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TipPathTest, OfALineGoesFromEndToEnd) {
  const TipPath line = LinePath({1, 2, 3}, {3, 2, 1});
  EXPECT_EQ(line(0.0), Vector3d(1, 2, 3));
  EXPECT_EQ(line(0.25), Vector3d(1.5, 2, 2.5));
  EXPECT_EQ(line(1.0), Vector3d(3, 2, 1));
}

TEST(TipPathTest, OfACircleGoesCounterClockwiseFromItsTop) {
  const TipPath upright = CirclePath({1, 0, 0}, {2, 0, 0}, 0.5);  // from z towards -y about x
  EXPECT_LT((upright(0.0) - Vector3d(1, 0, 0.5)).norm(), 1e-15);
  EXPECT_LT((upright(0.25) - Vector3d(1, -0.5, 0)).norm(), 1e-15);
  EXPECT_LT((upright(1.0) - upright(0.0)).norm(), 1e-15);
  const TipPath level = CirclePath({0, 0, 1}, {0, 0, 1}, 0.5);  // from x towards y about z
  EXPECT_LT((level(0.0) - Vector3d(0.5, 0, 1)).norm(), 1e-15);
  EXPECT_LT((level(0.25) - Vector3d(0, 0.5, 1)).norm(), 1e-15);
  EXPECT_THROW(CirclePath({0, 0, 0}, {0, 0, 0}, 0.5), models::ModelError);
}

TEST(TipPathTest, IsFollowedByTheTipAfterAnApproachFromThePosture) {
  const robot::RobotModel arm = Arm();
  const int tip = arm.FindLink("planar2_tip");
  const TipPath line = LinePath({0.7, 0.3, 0.0}, {0.4, 0.6, 0.0});
  const auto points = KeyPointsAlong(arm, tip, line, kPosture, {1.0, 0.5, 2.0});
  ASSERT_EQ(points.size(), 25u + 101u);
  EXPECT_EQ(points.front().time, 1.0);
  EXPECT_EQ(points.front().position, kPosture);
  EXPECT_EQ(points.back().time, 3.5);
  for (std::size_t i = 25; i < points.size(); ++i) {
    const double x = static_cast<double>(i - 25) / 100.0;
    const double s = x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
    const Vector3d p_W = robot::LinkPoses(arm, points[i].position)[tip].translation();
    EXPECT_LT((p_W - line(s) - Vector3d(0, 0, 0.2)).norm(), 1e-8) << x;
    EXPECT_DOUBLE_EQ(points[i].time, 1.5 + 2.0 * x);
  }
}

/// Largest distance of the tip from the path, m, and largest change of a joint between two points.
std::pair<double, double> Followed(const robot::RobotModel& arm, const std::string& link,
                                   const TipPath& path, const Eigen::VectorXd& posture) {
  const int tip = arm.FindLink(link);
  const auto points =
      KeyPointsAlong(arm, tip, path, posture, {.start = 0, .approach = 1, .duration = 2});
  double off = 0.0;
  double change = 0.0;
  for (std::size_t i = 50; i < points.size(); ++i) {
    const double x = static_cast<double>(i - 50) / 100.0;
    const double s = x * x * x * (10.0 + x * (-15.0 + 6.0 * x));
    const auto X_WL = robot::LinkPoses(arm, points[i].position);
    const Vector3d p = arm.X_WB().inverse() * X_WL[static_cast<std::size_t>(tip)].translation();
    off = std::max(off, (p - path(s)).norm());
    if (i > 50) {
      change =
          std::max(change, (points[i].position - points[i - 1].position).cwiseAbs().maxCoeff());
    }
    EXPECT_TRUE((points[i].position.array() >= arm.lower_limits().array()).all());
    EXPECT_TRUE((points[i].position.array() <= arm.upper_limits().array()).all());
  }
  return {off, change};
}

TEST(TipPathTest, IsFollowedFromAStretchedArm) {
  // Straight back along the arm, where no joint moves the tip that way at first.
  const auto [off, change] =
      Followed(Arm(), "planar2_tip", LinePath({0.7, 0, 0}, {0.5, 0, 0}), Eigen::Vector2d(0, 0));
  EXPECT_LT(off, 1e-8);
  EXPECT_LT(change, 0.1);
  const auto upright = robot::LoadUrdf(OCA_SOURCE_DIR "/models/robots/lwr4/lwr4.urdf");
  EXPECT_LT(Followed(upright, "lwr4_flange", LinePath({0, 0, 0.98}, {0, 0, 0.78}),
                     Eigen::VectorXd::Zero(7))
                .first,
            1e-8);
}

TEST(TipPathTest, IsFollowedFromTheEndOfReachItself) {
  const auto [off, change] =
      Followed(Arm(), "planar2_tip", LinePath({0.9, 0, 0}, {0.5, 0, 0}), Eigen::Vector2d(0, 0));
  EXPECT_LT(off, 1e-8);
  EXPECT_LT(change, 0.1);
}

TEST(TipPathTest, IsRefusedBeyondReachAndLimitsAndFromAnotherPosture) {
  EXPECT_EQ(RefusalOf(LinePath({0.7, 0.3, 0.0}, {0.4, 0.6, 0.0}), kPosture), "accepted");
  EXPECT_THAT(RefusalOf(LinePath({0.7, 0.3, 0.0}, {0.95, 0.0, 0.0}), kPosture),
              HasSubstr("path: the tip cannot reach"));
  EXPECT_THAT(RefusalOf(LinePath({0.7, 0.3, 0.0}, {0.4, 0.6, 0.0}), Eigen::Vector2d(0.1, 9.0)),
              HasSubstr("path: takes joint"));
  EXPECT_THAT(RefusalOf(LinePath({0.7, 0.3, 0.0}, {0.4, 0.6, 0.0}), Eigen::Vector3d::Zero()),
              HasSubstr("posture: got 3 numbers; expected 2"));
}

}  // namespace tip_path_test
}  // namespace oca::planning
