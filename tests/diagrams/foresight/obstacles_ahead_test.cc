// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/obstacles_ahead.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/constant.h"
#include "oca/systems/sensing/obstacle_sensor.h"
#include "oca/systems/sensing/obstacle_source.h"

namespace oca::foresight {
namespace obstacles_ahead_test {

using Eigen::Vector3d;
using systems::ObstacleSource;
using testing::HasSubstr;

ObstacleSource::ObstacleParams Ball(const std::string& id, double y) {
  ObstacleSource::ObstacleParams params;
  params.id = id;
  params.shape.radius = 0.1;
  params.pose = systems::PoseParams{Vector3d(0.0, y, 0.0), {}, {}};
  return params;
}

ObstacleSource::ObstacleParams Moving(ObstacleSource::ObstacleParams params) {
  params.motion.emplace();
  params.motion->type = systems::MotionType::kLinear;
  params.motion->velocity = Vector3d(1.0, 0.0, 0.0);
  return params;
}

/// A ball that stands, one that moves along x with 1 m/s, sampled every 0.1 s, and one that is
/// there from 0.2 to 0.3 s.
ObstacleSource::Params ThreeBalls() {
  ObstacleSource::Params params;
  params.period = Period(1, 10);
  params.obstacles = {Ball("stands", 1.0), Moving(Ball("moves", 2.0)), Ball("comes", 3.0)};
  params.obstacles[2].appear = 0.2;
  params.obstacles[2].disappear = 0.3;
  return params;
}

struct Scene {
  Scene() : source(builder.Add<ObstacleSource>("source", ThreeBalls())) {}
  void Build() { diagram = builder.Build(); }
  std::shared_ptr<const Diagram> Shared() const { return {std::shared_ptr<void>(), diagram.get()}; }

  DiagramBuilder builder;
  const ObstacleSource& source;
  std::unique_ptr<Diagram> diagram;
};

double X(const systems::ObstacleSet& set) { return set.obstacles.at(1).X_WO.translation().x(); }

TEST(ObstaclesAheadTest, AreWhereTheOutputHasThemInAnyOrderOfTimes) {
  Scene scene;
  scene.Build();
  ObstaclesAhead ahead(scene.Shared(), scene.source.obstacles, "here");
  EXPECT_DOUBLE_EQ(X(ahead.At(0.25)), 0.2);  // the last sample
  EXPECT_EQ(ahead.At(0.25).obstacles.size(), 3u);
  EXPECT_DOUBLE_EQ(X(ahead.At(0.1)), 0.1);
  EXPECT_EQ(ahead.At(0.1).obstacles.size(), 2u);
}

TEST(ObstaclesAheadTest, OfASourceThatSamplesAreThereBetweenItsSamplesToo) {
  Scene scene;
  scene.Build();
  const auto ahead = ObstaclesAhead::Of(*scene.diagram, scene.source.obstacles, "here");
  EXPECT_DOUBLE_EQ(X(ahead->At(0.25)), 0.25);
}

TEST(ObstaclesAheadTest, OfASourceThatOthersMoveAreAsItsSamplesHaveThem) {
  Scene scene;
  const auto& offsets = scene.builder.Add<systems::Constant>(
      "offsets", {.value = Eigen::VectorXd(Eigen::VectorXd::Ones(9))});
  scene.builder.Connect(offsets.value, scene.source.offsets);
  scene.Build();
  const auto ahead = ObstaclesAhead::Of(*scene.diagram, scene.source.obstacles, "here");
  EXPECT_DOUBLE_EQ(X(ahead->At(0.25)), 1.2);
}

TEST(ObstaclesAheadTest, OfASensorAreRefusedForTheyDependOnTheRun) {
  Scene scene;
  const auto& sensor = scene.builder.Add<systems::ObstacleSensor>(
      "sensor", {.period = Period(1, 10), .latency = Period(1, 10)});
  scene.builder.Connect(scene.source.obstacles, sensor.in);
  scene.Build();
  try {
    ObstaclesAhead::Of(*scene.diagram, sensor.obstacles, "distance.obstacles");
    FAIL() << "was accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("distance.obstacles: driver; got 'sensor', which depends"));
  }
}

TEST(ObstaclesAheadTest, BecomeBodiesThatKnowWhereTheyAreAndWhetherTheyStand) {
  Scene scene;
  scene.Build();
  auto bodies =
      BodiesInTime(ObstaclesAhead::Of(*scene.diagram, scene.source.obstacles, "here"), 1.0);
  ASSERT_EQ(bodies.size(), 3u);
  const auto at = [&](std::size_t i, double time) -> Vector3d {
    return bodies[i].pose(time).translation();
  };
  EXPECT_EQ(bodies[0].name, models::Name("stands"));
  EXPECT_TRUE(bodies[0].stands);
  EXPECT_EQ(at(0, 0.7), Vector3d(0.0, 1.0, 0.0));
  EXPECT_EQ(bodies[1].name, models::Name("moves"));
  EXPECT_FALSE(bodies[1].stands);
  EXPECT_EQ(at(1, 0.75), Vector3d(0.75, 2.0, 0.0));
  EXPECT_EQ(bodies[2].name, models::Name("comes"));
  EXPECT_FALSE(bodies[2].stands);
  EXPECT_EQ(at(2, 0.25), Vector3d(0.0, 3.0, 0.0));
  EXPECT_LT(at(2, 0.1).z(), -1e3);  // not yet there
  EXPECT_LT(at(2, 0.35).z(), -1e3);
}

// What comes after the duration is no body at all.
TEST(ObstaclesAheadTest, BecomeBodiesOnlyIfTheyAreThereWithinTheDuration) {
  Scene scene;
  scene.Build();
  const auto ahead = ObstaclesAhead::Of(*scene.diagram, scene.source.obstacles, "here");
  EXPECT_EQ(BodiesInTime(ahead, 0.199).size(), 2u);
  EXPECT_EQ(BodiesInTime(ahead, 0.201).size(), 3u);
}

}  // namespace obstacles_ahead_test
}  // namespace oca::foresight
