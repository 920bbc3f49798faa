// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "oca/framework/dataflow/error.h"
#include "tests/temporary_folder.h"

namespace oca::systems {
namespace obstacle_motion_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Isometry3d StartPose() {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1.0, 2.0, 3.0);
  pose.linear() = Eigen::AngleAxisd(0.5, Vector3d(1.0, 1.0, 0.0).normalized()).toRotationMatrix();
  return pose;
}

Motion Make(const MotionParams& params) { return MakeMotion(params, StartPose(), "motion"); }

std::string RefusalOf(const MotionParams& params) {
  try {
    Make(params);
  } catch (const ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "was accepted";
  return "";
}

MotionParams Linear() {
  MotionParams params;
  params.type = MotionType::kLinear;
  params.velocity = Vector3d(0.1, -0.2, 0.3);
  params.angular_velocity = PerComponent(Eigen::VectorXd(Vector3d(0.0, 0.4, -0.3)));
  params.start = 1.0;
  params.stop = 3.0;
  return params;
}

MotionParams Sinusoidal() {
  MotionParams params;
  params.type = MotionType::kSinusoidal;
  params.amplitude = Vector3d(0.0, 0.2, 0.1);
  params.frequency = 0.5;
  params.phase = 0.25;
  return params;
}

MotionParams Circular() {
  MotionParams params;
  params.type = MotionType::kCircular;
  params.center = Vector3d(0.0, 2.0, 3.0);
  params.axis = Vector3d(0.0, 0.0, 2.0);
  params.angular_velocity = PerComponent(0.5);
  return params;
}

MotionParams Waypoints() {
  MotionParams params;
  params.type = MotionType::kWaypoints;
  params.waypoints = std::vector<WaypointParams>{{1.0, {0.0, 0.0, 0.0}, Vector3d(0.0, 0.0, 0.0)},
                                                 {3.0, {1.0, 0.0, 0.0}, Vector3d(0.0, 0.0, 1.0)},
                                                 {4.0, {1.0, 2.0, 0.0}, Vector3d(1.0, 0.0, 1.0)}};
  return params;
}

/// Compares the velocities with the central difference of the pose.
void ExpectTwistIsTheRateOfThePose(const Motion& motion, double time) {
  constexpr double kStep = 1e-6;
  const MotionState now = motion(time);
  const Isometry3d before = motion(time - kStep).X_FO, after = motion(time + kStep).X_FO;
  const Vector3d linear = (after.translation() - before.translation()) / (2.0 * kStep);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(after.linear() * before.linear().transpose()));
  const Vector3d angular = turn.axis() * (turn.angle() / (2.0 * kStep));
  EXPECT_NEAR((now.linear - linear).norm(), 0.0, 1e-8) << time;
  EXPECT_NEAR((now.angular - angular).norm(), 0.0, 1e-8) << time;
}

TEST(ObstacleMotionTest, StandsWithoutAMotion) {
  const MotionState state = Make(MotionParams{})(7.0);
  EXPECT_EQ(state.X_FO.matrix(), StartPose().matrix());
  EXPECT_EQ(state.linear, Vector3d::Zero());
  EXPECT_EQ(state.angular, Vector3d::Zero());
}

TEST(ObstacleMotionTest, HasTheRateOfItsPoseAsTwist) {
  for (const double time : {1.2, 2.9, 5.0}) {
    ExpectTwistIsTheRateOfThePose(Make(Linear()), time);
    ExpectTwistIsTheRateOfThePose(Make(Sinusoidal()), time);
    ExpectTwistIsTheRateOfThePose(Make(Circular()), time);
    ExpectTwistIsTheRateOfThePose(Make(Waypoints()), time);
  }
  ExpectTwistIsTheRateOfThePose(Make(Waypoints()), 3.5);
  ExpectTwistIsTheRateOfThePose(Make(Waypoints()), 0.5);
}

TEST(ObstacleMotionTest, KnowsTheLargestSpeedsOfItsScript) {
  for (const MotionParams& params : {Linear(), Sinusoidal(), Circular(), Waypoints()}) {
    const Motion motion = Make(params);
    double fastest = 0.0, turning = 0.0;
    for (int i = -20000; i < 20000; ++i) {
      const MotionState state = motion(1e-3 * i);
      fastest = std::max(fastest, state.linear.norm());
      turning = std::max(turning, state.angular.norm());
    }
    EXPECT_LE(fastest, motion.fastest * (1.0 + 1e-12));
    EXPECT_GE(fastest, motion.fastest * (1.0 - 1e-4));
    EXPECT_NEAR(turning, motion.turning, 1e-12);
  }
  EXPECT_EQ(Make(MotionParams{}).fastest, 0.0);
}

