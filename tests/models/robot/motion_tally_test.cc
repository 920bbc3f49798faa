// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/motion_tally.h"

#include <gtest/gtest.h>

#include <vector>

#include "oca/models/robot/urdf.h"

namespace oca::robot {
namespace motion_tally_test {

/// Samples every 0.1 s of what is set.
class MotionTallyTest : public testing::Test {
 protected:
  void Add() {
    tally_.Add(Sample());
    time_ += 0.1;
  }
  MotionMetricsValue Now() { return tally_.At(Sample()); }
  MotionSample Sample() const {
    MotionSample sample{.time = time_, .proximities = &near_};
    if (q_.size() > 0) sample.position.emplace(q_.data(), q_.size());
    if (goal_.size() > 0) sample.goal.emplace(goal_.data(), goal_.size());
    if (delta_.size() > 0) sample.delta.emplace(delta_.data(), delta_.size());
    return sample;
  }
  MotionTally tally_;
  double time_{0.0};
  ProximitySet near_;
  Eigen::VectorXd q_, goal_, delta_;
};

TEST_F(MotionTallyTest, HasNoMetricOfWhatIsNotMeasured) {
  Add();
  const MotionMetricsValue value = Now();
  EXPECT_FALSE(value.min_distance || value.contact_time || value.max_abs_delta ||
               value.final_error || value.max_joint_speed || value.limit_violations);
  EXPECT_EQ(tally_.samples(), 1);
  EXPECT_TRUE(tally_.finite());
}

TEST_F(MotionTallyTest, KeepsTheLeastDistanceWithItsPairAndTimeAndCountsContact) {
  for (const double distance : {0.2, -0.1, 0.0, 0.3}) {
    near_.proximities.assign(1, Proximity{});
    near_.proximities[0].link = models::Name("hand");
    near_.proximities[0].obstacle = models::Name("box");
    near_.proximities[0].distance = distance;
    near_.compared = true;
    Add();
  }
  const MotionMetricsValue value = Now();
  EXPECT_EQ(value.min_distance, -0.1);
  EXPECT_EQ(value.min_distance_link, models::Name("hand"));
  EXPECT_EQ(value.min_distance_time, 0.1);
  EXPECT_EQ(value.first_contact_time, 0.1);
  EXPECT_NEAR(value.contact_time.value(), 0.2, 1e-15);  // from -0.1 to 0.3
}

TEST_F(MotionTallyTest, IsAtTheGoalFromTheFirstOfTheLastSamplesThatAre) {
  goal_ = Eigen::Vector2d(1.0, 0.0);
  for (const double q : {0.0, 0.995, 0.5, 0.995, 1.0}) {
    q_ = Eigen::Vector2d(q, 0.0);
    Add();
  }
  EXPECT_NEAR(Now().time_to_goal.value(), 0.3, 1e-15);
  EXPECT_EQ(Now().final_error, 0.0);
  EXPECT_NEAR(Now().max_joint_speed.value(), 9.95, 1e-12);
}

TEST_F(MotionTallyTest, AddsUpTheWayOfTheJointsAndTellsTheSpeedOfTheLastStep) {
  const Eigen::Vector2d points[] = {{0.0, 0.0}, {0.3, 0.4}, {0.3, -0.6}, {0.3, -0.61}};
  for (const Eigen::Vector2d& point : points) {
    q_ = point;
    Add();
    if (tally_.samples() == 1) {
      EXPECT_FALSE(Now().path_length || Now().final_speed);
    }
  }
  EXPECT_NEAR(Now().path_length.value(), 0.5 + 1.0 + 0.01, 1e-12);
  EXPECT_NEAR(Now().final_speed.value(), 0.1, 1e-9);
  EXPECT_NEAR(Now().max_joint_speed.value(), 10.0, 1e-9);
}

TEST_F(MotionTallyTest, CountsReversalsOfTheDeltaThatAreNoRounding) {
  for (const double delta : {0.0, 0.1, 0.1 - 1e-7, 0.2, 0.1, 0.2}) {
    delta_ = Eigen::VectorXd::Constant(1, delta);
    Add();
  }
  time_ -= 0.1;  // at the last sample, 0.5 s after the first
  EXPECT_NEAR(Now().delta_sign_changes_per_second.value(), 2.0 / 0.5, 1e-12);
  EXPECT_EQ(Now().max_abs_delta, 0.2);
}

TEST_F(MotionTallyTest, CountsTheJointsBeyondALimitAtEachSample) {
  const RobotModel plain = LoadUrdf(OCA_SOURCE_DIR "/models/robots/lwr4/lwr4.urdf");
  auto joints = plain.joints();
  for (auto& joint : joints) joint.acceleration_limit = 2.0;
  const RobotModel model(plain.name(), plain.links(), joints);
  // The first joint goes through the positions, one each 0.1 s.
  const auto violations = [&](const std::vector<double>& positions) {
    MotionTally tally;
    double time = 0.0;
    double count = -1.0;
    for (const double position : positions) {
      Eigen::VectorXd value = Eigen::VectorXd::Zero(7);
      value[0] = position;
      MotionSample sample{};
      sample.time = time;
      sample.position.emplace(value.data(), value.size());
      sample.model = &model;
      tally.Add(sample);
      count = tally.At(sample).limit_violations.value();
      time += 0.1;
    }
    return count;
  };
  const double v = model.velocity_limits()[0], upper = model.upper_limits()[0];
  EXPECT_EQ(violations({0.0, 0.1 * v, 0.2 * v}), 0.0);
  EXPECT_EQ(violations({0.0, 0.1001 * v, 0.2002 * v}), 2.0);
  EXPECT_EQ(violations({upper, upper}), 0.0);
  EXPECT_EQ(violations({upper + 1e-5, upper + 1e-5, upper}), 2.0);
  EXPECT_EQ(violations({-upper - 1e-5}), 1.0);
  EXPECT_EQ(violations({0.0, 0.0, 0.02}), 0.0);
  EXPECT_EQ(violations({0.0, 0.0, 0.0201}), 1.0);
}

TEST_F(MotionTallyTest, NamesTheLimitThatTheGoalOfAStandingJointIsBeyond) {
  const RobotModel model = LoadUrdf(OCA_SOURCE_DIR "/models/robots/lwr4/lwr4.urdf");
  const double upper = model.upper_limits()[0];
  near_.proximities.assign(1, Proximity{});
  near_.proximities[0].link = models::Name("hand");
  near_.proximities[0].obstacle = models::Name("box");
  near_.proximities[0].distance = 0.04;
  near_.compared = true;
  // Joint 1 stands `off` its limit for 3 s, asked for what is `beyond` that.
  const auto standing = [&](double off, double beyond) {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(7), goal = q;
    q[0] = upper - off;
    goal[0] = upper + beyond;
    MotionTally tally;
    MotionSample sample{.proximities = &near_, .model = &model};
    sample.position.emplace(q.data(), q.size());
    sample.goal.emplace(goal.data(), goal.size());
    for (int k = 0; k <= 30; ++k) {
      sample.time = 0.1 * k;
      tally.Add(sample);
    }
    return tally.At(sample);
  };
  const MotionMetricsValue limit = standing(0.019, 0.25);
  EXPECT_EQ(limit.stuck_link, model.position_names()[0]);
  EXPECT_EQ(limit.stuck_obstacle, models::Name("limit"));
  EXPECT_NEAR(limit.stuck_amount.value(), 0.25, 1e-12);
  for (const MotionMetricsValue& box : {standing(0.021, 0.25), standing(0.019, 0.009)}) {
    EXPECT_EQ(box.stuck_link, models::Name("hand"));
    EXPECT_EQ(box.stuck_obstacle, models::Name("box"));
    EXPECT_EQ(box.stuck_amount, 0.04);
  }
}

}  // namespace motion_tally_test
}  // namespace oca::robot
