// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_tracker.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/sensing/obstacle_sensor.h"
#include "oca/systems/sensing/obstacle_source.h"
#include "tests/allocation_count.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace obstacle_tracker_test {

using ::testing::HasSubstr;

constexpr double kTick = 0.01;  // s

Obstacle Ball(const std::string& id, const Eigen::Vector3d& p) {
  ShapeParams shape;
  shape.radius = 0.1;
  Obstacle ball;
  ball.body = MakeObstacleBody(id, shape, id);
  ball.X_WO.translation() = p;
  ball.velocity_known = false;
  return ball;
}

ObstacleSet Told(double stamp, std::vector<Obstacle> obstacles) {
  ObstacleSet set;
  set.obstacles = std::move(obstacles);
  set.stamp = stamp;
  return set;
}

/// A tracker that is told sets, one a tick.
class Scene {
 public:
  explicit Scene(const ObstacleTracker::Params& params = {.period = Period(1, 100)})
      : bench_(params) {
    Tell(Told(0.0, {}));
  }
  void Tell(const ObstacleSet& set) { bench_->in.Fix(bench_.context(), set); }
  void Step() { bench_.AdvanceTo(kTick * ++ticks_); }
  /// Tells a set of now, and lets a tick go by.
  void See(std::vector<Obstacle> obstacles) {
    Tell(Told(now(), std::move(obstacles)));
    Step();
  }
  double now() { return kTick * ticks_; }
  const ObstacleSet& obstacles() { return bench_->obstacles.Eval(bench_.context()); }
  const TrackReport& track(std::size_t i = 0) {
    return bench_->tracks.Eval(bench_.context()).tracks.at(i);
  }
  std::size_t size() { return obstacles().obstacles.size(); }

 private:
  SystemBench<ObstacleTracker> bench_;
  int ticks_{0};
};