TEST(ObstacleMotionTest, LinearMovesBetweenStartAndStopOnly) {
  const Motion motion = Make(Linear());
  EXPECT_EQ(motion(0.999).X_FO.translation(), Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(motion(0.999).linear, Vector3d::Zero());
  EXPECT_EQ(motion(1.0).linear, Vector3d(0.1, -0.2, 0.3));
  EXPECT_NEAR((motion(2.0).X_FO.translation() - Vector3d(1.1, 1.8, 3.3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((motion(9.0).X_FO.translation() - Vector3d(1.2, 1.6, 3.6)).norm(), 0.0, 1e-15);
  EXPECT_EQ(motion(2.999).linear, Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(motion(3.0).linear, Vector3d::Zero());
  EXPECT_EQ(motion(3.0).angular, Vector3d::Zero());
}

TEST(ObstacleMotionTest, LinearRotatesAboutItsOrigin) {
  const Isometry3d pose = Make(Linear())(2.0).X_FO;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.linear() * StartPose().linear().transpose()));
  EXPECT_NEAR(turn.angle(), 0.5, 1e-14);
  EXPECT_NEAR((turn.axis() - Vector3d(0.0, 0.8, -0.6)).norm(), 0.0, 1e-14);
}

TEST(ObstacleMotionTest, SinusoidalSwingsAboutItsPose) {
  MotionParams params = Sinusoidal();
  params.phase.reset();
  const Motion motion = Make(params);
  EXPECT_EQ(motion(0.0).X_FO.translation(), Vector3d(1.0, 2.0, 3.0));
  EXPECT_NEAR((motion(0.5).X_FO.translation() - Vector3d(1.0, 2.2, 3.1)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((motion(1.5).X_FO.translation() - Vector3d(1.0, 1.8, 2.9)).norm(), 0.0, 1e-14);
  // Fastest at the middle: amplitude times 2 pi f.
  EXPECT_NEAR(motion(0.0).linear.y(), 0.2 * std::numbers::pi, 1e-14);
}

TEST(ObstacleMotionTest, CircularTurnsTheWholePoseAboutTheAxis) {
  // A quarter turn about (0, 2, .): from one metre along x to one along y.
  const MotionState state = Make(Circular())(std::numbers::pi);
  EXPECT_NEAR((state.X_FO.translation() - Vector3d(0.0, 3.0, 3.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((state.linear - Vector3d(-0.5, 0.0, 0.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((state.angular - Vector3d(0.0, 0.0, 0.5)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(
      (state.X_FO.linear().col(2) - Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitZ()) *
                                        Vector3d(StartPose().linear().col(2)))
          .norm(),
      0.0, 1e-14);
}

TEST(ObstacleMotionTest, InterpolatesWaypointsAndHoldsTheEnds) {
  const Motion motion = Make(Waypoints());
  EXPECT_EQ(motion(0.0).X_FO.translation(), Vector3d::Zero());
  EXPECT_EQ(motion(0.0).linear, Vector3d::Zero());
  EXPECT_NEAR((motion(2.0).X_FO.translation() - Vector3d(0.5, 0.0, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((motion(3.5).X_FO.translation() - Vector3d(1.0, 1.0, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_EQ(motion(3.0).linear, Vector3d(0.0, 2.0, 0.0));  // at a corner the piece to the right
  EXPECT_EQ(motion(4.0).X_FO.translation(), Vector3d(1.0, 2.0, 0.0));
  EXPECT_EQ(motion(4.0).linear, Vector3d::Zero());
  EXPECT_EQ(motion(99.0).X_FO.translation(), Vector3d(1.0, 2.0, 0.0));
  const Eigen::AngleAxisd half(Eigen::Matrix3d(motion(2.0).X_FO.linear()));
  EXPECT_NEAR(half.angle(), 0.5, 1e-14);
}

TEST(ObstacleMotionTest, KeepsItsRotationWhereWaypointsHaveNone) {
  MotionParams params = Waypoints();
  for (WaypointParams& point : *params.waypoints) point.rpy.reset();
  EXPECT_TRUE(Make(params)(2.0).X_FO.linear().isApprox(StartPose().linear(), 1e-15));
}

TEST(ObstacleMotionTest, RefusesKeysOfAnotherMotion) {
  MotionParams params = Linear();
  params.frequency = 1.0;
  EXPECT_THAT(RefusalOf(params), HasSubstr("motion.frequency: got a value"));
  params = Linear();
  params.velocity.reset();
  EXPECT_THAT(RefusalOf(params), HasSubstr("motion.velocity: got none"));
  params = MotionParams{};
  params.velocity = Vector3d::Zero();
  EXPECT_THAT(RefusalOf(params), HasSubstr("motion.velocity"));
}

TEST(ObstacleMotionTest, RefusesNumbersThatMakeNoMotion) {
  const auto changed = [](MotionParams params, auto change) {
    change(params);
    return RefusalOf(params);
  };
  EXPECT_THAT(changed(Linear(), [](auto& p) { p.stop = 1.0; }), HasSubstr("motion.stop"));
  EXPECT_THAT(changed(Linear(), [](auto& p) { p.start = kNaN; }), HasSubstr("motion.start"));
  EXPECT_THAT(changed(Linear(), [](auto& p) { p.velocity->x() = kNaN; }), HasSubstr("finite"));
  EXPECT_THAT(changed(Linear(), [](auto& p) { p.angular_velocity = PerComponent(1.0); }),
              HasSubstr("list of 3"));
  EXPECT_THAT(changed(Sinusoidal(), [](auto& p) { p.frequency = 0.0; }), HasSubstr("> 0"));
  EXPECT_THAT(changed(Circular(), [](auto& p) { p.axis = Vector3d::Zero(); }),
              HasSubstr("motion.axis"));
  EXPECT_THAT(changed(Circular(),
                      [](auto& p) {
                        p.angular_velocity = PerComponent(Eigen::VectorXd(Vector3d::Ones()));
                      }),
              HasSubstr("expected a number"));
  EXPECT_THAT(changed(Waypoints(), [](auto& p) { p.waypoints->clear(); }), HasSubstr("empty"));
  EXPECT_THAT(changed(Waypoints(), [](auto& p) { (*p.waypoints)[1].time = 1.0; }),
              HasSubstr("waypoints[1].time"));
  EXPECT_THAT(changed(Waypoints(), [](auto& p) { (*p.waypoints)[2].rpy.reset(); }),
              HasSubstr("waypoints[2].rpy"));
}

class CsvMotionTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& text) const {
    return folder_.Write("motion.csv", text).string();
  }
  std::string Refusal(const std::string& text) {
    try {
      ReadWaypoints(Write(text));
    } catch (const ConfigError& error) {
      return error.what();
    }
    ADD_FAILURE() << "was accepted: " << text;
    return "";
  }

  const test::TemporaryFolder folder_;
};

TEST_F(CsvMotionTest, FollowsTheRowsOfATable) {
  MotionParams params;
  params.type = MotionType::kCsv;
  params.file = Write("time,x,y,z\n0, 1, 2, 3\r\n2,3,2,-1e0\n\n");
  const Motion motion = Make(params);
  EXPECT_EQ(motion(1.0).X_FO.translation(), Vector3d(2.0, 2.0, 1.0));
  EXPECT_EQ(motion(1.0).linear, Vector3d(1.0, 0.0, -2.0));
}

TEST_F(CsvMotionTest, ReadsRotationsIfThereAreColumnsForThem) {
  const auto waypoints = ReadWaypoints(Write("time,x,y,z,roll,pitch,yaw\n0,1,2,3,0.1,0.2,0.3\n"));
  ASSERT_EQ(waypoints.size(), 1u);
  EXPECT_EQ(*waypoints[0].rpy, Vector3d(0.1, 0.2, 0.3));
}

TEST_F(CsvMotionTest, GoesByTheNamesOfColumnsInAnyOrder) {
  const auto waypoints =
      ReadWaypoints(Write("# by hand\n\nyaw,note,z,y,x,roll,pitch,time\n6,9,3,2,1,4,5,+0\n"));
  ASSERT_EQ(waypoints.size(), 1u);
  EXPECT_EQ(waypoints[0].time, 0.0);
  EXPECT_EQ(waypoints[0].xyz, Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(*waypoints[0].rpy, Vector3d(4.0, 5.0, 6.0));
  EXPECT_THAT(Refusal("time,x,y,z,roll\n0,1,2,3,4\n"), HasSubstr("no 'pitch'"));
}

TEST_F(CsvMotionTest, RefusesWhatIsNoSuchTable) {
  EXPECT_THAT(Refusal(""), HasSubstr("names of columns; got none"));
  EXPECT_THAT(Refusal("t,x,y,z\n"), HasSubstr(":1: names of columns"));
  EXPECT_THAT(Refusal("time,x,y,z\n0,1,2\n"),
              HasSubstr(":2: wrong length; got 3 values; expected 4"));
  EXPECT_THAT(Refusal("time,x,y,z\n0,1,2,3\n1,1,nan,3\n"),
              HasSubstr(":3: column 3 ('y'): not a number; got 'nan'"));
  EXPECT_THAT(Refusal("time,x,y,z\n0,1,2,3m\n"), HasSubstr("'3m'"));
  MotionParams params;
  params.type = MotionType::kCsv;
  params.file = "no_such_table.csv";
  EXPECT_THAT(RefusalOf(params), HasSubstr("no_such_table.csv: cannot be read"));
  params.file = Write("time,x,y,z\n");
  EXPECT_THAT(RefusalOf(params), HasSubstr("at least one waypoint"));
}

}  // namespace obstacle_motion_test
}  // namespace oca::systems
