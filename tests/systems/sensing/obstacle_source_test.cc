// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/sensing/source_scene.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace obstacle_source_test {

using Eigen::Vector3d;
using source_scene::Ball;
using source_scene::MovingBall;
using source_scene::RefusalOf;
using ::testing::HasSubstr;

double PositionAt(SystemBench<ObstacleSource>& bench, double time) {
  bench.context().SetTime(time);
  return bench->obstacles.Eval(bench.context()).obstacles.at(0).X_WO.translation().x();
}

TEST(ObstacleSourceTest, HoldsTheBoxOfTheStaticTest) {
  SystemBench<ObstacleSource> bench(ObstacleSource::Example());
  const ObstacleSet& set = bench->obstacles.Eval(bench.context());
  ASSERT_EQ(set.obstacles.size(), 1u);
  EXPECT_EQ(set.obstacles[0].body->id, models::Name("box"));
  EXPECT_EQ(set.obstacles[0].X_WO.translation(), Vector3d(0.0, 0.6, 1.0));
  EXPECT_EQ(std::get<geometry::Box>(set.obstacles[0].body->collider->shape()).size,
            Vector3d(0.2, 0.2, 0.2));
  EXPECT_EQ(set.obstacles[0].linear, Vector3d::Zero());
}

TEST(ObstacleSourceTest, IsEmptyWithoutObstacles) {
  SystemBench<ObstacleSource> bench(ObstacleSource::Params{});
  EXPECT_TRUE(bench->obstacles.Eval(bench.context()).obstacles.empty());
}

TEST(ObstacleSourceTest, MovesContinuouslyWithPeriodZero) {
  SystemBench<ObstacleSource> bench(ObstacleSource::Params{.obstacles = {MovingBall()}});
  EXPECT_EQ(PositionAt(bench, 0.123), 0.123);
}

TEST(ObstacleSourceTest, HoldsItsSampleFromTickToTick) {
  SystemBench<ObstacleSource> bench(
      ObstacleSource::Params{.period = Period(1, 10), .obstacles = {MovingBall()}});
  EXPECT_EQ(PositionAt(bench, 0.0), 0.0);
  EXPECT_EQ(PositionAt(bench, 0.0999), 0.0);
  EXPECT_EQ(PositionAt(bench, 0.1), 0.1);
  EXPECT_EQ(PositionAt(bench, 0.1999), 0.1);
}

// 3 times 0.1 is not 0.3 in doubles: a tick must not see the sample of the one before.
TEST(ObstacleSourceTest, SeesEveryTickAtItsOwnTimeForADay) {
  for (const Period period : {Period(1, 10), Period(1, 60), Period(3, 1000)}) {
    SystemBench<ObstacleSource> bench(
        ObstacleSource::Params{.period = period, .obstacles = {MovingBall()}});
    const auto ticks = static_cast<std::int64_t>(86400.0 / period.seconds());
    for (std::int64_t k = 1; k <= ticks; k += 997) {
      const double time =
          static_cast<double>(k * period.numerator()) / static_cast<double>(period.denominator());
      ASSERT_EQ(PositionAt(bench, time), time) << k;
      ASSERT_LT(PositionAt(bench, time - 1e-6), time) << k;
    }
  }
}

/// Remembers, at each tick, where the first obstacle is seen.
class Watcher final : public System {
 public:
  explicit Watcher(Period period)
      : seen_(DeclareDiscreteState("seen", {1}, -1.0)),
        obstacles(DeclareInput<ObstacleSet>("obstacles")),
        seen(DeclareStateOutput("seen", seen_)) {
    DeclareUpdate<&Watcher::Update>(Every{period}, Writes(seen_), obstacles);
  }

 private:
  const DiscreteState<Vector> seen_;
  void Update(const ObstacleSet& set, MutableVectorView next) const {
    next[0] = set.obstacles.at(0).X_WO.translation().x();
  }

 public:
  const Input<ObstacleSet> obstacles;
  const Output<Vector> seen;
};

TEST(ObstacleSourceTest, AnUpdateOfTheSameTickSeesTheObstaclesOfThatTick) {
  DiagramBuilder builder;
  const auto& source = builder.Add<ObstacleSource>(
      "source", ObstacleSource::Params{.period = Period(1, 10), .obstacles = {MovingBall()}});
  const auto& watcher = builder.Add<Watcher>("watcher", Period(1, 10));
  builder.Connect(source.obstacles, watcher.obstacles);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.AdvanceTo(0.35);
  EXPECT_EQ(watcher.seen.Eval(simulator.context())[0], 3.0 / 10.0);
}

