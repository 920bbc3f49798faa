// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/scripted_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "oca/models/error.h"

namespace oca::motion {
namespace scripted_motion_test {

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

template <class Script>
ScriptedMotion Make(const Script& script) {
  return MakeMotion(script, StartPose(), "motion");
}

template <class Script>
std::string RefusalOf(const Script& script) {
  try {
    Make(script);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  ADD_FAILURE() << "was accepted";
  return "";
}

LinearScript Linear() { return {Vector3d(0.1, -0.2, 0.3), Vector3d(0.0, 0.4, -0.3), 1.0, 3.0}; }

SinusoidalScript Sinusoidal() { return {Vector3d(0.0, 0.2, 0.1), 0.5, 0.25}; }

CircularScript Circular() { return {Vector3d(0.0, 2.0, 3.0), Vector3d(0.0, 0.0, 2.0), 0.5}; }

TurningScript Turning() { return {Vector3d(0.5, 0.0, 0.2), Vector3d(0.0, 0.3, 0.8), 1.0, 9.0}; }

AcceleratingScript Accelerating() {
  return {Vector3d(0.3, 0.0, -0.1), Vector3d(0.0, 0.4, -1.0), 1.0, 3.5};
}

std::vector<Waypoint> Waypoints() {
  return {{1.0, {0.0, 0.0, 0.0}, Vector3d(0.0, 0.0, 0.0)},
          {3.0, {1.0, 0.0, 0.0}, Vector3d(0.0, 0.0, 1.0)},
          {4.0, {1.0, 2.0, 0.0}, Vector3d(1.0, 0.0, 1.0)}};
}

ScriptedMotion Smooth() { return MakeMotion(Waypoints(), StartPose(), "motion", Pace::kSmooth); }

/// Compares the velocities with the central difference of the pose.
void ExpectTwistIsTheRateOfThePose(const ScriptedMotion& motion, double time) {
  constexpr double kStep = 1e-6;
  const BodyState now = motion(time);
  const Isometry3d before = motion(time - kStep).X_FO, after = motion(time + kStep).X_FO;
  const Vector3d linear = (after.translation() - before.translation()) / (2.0 * kStep);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(after.linear() * before.linear().transpose()));
  const Vector3d angular = turn.axis() * (turn.angle() / (2.0 * kStep));
  EXPECT_NEAR((now.linear - linear).norm(), 0.0, 1e-8) << time;
  EXPECT_NEAR((now.angular - angular).norm(), 0.0, 1e-8) << time;
}

TEST(ScriptedMotionTest, StandsWithoutAMotion) {
  const BodyState state = StandingMotion(StartPose())(7.0);
  EXPECT_EQ(state.X_FO.matrix(), StartPose().matrix());
  EXPECT_EQ(state.linear, Vector3d::Zero());
  EXPECT_EQ(state.angular, Vector3d::Zero());
}

TEST(ScriptedMotionTest, HasTheRateOfItsPoseAsTwist) {
  for (const double time : {1.2, 2.9, 5.0}) {
    ExpectTwistIsTheRateOfThePose(Make(Linear()), time);
    ExpectTwistIsTheRateOfThePose(Make(Sinusoidal()), time);
    ExpectTwistIsTheRateOfThePose(Make(Circular()), time);
    ExpectTwistIsTheRateOfThePose(Make(Waypoints()), time);
    ExpectTwistIsTheRateOfThePose(Make(Turning()), time);
    ExpectTwistIsTheRateOfThePose(Make(Accelerating()), time);
    ExpectTwistIsTheRateOfThePose(Smooth(), time);
  }
  TurningScript straight = Turning();
  straight.angular_velocity *= 1e-5;  // where the closed form would cancel
  ExpectTwistIsTheRateOfThePose(Make(straight), 5.0);
  ExpectTwistIsTheRateOfThePose(Make(Waypoints()), 3.5);
  ExpectTwistIsTheRateOfThePose(Make(Waypoints()), 0.5);
}

TEST(ScriptedMotionTest, KnowsTheLargestSpeedsOfItsScript) {
  for (const ScriptedMotion& motion :
       {Make(Linear()), Make(Sinusoidal()), Make(Circular()), Make(Waypoints()), Make(Turning()),
        Make(Accelerating()), Smooth()}) {
    double fastest = 0.0, turning = 0.0;
    for (int i = -20000; i < 20000; ++i) {
      const BodyState state = motion(1e-3 * i);
      fastest = std::max(fastest, state.linear.norm());
      turning = std::max(turning, state.angular.norm());
    }
    EXPECT_LE(fastest, motion.fastest * (1.0 + 1e-12));
    EXPECT_GE(fastest, motion.fastest * (1.0 - 1e-4));
    EXPECT_NEAR(turning, motion.turning, 1e-12);
  }
  EXPECT_EQ(StandingMotion(StartPose()).fastest, 0.0);
}

TEST(ScriptedMotionTest, LinearMovesBetweenStartAndStopOnly) {
  const ScriptedMotion motion = Make(Linear());
  EXPECT_EQ(motion(0.999).X_FO.translation(), Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(motion(0.999).linear, Vector3d::Zero());
  EXPECT_EQ(motion(1.0).linear, Vector3d(0.1, -0.2, 0.3));
  EXPECT_NEAR((motion(2.0).X_FO.translation() - Vector3d(1.1, 1.8, 3.3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((motion(9.0).X_FO.translation() - Vector3d(1.2, 1.6, 3.6)).norm(), 0.0, 1e-15);
  EXPECT_EQ(motion(2.999).linear, Vector3d(0.1, -0.2, 0.3));
  EXPECT_EQ(motion(3.0).linear, Vector3d::Zero());
  EXPECT_EQ(motion(3.0).angular, Vector3d::Zero());
}

TEST(ScriptedMotionTest, TurningGoesOnAnArcAndTurnsWithIt) {
  // A quarter turn to the left with 1 m/s and 0.5 rad/s: 2 m ahead, 2 m to the left.
  const ScriptedMotion motion =
      Make(TurningScript{Vector3d(1.0, 0.0, 0.0), Vector3d(0.0, 0.0, 0.5), 1.0, {}});
  const double quarter = 1.0 + std::numbers::pi;
  EXPECT_NEAR((motion(quarter).X_FO.translation() - Vector3d(3.0, 4.0, 3.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((motion(quarter).linear - Vector3d(0.0, 1.0, 0.0)).norm(), 0.0, 1e-14);
  EXPECT_EQ(motion(0.9).linear, Vector3d::Zero());
  EXPECT_EQ(Make(Turning())(9.0).angular, Vector3d::Zero());
  EXPECT_GT(Make(Turning())(8.999).angular.norm(), 0.8);
}

TEST(ScriptedMotionTest, AcceleratingGoesOnAsFastAsItGot) {
  const ScriptedMotion fall =
      Make(AcceleratingScript{Vector3d::Zero(), Vector3d(0.0, 0.0, -10.0), 1.0, 1.5});
  EXPECT_EQ(fall(1.0).X_FO.translation(), Vector3d(1.0, 2.0, 3.0));
  EXPECT_NEAR((fall(1.4).X_FO.translation() - Vector3d(1.0, 2.0, 2.2)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((fall(1.4).linear - Vector3d(0.0, 0.0, -4.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((fall(2.5).X_FO.translation() - Vector3d(1.0, 2.0, 3.0 - 1.25 - 5.0)).norm(), 0.0,
              1e-14);
  EXPECT_NEAR(fall(2.5).linear.z(), -5.0, 1e-14);
  EXPECT_NEAR(fall.fastest, 5.0, 1e-14);
}

TEST(ScriptedMotionTest, SmoothRestsAtWaypointsAndIsFastestBetween) {
  EXPECT_NEAR(Smooth()(1.0 + 1e-9).linear.norm(), 0.0, 1e-12);
  EXPECT_NEAR(Smooth()(3.0 - 1e-6).linear.norm(), 0.0, 1e-9);
  EXPECT_NEAR(Smooth()(2.0).linear.x(), 1.875 * 0.5, 1e-14);
  EXPECT_NEAR(Smooth()(2.0).X_FO.translation().x(), 0.5, 1e-14);
  // A quarter of the time: 10/64 - 15/256 + 6/1024 of the way.
  EXPECT_NEAR(Smooth()(1.5).X_FO.translation().x(), 0.103515625, 1e-14);
  EXPECT_EQ(Smooth()(9.0).X_FO.translation(), Vector3d(1.0, 2.0, 0.0));
}

TEST(ScriptedMotionTest, TurningAndAcceleratingRefuseWhatIsNoSpanAndNoNumber) {
  TurningScript turning = Turning();
  turning.stop = 1.0;
  EXPECT_THAT(RefusalOf(turning), HasSubstr("motion.stop: got 1 s; expected more than start, 1 s"));
  turning.stop.reset();
  turning.angular_velocity.x() = kNaN;
  EXPECT_THAT(RefusalOf(turning), HasSubstr("NaN"));
  AcceleratingScript accelerating = Accelerating();
  accelerating.stop = 0.5;
  EXPECT_THAT(RefusalOf(accelerating), HasSubstr("motion.stop: got 0.5 s"));
  accelerating.stop = std::numeric_limits<double>::infinity();
  EXPECT_THAT(RefusalOf(accelerating), HasSubstr("motion.stop"));
}

TEST(ScriptedMotionTest, LinearRotatesAboutItsOrigin) {
  const Isometry3d pose = Make(Linear())(2.0).X_FO;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(pose.linear() * StartPose().linear().transpose()));
  EXPECT_NEAR(turn.angle(), 0.5, 1e-14);
  EXPECT_NEAR((turn.axis() - Vector3d(0.0, 0.8, -0.6)).norm(), 0.0, 1e-14);
}

TEST(ScriptedMotionTest, SinusoidalSwingsAboutItsPose) {
  SinusoidalScript script = Sinusoidal();
  script.phase = 0.0;
  const ScriptedMotion motion = Make(script);
  EXPECT_EQ(motion(0.0).X_FO.translation(), Vector3d(1.0, 2.0, 3.0));
  EXPECT_NEAR((motion(0.5).X_FO.translation() - Vector3d(1.0, 2.2, 3.1)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((motion(1.5).X_FO.translation() - Vector3d(1.0, 1.8, 2.9)).norm(), 0.0, 1e-14);
  // Fastest at the middle: amplitude times 2 pi f.
  EXPECT_NEAR(motion(0.0).linear.y(), 0.2 * std::numbers::pi, 1e-14);
}

TEST(ScriptedMotionTest, CircularTurnsTheWholePoseAboutTheAxis) {
  // A quarter turn about (0, 2, .): from one metre along x to one along y.
  const BodyState state = Make(Circular())(std::numbers::pi);
  EXPECT_NEAR((state.X_FO.translation() - Vector3d(0.0, 3.0, 3.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((state.linear - Vector3d(-0.5, 0.0, 0.0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((state.angular - Vector3d(0.0, 0.0, 0.5)).norm(), 0.0, 1e-15);
  EXPECT_NEAR(
      (state.X_FO.linear().col(2) - Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitZ()) *
                                        Vector3d(StartPose().linear().col(2)))
          .norm(),
      0.0, 1e-14);
}

TEST(ScriptedMotionTest, InterpolatesWaypointsAndHoldsTheEnds) {
  const ScriptedMotion motion = Make(Waypoints());
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

TEST(ScriptedMotionTest, KeepsItsRotationWhereWaypointsHaveNone) {
  std::vector<Waypoint> waypoints = Waypoints();
  for (Waypoint& point : waypoints) point.rpy.reset();
  EXPECT_TRUE(Make(waypoints)(2.0).X_FO.linear().isApprox(StartPose().linear(), 1e-15));
}

TEST(ScriptedMotionTest, RefusesNumbersThatMakeNoMotion) {
  const auto changed = [](auto script, auto change) {
    change(script);
    return RefusalOf(script);
  };
  EXPECT_THAT(changed(Linear(), [](auto& s) { s.stop = 1.0; }), HasSubstr("motion.stop"));
  EXPECT_THAT(changed(Linear(), [](auto& s) { s.stop = kNaN; }), HasSubstr("motion.stop"));
  EXPECT_THAT(changed(Linear(), [](auto& s) { s.start = kNaN; }), HasSubstr("motion.start"));
  EXPECT_THAT(changed(Linear(), [](auto& s) { s.velocity.x() = kNaN; }), HasSubstr("finite"));
  EXPECT_THAT(changed(Sinusoidal(), [](auto& s) { s.frequency = 0.0; }), HasSubstr("> 0"));
  EXPECT_THAT(changed(Sinusoidal(), [](auto& s) { s.phase = kNaN; }), HasSubstr("motion.phase"));
  EXPECT_THAT(changed(Circular(), [](auto& s) { s.axis = Vector3d::Zero(); }),
              HasSubstr("motion.axis"));
  EXPECT_THAT(changed(Waypoints(), [](auto& s) { s.clear(); }), HasSubstr("empty"));
  EXPECT_THAT(changed(Waypoints(), [](auto& s) { s[1].time = 1.0; }), HasSubstr("motion[1].time"));
  EXPECT_THAT(changed(Waypoints(), [](auto& s) { s[2].rpy.reset(); }), HasSubstr("motion[2].rpy"));
}

TEST(ScriptedMotionTest, WithoutAStopGoesOn) {
  LinearScript script = Linear();
  script.stop.reset();
  EXPECT_EQ(Make(script)(1e6).linear, script.velocity);
}

}  // namespace scripted_motion_test
}  // namespace oca::motion