TEST(ObstacleTrackerTest, FindsTheVelocityBehindPosesAndTakesLatencyOut) {
  DiagramBuilder builder;
  ObstacleSource::ObstacleParams ball;
  ball.id = "ball";
  ball.shape.radius = 0.1;
  ball.pose = PoseParams{};
  ball.motion = MotionParams{.type = MotionType::kLinear, .velocity = Eigen::Vector3d(1.2, 0, 0)};
  const auto& source =
      builder.Add<ObstacleSource>("source", ObstacleSource::Params{.obstacles = {ball}});
  const auto& camera =
      builder.Add<ObstacleSensor>("camera", ObstacleSensor::Params{.period = Period(1, 30),
                                                                   .latency = Period(1, 20),
                                                                   .velocities = false,
                                                                   .position_noise = 0.005});
  const auto& tracker = builder.Add<ObstacleTracker>(
      "tracker", ObstacleTracker::Params{.period = Period(1, 100), .latency = Period(1, 20)});
  builder.Connect(source.obstacles, camera.in);
  builder.Connect(camera.obstacles, tracker.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.AdvanceTo(1.5);
  for (int k = 150; k < 200; ++k) {
    simulator.AdvanceTo(kTick * k);
    const ObstacleSet& set = tracker.obstacles.Eval(simulator.context());
    ASSERT_EQ(set.obstacles.size(), 1u);
    const double off =
        (set.obstacles[0].X_WO.translation() - Eigen::Vector3d(1.2 * kTick * k, 0, 0)).norm();
    EXPECT_LT(off, 0.02) << k;  // 60 mm behind without a tracker
    EXPECT_NEAR(set.obstacles[0].linear.x(), 1.2, 0.1) << k;
    EXPECT_TRUE(set.obstacles[0].velocity_known);
    EXPECT_GE(set.estimates[0].age, 0.05 - 1e-9);
    EXPECT_LT(set.estimates[0].age, 0.05 + 1.0 / 30.0);
    EXPECT_TRUE(Signal<ObstacleSet>::Check(set, Look::kWhole).ok());
  }
}

TEST(ObstacleTrackerTest, ABodyIsNewThenTrackedThenTurns) {
  Scene scene;
  scene.See({Ball("ball", {0, 0, 0})});
  EXPECT_EQ(scene.track().state, TrackState::kNew);
  for (int k = 1; k < 50; ++k) scene.See({Ball("ball", {0, 0, 0})});
  EXPECT_EQ(scene.track().state, TrackState::kTracked);
  EXPECT_EQ(scene.obstacles().obstacles[0].linear, Eigen::Vector3d::Zero());
  scene.See({Ball("ball", {0.08, 0, 0})});
  EXPECT_EQ(scene.track().state, TrackState::kTurning);
  EXPECT_GT(scene.track().nis, 21.0);
  scene.See({Ball("ball", {0.6, 0, 0})});
  EXPECT_EQ(scene.track().state, TrackState::kDoubted);
}

TEST(ObstacleTrackerTest, ABodyThatIsNotSeenGoesOnForAWhileAndMayComeBack) {
  Scene scene({.period = Period(1, 100), .keep_time = 0.1});
  for (int k = 0; k < 60; ++k) scene.See({Ball("ball", {0.005 * k, 0, 0})});
  for (int k = 0; k < 5; ++k) scene.See({});
  ASSERT_EQ(scene.size(), 1u);
  EXPECT_EQ(scene.track().state, TrackState::kLost);
  EXPECT_NEAR(scene.obstacles().obstacles[0].X_WO.translation().x(), 0.5 * scene.now(), 0.01);
  scene.See({Ball("ball", {0.5 * scene.now(), 0, 0})});
  EXPECT_EQ(scene.track().state, TrackState::kBack);
  scene.See({Ball("ball", {0.5 * scene.now(), 0, 0})});
  EXPECT_EQ(scene.track().state, TrackState::kTracked);
  for (int k = 0; k < 10; ++k) scene.See({});
  EXPECT_EQ(scene.size(), 1u);
  scene.See({});
  EXPECT_EQ(scene.size(), 0u);
}

TEST(ObstacleTrackerTest, ASetOfTheSameOrOfAnEarlierTimeSaysNothing) {
  Scene scene;
  for (int k = 0; k < 30; ++k) scene.See({Ball("ball", {0, 0, 0})});
  const double before = scene.track().nis;
  const double last = scene.now() - kTick;
  for (const double stamp : {last, last - 0.05}) {
    scene.Tell(Told(stamp, {Ball("ball", {0.05, 0, 0}), Ball("other", {1, 0, 0})}));
    scene.Step();
    EXPECT_EQ(scene.track().nis, before);
    EXPECT_EQ(scene.track().state, TrackState::kTracked);
    EXPECT_NEAR(scene.obstacles().obstacles[0].X_WO.translation().norm(), 0.0, 1e-4);
  }
  EXPECT_GT(scene.track().age, 2 * kTick);
}

/// What no door lets in, but a system may compute: one id twice.
class Twins final : public System {
 public:
  Twins() : out(DeclareOutput<ObstacleSet, &Twins::CalcOut>("out", {}, kTime)) {}
  void CalcOut(double time, ObstacleSet& set) const {
    set = Told(time, {Ball("a", {0, 0, 0}), Ball("a", {1, 0, 0})});
  }
  const Output<ObstacleSet> out;
};

TEST(ObstacleTrackerTest, AnIdThatComesTwiceCountsOnce) {
  DiagramBuilder builder;
  const auto& twins = builder.Add<Twins>("twins");
  const auto& tracker =
      builder.Add<ObstacleTracker>("tracker", ObstacleTracker::Params{.period = Period(1, 100)});
  builder.Connect(twins.out, tracker.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.AdvanceTo(0.1);
  const ObstacleSet& set = tracker.obstacles.Eval(simulator.context());
  ASSERT_EQ(set.obstacles.size(), 1u);
  EXPECT_NEAR(set.obstacles[0].X_WO.translation().norm(), 0.0, 1e-4);
}

TEST(ObstacleTrackerTest, WhatThereIsNoRoomForIsPassedOnWithAVelocityThatIsNotKnown) {
  Scene scene({.period = Period(1, 100), .most_bodies = 2});
  for (int k = 0; k < 5; ++k) {
    scene.See({Ball("a", {0, 0, 0}), Ball("b", {1, 0, 0}), Ball("c", {2, 0, 0})});
  }
  ASSERT_EQ(scene.size(), 3u);
  EXPECT_TRUE(scene.obstacles().obstacles[1].velocity_known);
  EXPECT_FALSE(scene.obstacles().obstacles[2].velocity_known);
  EXPECT_EQ(scene.obstacles().obstacles[2].X_WO.translation().x(), 2.0);
  EXPECT_EQ(scene.track(2).state, TrackState::kNotTracked);
  EXPECT_TRUE(Signal<ObstacleSet>::Check(scene.obstacles(), Look::kWhole).ok());
}

TEST(ObstacleTrackerTest, TakesNoMemoryOnceBodiesAreInSight) {
  if (!kCountsAllocations) GTEST_SKIP();
  SystemBench<ObstacleTracker> bench(ObstacleTracker::Params{.period = Period(1, 100)});
  std::vector<ObstacleSet> sets;
  for (int k = 0; k < 60; ++k) {
    sets.push_back(Told(kTick * k, {Ball("a", {0.01 * k, 0, 0})}));
    if (k > 30) sets.back().obstacles.push_back(Ball("b", {1, 0, 0}));
    sets.back().obstacles.reserve(4);
  }
  std::int64_t counted = 0;
  for (int k = 0; k < 60; ++k) {
    bench->in.Fix(bench.context(), sets[static_cast<std::size_t>(k)]);
    const std::int64_t before = AllocationCount();
    bench.AdvanceTo(kTick * (k + 1));
    bench->obstacles.Eval(bench.context());
    bench->tracks.Eval(bench.context());
    if (k > 5) counted += AllocationCount() - before;
  }
  EXPECT_EQ(counted, 0);
}

TEST(ObstacleTrackerTest, RefusesParametersOutOfTheirBounds) {
  const auto refusal = [](const ObstacleTracker::Params& params) -> std::string {
    try {
      ObstacleTracker tracker(params);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal({.period = Period(1, 100)}), "accepted");
  EXPECT_THAT(refusal({}), HasSubstr("period"));
  EXPECT_THAT(refusal({.period = Period(1, 100), .most_bodies = 0}), HasSubstr("most_bodies"));
  EXPECT_THAT(refusal({.period = Period(1, 100), .position_noise = 0.0}),
              HasSubstr("position_noise"));
  EXPECT_THAT(refusal({.period = Period(1, 100), .keep_time = -1e-9}), HasSubstr("keep_time"));
}

}  // namespace obstacle_tracker_test
}  // namespace oca::systems