TEST(ObstacleSourceTest, AppearsAndDisappearsAtItsTimes) {
  ObstacleSource::ObstacleParams guest = Ball("guest", Vector3d::UnitX());
  guest.appear = 1.0;
  guest.disappear = 2.0;
  SystemBench<ObstacleSource> bench(
      ObstacleSource::Params{.obstacles = {guest, Ball("wall", Vector3d::UnitY())}});
  const auto ids_at = [&](double time) {
    bench.context().SetTime(time);
    std::string ids;
    for (const Obstacle& obstacle : bench->obstacles.Eval(bench.context()).obstacles) {
      ids += obstacle.body->id.text() + " ";
    }
    return ids;
  };
  EXPECT_EQ(ids_at(0.999), "wall ");
  EXPECT_EQ(ids_at(1.0), "guest wall ");
  EXPECT_EQ(ids_at(1.999), "guest wall ");
  EXPECT_EQ(ids_at(2.0), "wall ");
  EXPECT_EQ(ids_at(1.5), "guest wall ");
}

TEST(ObstacleSourceTest, TransformsPosesAndTwistsFromFramesOfFrames) {
  constexpr double kQuarter = 1.5707963267948966;
  ObstacleSource::Params params;
  params.frames = {{"table", {{1.0, 0.0, 0.0}, Vector3d(0.0, 0.0, kQuarter), {}}, ""},
                   {"belt", {{0.0, 2.0, 0.0}, {}, {}}, "table"}};
  params.obstacles = {MovingBall()};
  params.obstacles[0].frame = "belt";
  params.obstacles[0].motion->angular_velocity =
      PerComponent(Eigen::VectorXd(Vector3d(0.2, 0.0, 0.0)));
  SystemBench<ObstacleSource> bench(params);
  bench.context().SetTime(0.5);
  const Obstacle& ball = bench->obstacles.Eval(bench.context()).obstacles.at(0);
  // (0.5, 0, 0) on the belt is (0.5, 2, 0) on the table, whose x axis is the world's y axis.
  EXPECT_NEAR((ball.X_WO.translation() - Vector3d(-1.0, 0.5, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((ball.linear - Vector3d(0.0, 1.0, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((ball.angular - Vector3d(0.0, 0.2, 0.0)).norm(), 0.0, 1e-15);
}

TEST(ObstacleSourceTest, RefusesIdsThatAreEmptyOrTaken) {
  EXPECT_THAT(
      RefusalOf({.obstacles = {Ball("frame", Vector3d::Zero()), Ball("frame", Vector3d::Zero())}}),
      HasSubstr("obstacles[1].id: got 'frame'"));
  EXPECT_THAT(RefusalOf({.obstacles = {Ball("", Vector3d::Zero())}}), HasSubstr("obstacles[0].id"));
}

TEST(ObstacleSourceTest, RefusesUnknownAndDoubleFrames) {
  ObstacleSource::Params params;
  params.obstacles = {Ball("ball", Vector3d::Zero())};
  params.obstacles[0].frame = "table";
  EXPECT_THAT(RefusalOf(params), HasSubstr("frame: got 'table'"));
  params.frames = {{"table", PoseParams{}, "room"}};
  EXPECT_THAT(RefusalOf(params), HasSubstr("frames[0].parent: got 'room'"));
  params.frames = {{"table", PoseParams{}, "world"}, {"table", PoseParams{}, ""}};
  EXPECT_THAT(RefusalOf(params), HasSubstr("frames[1].name"));
  params.frames.pop_back();
  EXPECT_NO_THROW(ObstacleSource{params});
}

TEST(ObstacleSourceTest, RefusesPosesThatAreMissingOrOfNoUse) {
  ObstacleSource::Params params{.obstacles = {Ball("ball", Vector3d::Zero())}};
  params.obstacles[0].pose.reset();
  EXPECT_THAT(RefusalOf(params), HasSubstr("obstacle 'ball'.pose: got none"));
  params.obstacles[0].pose =
      PoseParams{Vector3d::Zero(), Vector3d::Zero(), Eigen::VectorXd(Eigen::Vector4d(0, 0, 0, 1))};
  EXPECT_THAT(RefusalOf(params), HasSubstr("rpy and quaternion"));
  params.obstacles[0].pose = PoseParams{Vector3d::Zero(), {}, Eigen::VectorXd(Vector3d::UnitX())};
  EXPECT_THAT(RefusalOf(params), HasSubstr("quaternion: got 3 numbers"));
  params.obstacles[0].pose = PoseParams{Vector3d::UnitX(), {}, {}};
  params.obstacles[0].motion.emplace();
  params.obstacles[0].motion->type = MotionType::kWaypoints;
  params.obstacles[0].motion->waypoints = {{0.0, Vector3d::UnitY(), {}}};
  EXPECT_THAT(RefusalOf(params), HasSubstr("pose.xyz: got a position"));
  params.obstacles[0].pose.reset();
  EXPECT_NO_THROW(ObstacleSource{params});
}

TEST(ObstacleSourceTest, RefusesTimesAndPeriodsThatMakeNoSense) {
  ObstacleSource::Params params{.obstacles = {Ball("ball", Vector3d::Zero())}};
  params.obstacles[0].appear = 2.0;
  params.obstacles[0].disappear = 2.0;
  EXPECT_THAT(RefusalOf(params), HasSubstr("disappear"));
  params.obstacles[0].appear = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(RefusalOf(params), HasSubstr("obstacles[0].appear: got nan"));
  EXPECT_THAT(RefusalOf({.period = Period(-1, 10)}), HasSubstr("period"));
}

TEST(ObstacleSourceTest, RefusesABadShapeNamingTheObstacle) {
  ObstacleSource::Params params{.obstacles = {Ball("ball", Vector3d::Zero())}};
  params.obstacles[0].shape.radius = -1.0;
  EXPECT_THAT(RefusalOf(params), HasSubstr("obstacles[0].shape.radius: got -1 m"));
  params.obstacles[0].shape.radius.reset();
  EXPECT_THAT(RefusalOf(params), HasSubstr("obstacle 'ball'.shape"));
}

TEST(ObstacleSourceTest, MovesOnByItsOffsetsFromWhereTheScriptsPutThem) {
  ObstacleSource::Params params;
  params.obstacles = {Ball("ball_1", Vector3d(0.5, 0.0, 1.0)), MovingBall()};
  auto owned = std::make_unique<ObstacleSource>(params);
  const ObstacleSource& source = *owned;
  const auto diagram = MakeDiagramOf(std::move(owned), {{"offsets", -1}});
  Simulator simulator(*diagram);
  const auto offsets = diagram->GetInput<Vector>("offsets");
  const auto position = [&](std::size_t i) {
    const auto& obstacles = source.obstacles.Eval(simulator.context()).obstacles;
    return Vector3d(obstacles.at(i).X_WO.translation());
  };
  Eigen::VectorXd shifts(6);
  shifts << 0.1, 0.2, -0.3, 0.0, 0.0, 2.0;
  offsets.Fix(simulator.context(), shifts);
  simulator.AdvanceTo(3.0);
  EXPECT_TRUE(position(0).isApprox(Vector3d(0.6, 0.2, 0.7), 1e-15));
  EXPECT_TRUE(position(1).isApprox(Vector3d(3.0, 0.0, 2.0), 1e-15));
  shifts << 0.0, 0.0, 0.0, 0.0, 0.0, 0.0;
  offsets.Fix(simulator.context(), shifts);
  EXPECT_EQ(position(0), Vector3d(0.5, 0.0, 1.0));
  EXPECT_GT(source.obstacles.Eval(simulator.context()).obstacles[0].body->fastest, 1e5);
  EXPECT_THROW(offsets.Fix(simulator.context(), Eigen::VectorXd(Vector3d::Zero())), ConfigError);
  shifts[4] = -1.1e6;
  EXPECT_THROW(offsets.Fix(simulator.context(), shifts), ConfigError);
}

TEST(ObstacleSourceTest, RefusesWhatFramesAndMotionsAddUpTo) {
  ObstacleSource::Params params;
  params.frames = {{"far", {Vector3d(9e5, 0.0, 0.0), {}, {}}, ""},
                   {"farther", {Vector3d(9e5, 0.0, 0.0), {}, {}}, "far"}};
  params.obstacles = {Ball("ball", Vector3d::Zero())};
  params.obstacles[0].frame = "far";
  EXPECT_NO_THROW(ObstacleSource{params});
  params.obstacles[0].frame = "farther";
  EXPECT_THAT(RefusalOf(params), HasSubstr("obstacle 'ball': position; got [1800000, 0, 0] m"));
}

}  // namespace obstacle_source_test
}  // namespace oca::systems
