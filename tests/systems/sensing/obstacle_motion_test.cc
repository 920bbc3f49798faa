// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "tests/temporary_folder.h"

namespace oca::systems {
namespace obstacle_motion_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

Isometry3d StartPose() {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(1.0, 2.0, 3.0);
  pose.linear() = Eigen::AngleAxisd(0.5, Vector3d(1.0, 1.0, 0.0).normalized()).toRotationMatrix();
  return pose;
}

motion::ScriptedMotion Make(const MotionParams& params) {
  return MakeMotion(params, StartPose(), "motion");
}

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

/// At several times, before and after corners.
void ExpectSame(const motion::ScriptedMotion& got, const motion::ScriptedMotion& expected) {
  EXPECT_EQ(got.fastest, expected.fastest);
  EXPECT_EQ(got.turning, expected.turning);
  for (const double time : {0.0, 1.2, 2.9, 3.5, 5.0}) {
    EXPECT_EQ(got(time).X_FO.matrix(), expected(time).X_FO.matrix()) << time;
    EXPECT_EQ(got(time).linear, expected(time).linear) << time;
    EXPECT_EQ(got(time).angular, expected(time).angular) << time;
  }
}

TEST(ObstacleMotionTest, IsTheScriptOfItsType) {
  const auto make = [](const auto& script) {
    return motion::MakeMotion(script, StartPose(), "motion");
  };
  ExpectSame(Make(MotionParams{}), motion::StandingMotion(StartPose()));
  ExpectSame(Make(Linear()), make(motion::LinearScript{Vector3d(0.1, -0.2, 0.3),
                                                       Vector3d(0.0, 0.4, -0.3), 1.0, 3.0}));
  ExpectSame(Make(Sinusoidal()),
             make(motion::SinusoidalScript{Vector3d(0.0, 0.2, 0.1), 0.5, 0.25}));
  ExpectSame(Make(Circular()),
             make(motion::CircularScript{Vector3d(0.0, 2.0, 3.0), Vector3d(0.0, 0.0, 2.0), 0.5}));
  MotionParams turning = Linear();
  turning.type = MotionType::kTurning;
  ExpectSame(Make(turning), make(motion::TurningScript{Vector3d(0.1, -0.2, 0.3),
                                                       Vector3d(0.0, 0.4, -0.3), 1.0, 3.0}));
  MotionParams falling;
  falling.type = MotionType::kAccelerating;
  falling.acceleration = Vector3d(0.0, 0.0, -9.8);
  falling.stop = 2.0;
  ExpectSame(Make(falling), make(motion::AcceleratingScript{Vector3d::Zero(),
                                                            Vector3d(0.0, 0.0, -9.8), 0.0, 2.0}));
  std::vector<motion::Waypoint> waypoints;
  const MotionParams params = Waypoints();
  for (const WaypointParams& point : *params.waypoints) {
    waypoints.push_back({point.time, point.xyz, point.rpy});
  }
  ExpectSame(Make(Waypoints()), make(waypoints));
  MotionParams smooth = Waypoints();
  smooth.smooth = true;
  ExpectSame(Make(smooth),
             motion::MakeMotion(waypoints, StartPose(), "motion", motion::Pace::kSmooth));
}

TEST(ObstacleMotionTest, FollowsTheRowsOfATable) {
  const test::TemporaryFolder folder;
  MotionParams params;
  params.type = MotionType::kCsv;
  params.file = folder.Write("motion.csv", "time,x,y,z\n0,1,2,3\n2,3,2,-1\n").string();
  const auto script = Make(params);
  EXPECT_EQ(script(1.0).X_FO.translation(), Vector3d(2.0, 2.0, 1.0));
  EXPECT_EQ(script(1.0).linear, Vector3d(1.0, 0.0, -2.0));
  params.file = "no_such_table.csv";
  EXPECT_THAT(RefusalOf(params), HasSubstr("no_such_table.csv: cannot be read"));
  params.file = folder.Write("empty.csv", "time,x,y,z\n").string();
  EXPECT_THAT(RefusalOf(params), HasSubstr("at least one waypoint"));
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

TEST(ObstacleMotionTest, RefusesAnAngularVelocityOfAnotherKind) {
  MotionParams params = Linear();
  params.angular_velocity = PerComponent(1.0);
  EXPECT_THAT(RefusalOf(params),
              HasSubstr("motion.angular_velocity: got a number; expected a list"));
  params = Circular();
  params.angular_velocity = PerComponent(Eigen::VectorXd(Vector3d::Ones()));
  EXPECT_THAT(RefusalOf(params), HasSubstr("expected a number"));
}

TEST(ObstacleMotionTest, PassesOnWhatTheScriptRefuses) {
  MotionParams params = Linear();
  params.stop = 1.0;
  EXPECT_THAT(RefusalOf(params), HasSubstr("motion.stop: got 1 s"));
  params = Waypoints();
  (*params.waypoints)[1].time = 1.0;
  EXPECT_THAT(RefusalOf(params), HasSubstr("motion.waypoints[1].time"));
}

}  // namespace obstacle_motion_test
}  // namespace oca::systems
