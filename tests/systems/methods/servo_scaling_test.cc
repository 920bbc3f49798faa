// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/servo_scaling.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "tests/allocation_count.h"
#include "tests/systems/method_scene.h"

namespace oca::systems {
namespace servo_scaling_test {

constexpr const char* kElbow = "planar2_link_1";
constexpr double kHalf = 0.0316227766;  // 1000^-1/2: the law at half the distance

ServoScaling::Params Hundred() { return {.period = Period(1, 100)}; }

/// Joint 1 turns with 1 rad/s from 0 on, for 2 s; the arm stays stretched along x.
class Servo {
 public:
  explicit Servo(const ServoScaling::Params& params, const ProximitySet& set)
      : bench_(params, TestModels("planar2")) {
    const auto model = TestModels("planar2").Get("");
    const motion::KeyPoint start{0.0, Eigen::Vector2d(0, 0.3)};
    const motion::KeyPoint end{2.0, Eigen::Vector2d(2, 0.3)};
    ahead_.trajectory =
        std::make_shared<const motion::Trajectory>(motion::Trajectory::Linear({start, end}));
    Context& context = bench_.context();
    bench_->links.Fix(context, PosesOf(*model, Eigen::Vector2d::Zero()));
    bench_->ahead.Fix(context, ahead_);
    bench_->position.Fix(context, Eigen::Vector2d(0.1, 0.3));
    bench_->proximities.Fix(context, set);
  }
  /// The time on the way after `time`.
  double PathTime(double time) {
    bench_.AdvanceTo(time);
    return bench_->path_time.Eval(bench_.context())[0];
  }
  double Scale() { return bench_->scale.Eval(bench_.context())[0]; }
  Eigen::VectorXd Delta() { return bench_->delta.Eval(bench_.context()); }
  SystemBench<ServoScaling>& bench() { return bench_; }

 private:
  SystemBench<ServoScaling> bench_;
  RequestAhead ahead_;
};

double ScaleOf(const ServoScaling::Params& params, const ProximitySet& set) {
  return Servo(params, set).Scale();
}

TEST(ServoScalingTest, LeavesTheRequestAloneWhereNothingIsNear) {
  Servo servo(Hundred(), {{Above(kElbow, 0.5, 0.1)}});
  EXPECT_EQ(servo.PathTime(1.005), 1.01);  // no sum of periods
  EXPECT_NEAR((servo.Delta() - Eigen::Vector2d(0.91, 0)).norm(), 0.0, 1e-12);
}

TEST(ServoScalingTest, FollowsTheRequestMoreSlowlyAlongItself) {
  Servo servo(Hundred(), {{Above(kElbow, 0.5, 0.05)}});
  EXPECT_NEAR(servo.PathTime(0.995), kHalf, 1e-9);
  EXPECT_NEAR((servo.Delta() - Eigen::Vector2d(kHalf - 0.1, 0)).norm(), 0.0, 1e-9);
}

TEST(ServoScalingTest, SlowsAMotionAwayFromTheObstacleTooUnlessAskedNotTo) {
  ServoScaling::Params params = Hundred();
  const ProximitySet toward{{Above(kElbow, 0.5, 0.05)}};
  const ProximitySet away{{Mirrored(Above(kElbow, 0.5, 0.05))}};
  EXPECT_NEAR(ScaleOf(params, toward), kHalf, 1e-9);
  EXPECT_NEAR(ScaleOf(params, away), kHalf, 1e-9);
  params.approach_only = true;
  EXPECT_NEAR(ScaleOf(params, toward), kHalf, 1e-9);
  EXPECT_EQ(ScaleOf(params, away), 1.0);
}

TEST(ServoScalingTest, BetweenTowardAndAwayItFades) {
  ServoScaling::Params params = Hundred();
  params.approach_only = true;
  // The point moves with 0.5 m/s in y; a normal nearly along x lets it approach with 0.01 m/s, half
  // of what is slowed in full.
  const double s = 0.01 / 0.5;
  const Proximity grazing =
      Near(kElbow, {0.5, 0, 0}, 0.05, Eigen::Vector3d(-std::sqrt(1 - s * s), -s, 0));
  EXPECT_NEAR(ScaleOf(params, {{grazing}}), 0.5 + 0.5 * kHalf, 1e-9);
}

TEST(ServoScalingTest, InContactItStopsAndOnlyWithApproachOnlyItLeaves) {
  ServoScaling::Params params = Hundred();
  for (const double distance : {0.0, -0.5}) {
    const ProximitySet away{{Mirrored(Above(kElbow, 0.5, distance))}};
    params.approach_only = false;
    EXPECT_EQ(Servo(params, away).PathTime(1.0), 0.0);
    params.approach_only = true;
    EXPECT_NEAR(Servo(params, away).PathTime(0.995), 1.0, 1e-12);
    EXPECT_EQ(ScaleOf(params, {{Above(kElbow, 0.5, distance)}}), 0.0);
  }
}

TEST(ServoScalingTest, TheSlowestOfAllObstaclesCounts) {
  const Proximity far = Above(kElbow, 0.5, 0.09);
  const Proximity near = Mirrored(Above(kElbow, 0.3, 0.05));
  EXPECT_NEAR(ScaleOf(Hundred(), {{far, near}}), kHalf, 1e-9);
  EXPECT_EQ(ScaleOf(Hundred(), {{near, far}}), ScaleOf(Hundred(), {{far, near}}));
}

TEST(ServoScalingTest, DoesNotJumpAsAnObstacleComesOrTheListChanges) {
  double last = 1.0;
  for (int i = 0; i <= 1000; ++i) {
    const double scale =
        ScaleOf(Hundred(), {{Above(kElbow, 0.5, 0.11 - 1e-4 * i), Above(kElbow, 0.2, 0.2)}});
    EXPECT_LE(std::fabs(scale - last), 1.01 * std::log(1000.0) / 0.1 * 1e-4 + 1e-3 * (i == 1000));
    EXPECT_LE(scale, last);
    last = scale;
  }
}

TEST(ServoScalingTest, WithoutAMotionAheadItAddsNothingAndStays) {
  Servo servo(Hundred(), {});
  servo.bench()->ahead.Fix(servo.bench().context(), RequestAhead{});
  EXPECT_EQ(servo.PathTime(0.5), 0.0);
  EXPECT_EQ(servo.Delta(), Eigen::Vector2d::Zero());
}

TEST(ServoScalingTest, RefusesWhatItCannotUse) {
  const auto make = [](auto&& change) {
    ServoScaling::Params params = Hundred();
    change(params);
    ServoScaling{params, TestModels("planar2")};
  };
  EXPECT_THROW(make([](auto& p) { p.period = Period(); }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.slow_distance = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.own_slow_distance = std::nan(""); }), ConfigError);
  Servo servo(Hundred(), {});
  const motion::KeyPoint three{0.0, Eigen::Vector3d::Zero()};
  servo.bench()->ahead.Fix(servo.bench().context(),
                           RequestAhead{std::make_shared<const motion::Trajectory>(
                               motion::Trajectory::Linear({three}))});
  EXPECT_THROW(servo.Delta(), SimulationError);
}

TEST(ServoScalingTest, TicksWithoutTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  ServoScaling::Params params = Hundred();
  params.approach_only = true;
  Servo servo(params, {{Above(kElbow, 0.5, 0.05)}});
  servo.PathTime(0.105);
  const std::int64_t before = AllocationCount();
  servo.bench().AdvanceTo(1.0);
  EXPECT_EQ(AllocationCount(), before);
}

}  // namespace servo_scaling_test
}  // namespace oca::systems
