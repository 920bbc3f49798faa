// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/safety_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "tests/allocation_count.h"
#include "tests/systems/methods/filter_bench.h"

namespace oca::systems {
namespace safety_filter_test {

using filter_bench::BesideTheTip;
using filter_bench::Hundred;
using filter_bench::kDt;
using filter_bench::Loop;

/// The velocity that a filter at rest in (0, 0) chooses for a request of `wish` rad/s.
Eigen::VectorXd Answer(const SafetyFilter::Params& params, const Eigen::Vector2d& wish,
                       const ProximitySet& set, FilterActivity* activity = nullptr) {
  Loop loop(params, TestModels("planar2"), Eigen::Vector2d::Zero());
  const auto& report =
      loop.Tick(wish / params.position_gain, [&](const LinkPoses&) { return set; });
  if (activity != nullptr) *activity = report;
  return loop.velocity();
}

TEST(SafetyFilterTest, GrantsARequestThatNothingStandsInTheWayOf) {
  FilterActivity activity;
  const Eigen::VectorXd u = Answer(Hundred(), {0.5, -0.25}, {}, &activity);
  EXPECT_NEAR((u - Eigen::Vector2d(0.5, -0.25)).norm(), 0.0, 1e-13);
  EXPECT_EQ(activity.num_bounds, 0);
  EXPECT_EQ(activity.status, qp::QpStatus::kOptimal);
}

TEST(SafetyFilterTest, ProjectsTheRequestOntoTheRowByHand) {
  // At h = 0.03 the tip may approach with 5 * 0.03 m/s: (0.9, 0.4) . u <= 0.15. The request (1, 0)
  // asks for 0.9, so u = (1, 0) - 0.75 / 0.97 (0.9, 0.4).
  FilterActivity activity;
  const Eigen::VectorXd u = Answer(Hundred(), {1, 0}, BesideTheTip(0.08, 0.0), &activity);
  EXPECT_NEAR((u - Eigen::Vector2d(1 - 0.675 / 0.97, -0.3 / 0.97)).norm(), 0.0, 1e-12);
  ASSERT_EQ(activity.num_bounds, 1);
  EXPECT_EQ(activity.bounds[0].kind, FilterBound::Kind::kDistance);
  EXPECT_EQ(activity.bounds[0].link.text(), "planar2_link_2");
  EXPECT_EQ(activity.bounds[0].obstacle.text(), "ball");
  EXPECT_NEAR(activity.bounds[0].multiplier, 0.75 / 0.97, 1e-12);
  EXPECT_EQ(activity.slack, 0.0);
}

// The same row for a pair of which 0.02 m are asked at most: h is 0.03 at 0.05.
TEST(SafetyFilterTest, KeepsNoMoreThanTheRangeOfAPair) {
  ProximitySet near = BesideTheTip(0.05, 0.0);
  near.proximities[0].range = 0.02;
  const Eigen::VectorXd u = Answer(Hundred(), {1, 0}, near);
  EXPECT_NEAR((u - Eigen::Vector2d(1 - 0.675 / 0.97, -0.3 / 0.97)).norm(), 0.0, 1e-12);
  near.proximities[0].range = 0.07;  // more than is kept of all
  EXPECT_NEAR(
      (Answer(Hundred(), {1, 0}, near) - Answer(Hundred(), {1, 0}, BesideTheTip(0.05, 0.0))).norm(),
      0.0, 1e-12);
}

TEST(SafetyFilterTest, LetsTheArmMoveAwayAsFastAsItLikes) {
  const Eigen::VectorXd u = Answer(Hundred(), {-1, 0}, BesideTheTip(0.0501, 0.0));
  EXPECT_NEAR((u - Eigen::Vector2d(-1, 0)).norm(), 0.0, 1e-12);
}

TEST(SafetyFilterTest, GivesWayToAnObstacleThatComes) {
  // h = 0: the tip has to leave with the 0.3 m/s that the obstacle comes with.
  const Eigen::VectorXd u = Answer(Hundred(), {0, 0}, BesideTheTip(0.05, 0.3));
  EXPECT_NEAR(0.9 * u[0] + 0.4 * u[1], -0.3, 1e-12);
  EXPECT_NEAR(u[0] / u[1], 0.9 / 0.4, 1e-9);
}

TEST(SafetyFilterTest, BrakesAsHardAsItCanInTheBrakingForm) {
  SafetyFilter::Params params = Hundred();
  params.form = SafetyFilter::Form::kBraking;
  params.deceleration = 2.0;
  // Within 0.03 m a body that brakes with 2 m/s^2 stops from about sqrt(2 * 2 * 0.03) m/s.
  const Eigen::VectorXd u = Answer(params, {1, 0}, BesideTheTip(0.08, 0.0));
  const double speed = 0.9 * u[0] + 0.4 * u[1];
  EXPECT_NEAR(speed, motion::LargestStoppableVelocity(0.03, 2.0, kDt), 1e-12);
  EXPECT_NEAR(speed, -0.01 + std::sqrt(1e-4 + 0.12), 2e-4);
}

TEST(SafetyFilterTest, BelowTheSafeDistanceItRetreatsButNeverForbidsASlowRetreat) {
  // 0.02 m too near: 5 * 0.02 m/s of retreat are wished for.
  const Eigen::VectorXd rest = Answer(Hundred(), {0, 0}, BesideTheTip(0.03, 0.0));
  EXPECT_NEAR(0.9 * rest[0] + 0.4 * rest[1], -0.1, 1e-12);
  SafetyFilter::Params params = Hundred();
  params.recovery_penalty = 0.0;
  FilterActivity activity;
  const Eigen::VectorXd slow = Answer(params, {-0.01, 0}, BesideTheTip(0.03, 0.0), &activity);
  EXPECT_NEAR((slow - Eigen::Vector2d(-0.01, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(activity.slack, 0.0);
  // But it does not let the arm approach.
  const Eigen::VectorXd stay = Answer(params, {0.5, 0}, BesideTheTip(0.03, 0.0));
  EXPECT_NEAR(0.9 * stay[0] + 0.4 * stay[1], 0.0, 1e-12);
}

TEST(SafetyFilterTest, RetreatIsPossibleFromDeepPenetration) {
  SafetyFilter::Params params = Hundred();
  const Eigen::VectorXd u = Answer(params, {0.5, 0}, BesideTheTip(-0.4, 0.0));
  EXPECT_NEAR(0.9 * u[0] + 0.4 * u[1], -params.recovery_speed, 1e-9);
}

TEST(SafetyFilterTest, SaysHowMuchOfARowItCouldNotKeep) {
  // Both joints at their 2 rad/s retreat with 2.6 m/s; the obstacle comes with 4.
  FilterActivity activity;
  const Eigen::VectorXd u = Answer(Hundred(), {0, 0}, BesideTheTip(0.05, 4.0), &activity);
  EXPECT_NEAR((u - Eigen::Vector2d(-2, -2)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(activity.slack, 4.0 - 2.6, 1e-9);
  ASSERT_EQ(activity.num_bounds, 3);
  EXPECT_EQ(activity.bounds[1].kind, FilterBound::Kind::kLower);
  EXPECT_EQ(activity.bounds[1].link.text(), "planar2_joint_1");
  EXPECT_EQ(activity.bounds[1].limit, motion::MotionLimit::kVelocity);
}

TEST(SafetyFilterTest, LeavesOutByNameWhatNoJointMoves) {
  // Something 0.03 m before the tip of the stretched arm, where joints move the tip sideways only:
  // it should grow by 5 * 0.02 m/s. By rounding its point lies beside the axis of the arm.
  for (const double off : {0.0, 1e-17, 1e-14, -1e-13}) {
    ProximitySet set = BesideTheTip(0.08, 0.0);
    set.proximities.push_back(set.proximities[0]);
    Proximity& before = set.proximities[1];
    before.obstacle = models::Name("post");
    before.distance = 0.03;
    before.normal = -Eigen::Vector3d::UnitX();
    before.point_on_link.y() += off;
    FilterActivity activity;
    const Eigen::VectorXd u = Answer(Hundred(), {1, 0}, set, &activity);
    EXPECT_NEAR((u - Eigen::Vector2d(1 - 0.675 / 0.97, -0.3 / 0.97)).norm(), 0.0, 1e-12) << off;
    EXPECT_EQ(activity.status, qp::QpStatus::kOptimal);
    EXPECT_EQ(activity.rows, 1);
    EXPECT_EQ(activity.slack, 0.0);
    ASSERT_EQ(activity.num_bounds, 2) << off;
    EXPECT_EQ(activity.bounds[1].kind, FilterBound::Kind::kUnmovable);
    EXPECT_EQ(activity.bounds[1].obstacle.text(), "post");
    EXPECT_NEAR(activity.bounds[1].slack, 0.1, 1e-15);
    EXPECT_EQ(activity.bounds[1].multiplier, 0.0);
  }
}

TEST(SafetyFilterTest, NamesNothingThatNoJointMovesAndThatNeedsNoMove) {
  ProximitySet set = BesideTheTip(0.06, 0.0);
  set.proximities[0].normal = -Eigen::Vector3d::UnitX();
  FilterActivity activity;
  Answer(Hundred(), {1, 0}, set, &activity);
  EXPECT_EQ(activity.num_bounds, 0);
}

TEST(SafetyFilterTest, BrakesIfItHasNoProofOfItsAnswer) {
  const auto answer = [](double weight) {
    SafetyFilter::Params params = Hundred();
    params.weights = weight;
    return Answer(params, {0.5, 0.5}, BesideTheTip(0.08, 0.0));
  };
  EXPECT_GT(answer(1.0).norm(), 0.1);
  // A price so small that rows in units of it overflow.
  EXPECT_EQ(answer(1e-310), Eigen::VectorXd(Eigen::Vector2d::Zero()));
}

TEST(SafetyFilterTest, KeepsTheNearestRowsIfThereIsNoRoomForAll) {
  SafetyFilter::Params params = Hundred();
  params.most_rows = 1;
  ProximitySet set = BesideTheTip(0.2, 1.0);
  set.proximities.push_back(BesideTheTip(0.08, 0.0).proximities[0]);
  set.proximities.push_back(BesideTheTip(0.3, 1.4).proximities[0]);
  FilterActivity activity;
  Answer(params, {1, 0}, set, &activity);
  EXPECT_EQ(activity.rows, 1);
  EXPECT_EQ(activity.dropped, 2);
  EXPECT_NEAR(activity.bounds[0].multiplier, 0.75 / 0.97, 1e-12);
}

TEST(SafetyFilterTest, TurnsWithTheWorld) {
  // Everything turned about the arm's first axis: the same velocity.
  const Eigen::Isometry3d X(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  Loop loop(Hundred(), TestModels("planar2"), Eigen::Vector2d(0.7, 0));
  ProximitySet set = BesideTheTip(0.08, 0.2);
  Proximity& proximity = set.proximities[0];
  for (Eigen::Vector3d* v : {&proximity.point_on_link, &proximity.point_on_obstacle,
                             &proximity.normal, &proximity.obstacle_velocity}) {
    *v = X * *v;
  }
  loop.Tick(Eigen::Vector2d(0.9, 0), [&](const LinkPoses&) { return set; });
  const Eigen::VectorXd u = Answer(Hundred(), {1, 0}, BesideTheTip(0.08, 0.2));
  EXPECT_NEAR((loop.velocity() - u).norm(), 0.0, 1e-12);
}

TEST(SafetyFilterTest, ChangesByABoundedAmountAsAnObstacleComesNear) {
  for (const auto form : {SafetyFilter::Form::kLinear, SafetyFilter::Form::kBraking}) {
    SafetyFilter::Params params = Hundred();
    params.form = form;
    // The steepest of what a distance allows, over the lever of the row; braking ends within a
    // tick.
    const double slope = form == SafetyFilter::Form::kLinear ? params.approach_gain : 1.0 / kDt;
    constexpr double kStep = 2e-4;
    Eigen::VectorXd last = Answer(params, {1, 0}, BesideTheTip(0.15, 0.3));
    for (double distance = 0.15 - kStep; distance > -0.02; distance -= kStep) {
      const Eigen::VectorXd u = Answer(params, {1, 0}, BesideTheTip(distance, 0.3));
      ASSERT_LE((u - last).norm(), 1.01 * slope / std::hypot(0.9, 0.4) * kStep) << distance;
      last = u;
    }
    EXPECT_LT(last[0], 0.0);
  }
}

TEST(SafetyFilterTest, DoesNotChangeAsTheListOfObstaclesDoesWithoutNeed) {
  ProximitySet set = BesideTheTip(0.08, 0.0);
  const Eigen::VectorXd alone = Answer(Hundred(), {1, 0}, set);
  for (const double distance : {1.0, 0.5}) {  // whatever enters at the end of the sensors' reach
    set.proximities.push_back(BesideTheTip(distance, 0.0).proximities[0]);
    EXPECT_NEAR((Answer(Hundred(), {1, 0}, set) - alone).norm(), 0.0, 1e-12);
  }
  set.proximities.push_back(BesideTheTip(0.06, 0.1).proximities[0]);
  const Eigen::VectorXd u = Answer(Hundred(), {1, 0}, set);
  EXPECT_GT((u - alone).norm(), 1e-2);
  std::reverse(set.proximities.begin(), set.proximities.end());
  EXPECT_NEAR((Answer(Hundred(), {1, 0}, set) - u).norm(), 0.0, 1e-12);
}

TEST(SafetyFilterTest, RefusesGainsThatAPeriodCannotCarry) {
  const auto make = [](auto&& change) {
    SafetyFilter::Params params = Hundred();
    change(params);
    SafetyFilter{params, TestModels("planar2")};
  };
  EXPECT_NO_THROW(make([](auto& p) { p.approach_gain = 100.0; }));
  EXPECT_THROW(make([](auto& p) { p.approach_gain = 100.1; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.recovery_gain = 101.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.position_gain = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.safe_distance = -0.01; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.deceleration = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.slack_penalty = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.recovery_penalty = -1.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.progress_weight = -1.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.recovery_speed = -1.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.most_rows = 0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.period = Period(); }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.weights = Eigen::VectorXd(Eigen::Vector3d::Ones()); }),
               ConfigError);
  EXPECT_THROW(make([](auto& p) { p.weights = 0.0; }), ConfigError);
}

TEST(SafetyFilterTest, RefusesAProximityOfAStrangersLink) {
  ProximitySet set = BesideTheTip(0.08, 0.0);
  set.proximities[0].link = models::Name("lwr4_link_3");
  EXPECT_THROW(Answer(Hundred(), {0, 0}, set), SimulationError);
}

TEST(SafetyFilterTest, TicksWithoutTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  Loop loop(Hundred(), TestModels("planar2"), Eigen::Vector2d::Zero());
  const auto around = [](const LinkPoses&) { return BesideTheTip(0.08, 0.1); };
  loop.Tick(Eigen::Vector2d(1, 0), around);
  const std::int64_t before = AllocationCount();
  loop.bench().AdvanceTo(0.5);
  EXPECT_EQ(AllocationCount(), before);
}

}  // namespace safety_filter_test
}  // namespace oca::systems
