// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_sensor.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/sensing/obstacle_source.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace obstacle_sensor_test {

using ::testing::HasSubstr;

/// A ball that moves along x with 1 m/s, so that its place is the time at which it was seen.
ObstacleSource::Params Ball() {
  ObstacleSource::ObstacleParams ball;
  ball.id = "ball";
  ball.shape.radius = 0.1;
  ball.pose = PoseParams{};
  ball.motion = MotionParams{.type = MotionType::kLinear, .velocity = Eigen::Vector3d(1, 0, 0)};
  return {.period = Period(1, 100), .frames = {}, .obstacles = {ball}};
}

/// x of the ball at each of the first ticks, as updates at that tick see it; NaN: no ball.
std::vector<double> Shown(const ObstacleSensor::Params& params, int ticks) {
  DiagramBuilder builder;
  const auto& source = builder.Add<ObstacleSource>("source", Ball());
  const auto& sensor = builder.Add<ObstacleSensor>("sensor", params);
  builder.Connect(source.obstacles, sensor.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.Initialize();
  std::vector<double> shown;
  for (int k = 0; k < ticks; ++k) {
    simulator.AdvanceTo(0.01 * k);
    const auto& set = sensor.obstacles.Eval(simulator.context());
    shown.push_back(set.obstacles.empty() ? std::nan("") : set.obstacles[0].X_WO.translation().x());
  }
  return shown;
}

std::string RefusalOf(const ObstacleSensor::Params& params) {
  try {
    ObstacleSensor sensor(params);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ObstacleSensorTest, WithoutFaultsShowsWhatThereIs) {
  const auto shown = Shown({.period = Period(1, 100)}, 20);
  for (int k = 0; k < 20; ++k) EXPECT_NEAR(shown[k], 0.01 * k, 1e-12);
}

TEST(ObstacleSensorTest, ShowsWhatWasThereALatencyAgoAndNothingBefore) {
  for (const int steps : {1, 2, 10}) {
    const auto shown = Shown({.period = Period(1, 100), .latency = Period(steps, 100)}, 30);
    for (int k = 0; k < steps; ++k) EXPECT_TRUE(std::isnan(shown[k])) << k;
    for (int k = steps; k < 30; ++k) EXPECT_NEAR(shown[k], 0.01 * (k - steps), 1e-12) << k;
  }
}

TEST(ObstacleSensorTest, HoldsTheLastSampleWhileDataAreStale) {
  const auto shown = Shown({.period = Period(1, 100), .stale_from = 0.05, .stale_until = 0.12}, 20);
  EXPECT_NEAR(shown[4], 0.04, 1e-12);
  for (int k = 5; k < 12; ++k) EXPECT_NEAR(shown[k], 0.04, 1e-12) << k;
  EXPECT_NEAR(shown[12], 0.12, 1e-12);
}

TEST(ObstacleSensorTest, LosesTheShareOfSamplesThatItIsToldTo) {
  const auto shown = Shown({.period = Period(1, 100), .dropout = 0.3, .seed = 5}, 2000);
  int lost = 0;
  for (std::size_t k = 1; k < shown.size(); ++k) {
    if (shown[k] == shown[k - 1] || std::isnan(shown[k])) {
      ++lost;
    } else {
      EXPECT_NEAR(shown[k], 0.01 * static_cast<double>(k), 1e-9);
    }
  }
  EXPECT_NEAR(lost, 600, 80);  // 4 sigma
  EXPECT_TRUE(std::isnan(Shown({.period = Period(1, 100), .dropout = 1.0}, 5)[4]));
}

TEST(ObstacleSensorTest, MovesPosesByNoiseOfTheGivenSize) {
  const ObstacleSensor::Params params{.period = Period(1, 100), .position_noise = 0.02, .seed = 1};
  const auto shown = Shown(params, 2000);
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < shown.size(); ++k) {
    const double error = shown[k] - 0.01 * static_cast<double>(k);
    sum += error;
    squares += error * error;
  }
  EXPECT_NEAR(sum / 2000.0, 0.0, 0.002);
  EXPECT_NEAR(std::sqrt(squares / 2000.0), 0.02, 0.0015);
  EXPECT_EQ(shown, Shown(params, 2000));
  ObstacleSensor::Params other = params;
  other.seed = 2;
  EXPECT_NE(shown, Shown(other, 2000));
}

TEST(ObstacleSensorTest, ACameraShowsPosesBetweenItsTicksAndNoVelocities) {
  DiagramBuilder builder;
  const auto& source = builder.Add<ObstacleSource>("source", Ball());
  const auto& camera = builder.Add<ObstacleSensor>(
      "camera", ObstacleSensor::Params{
                    .period = Period(1, 30), .latency = Period(1, 20), .velocities = false});
  builder.Connect(source.obstacles, camera.in);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.Initialize();
  simulator.AdvanceTo(0.049);
  EXPECT_TRUE(camera.obstacles.Eval(simulator.context()).obstacles.empty());
  for (int k = 0; k < 20; ++k) {  // sample k, of k/30 s, comes in 0.05 s later and stays 1/30 s
    simulator.AdvanceTo((2.0 * k + 3.0) / 60.0 + (k % 2 == 0 ? 0.0 : 0.033));
    const auto& set = camera.obstacles.Eval(simulator.context());
    ASSERT_EQ(set.obstacles.size(), 1u);
    const double sampled = std::floor(100.0 * k / 30.0 + 1e-9) / 100.0;  // of the source's own
    EXPECT_NEAR(set.obstacles[0].X_WO.translation().x(), sampled, 1e-12) << k;
    EXPECT_FALSE(set.obstacles[0].velocity_known);
    EXPECT_EQ(set.obstacles[0].linear, Eigen::Vector3d::Zero());
    EXPECT_NEAR(*set.stamp, k / 30.0 + 0.05, 1e-12);
  }
}

TEST(ObstacleSensorTest, RefusesALatencyOfTooManyStepsAndTimesOutOfOrder) {
  EXPECT_THAT(RefusalOf({.period = Period(1, 100), .latency = Period(100001, 1000000)}),
              HasSubstr("latency: got"));
  EXPECT_EQ(RefusalOf({.period = Period(1, 100), .latency = Period(15, 1000)}), "accepted");
  EXPECT_THAT(RefusalOf({.period = Period(1, 100), .latency = Period(1001, 100)}),
              HasSubstr("at most 1000"));
  EXPECT_EQ(RefusalOf({.period = Period(1, 100), .latency = Period(10, 1)}), "accepted");
  EXPECT_THAT(RefusalOf({.period = Period(1, 100), .stale_from = 2.0, .stale_until = 1.0}),
              HasSubstr("stale_until: got 1 s; expected at least stale_from"));
  EXPECT_THAT(RefusalOf({}), HasSubstr("period"));
}

}  // namespace obstacle_sensor_test
}  // namespace oca::systems
