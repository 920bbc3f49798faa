// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/signals/roles.h"
#include "tests/models/geometry/mesh_files.h"
#include "tests/systems/system_bench.h"
#include "tests/temporary_folder.h"

namespace oca::systems {
namespace obstacle_source_test {

using Eigen::Vector3d;
using ::testing::HasSubstr;

ObstacleSource::ObstacleParams Ball(const std::string& id, const Vector3d& xyz) {
  ObstacleSource::ObstacleParams params;
  params.id = id;
  params.shape.radius = 0.1;
  params.pose = PoseParams{xyz, {}, {}};
  return params;
}

/// A ball that moves along x at 1 m/s.
ObstacleSource::ObstacleParams MovingBall() {
  ObstacleSource::ObstacleParams params = Ball("ball", Vector3d::Zero());
  params.motion.emplace();
  params.motion->type = MotionType::kLinear;
  params.motion->velocity = Vector3d(1.0, 0.0, 0.0);
  return params;
}

double PositionAt(SystemBench<ObstacleSource>& bench, double time) {
  bench.context().SetTime(time);
  return bench->obstacles.Eval(bench.context()).obstacles.at(0).X_WO.translation().x();
}

std::string RefusalOf(const ObstacleSource::Params& params) {
  try {
    ObstacleSource source(params);
  } catch (const ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "was accepted";
  return "";
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

TEST(ObstacleSourceTest, PutsABallAroundEachPointOfACloud) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "cloud.csv").string();
  std::ofstream(file) << "0, 0, 1\n0, 2, 0\n";
  ObstacleSource::ObstacleParams cloud = Ball("cloud", Vector3d::Zero());
  cloud.shape.type = ShapeType::kCloud;
  cloud.shape.file = file;
  SystemBench<ObstacleSource> bench(ObstacleSource::Params{.obstacles = {cloud}});
  const ObstacleSet& set = bench->obstacles.Eval(bench.context());
  const auto& parts =
      std::get<geometry::Compound>(set.obstacles.at(0).body->collider->shape()).parts;
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[1].X_SP.translation(), Vector3d(0.0, 2.0, 0.0));
  EXPECT_EQ(std::get<geometry::Sphere>(parts[1].shape).radius, 0.1);
}

TEST(ObstacleSourceTest, RefusesACloudWithoutRadiusFileOrPoints) {
  ObstacleSource::ObstacleParams cloud = Ball("cloud", Vector3d::Zero());
  cloud.shape.type = ShapeType::kCloud;
  EXPECT_THAT(RefusalOf({.obstacles = {cloud}}), HasSubstr("file: got none"));
  cloud.shape.file = "missing.csv";
  EXPECT_THAT(RefusalOf({.obstacles = {cloud}}), HasSubstr("missing.csv"));
  const test::TemporaryFolder folder;
  cloud.shape.file = folder.Write("empty.csv", "x,y,z\n").string();
  EXPECT_THAT(RefusalOf({.obstacles = {cloud}}), HasSubstr("empty.csv: "));
  cloud.shape.radius.reset();
  EXPECT_THAT(RefusalOf({.obstacles = {cloud}}), HasSubstr("radius: got none"));
}

TEST(ObstacleSourceTest, RaisesABoxForACellOfAHeightmap) {
  const test::TemporaryFolder folder;
  const std::string file = (folder.path() / "heights.csv").string();
  std::ofstream(file) << "1, 3\n";
  ObstacleSource::ObstacleParams map = Ball("map", Vector3d::Zero());
  map.shape.type = ShapeType::kHeightmap;
  map.shape.radius.reset();
  map.shape.file = file;
  map.shape.cell = 0.5;
  EXPECT_THAT(RefusalOf({.obstacles = {map}}), HasSubstr("scale: got none"));
  map.shape.scale = 0.1;
  SystemBench<ObstacleSource> bench(ObstacleSource::Params{.obstacles = {map}});
  const ObstacleSet& set = bench->obstacles.Eval(bench.context());
  const auto& parts =
      std::get<geometry::Compound>(set.obstacles.at(0).body->collider->shape()).parts;
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NEAR(std::get<geometry::Box>(parts[1].shape).size.z(), 0.8, 1e-15);  // 0.3 and a cell
}

TEST(ObstacleSourceTest, RefusesTheSizesOfAHeightmapElsewhere) {
  ObstacleSource::ObstacleParams ball = Ball("ball", Vector3d::Zero());
  ball.shape.cell = 0.1;
  EXPECT_THAT(RefusalOf({.obstacles = {ball}}),
              HasSubstr("cell: got a value; expected none of a sphere"));
  ball.shape.cell.reset();
  ball.shape.scale = 0.1;
  EXPECT_THAT(RefusalOf({.obstacles = {ball}}), HasSubstr("scale: got a value"));
  ball.shape.scale.reset();
  ball.shape.collision = CollisionMeshes::kHull;
  EXPECT_THAT(RefusalOf({.obstacles = {ball}}),
              HasSubstr("collision: got a value; expected none of a sphere"));
}

TEST(ObstacleSourceTest, AMeshIsItsHullWithAWarningOrItsParts) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(::setenv("XDG_CACHE_HOME", folder.path().c_str(), 1), 0);
  ObstacleSource::ObstacleParams mesh = Ball("angle", Vector3d::Zero());
  mesh.shape = {};
  mesh.shape.type = ShapeType::kMesh;
  mesh.shape.file = folder.Write("angle.obj", geometry::AngleObj()).string();
  const ObstacleSource hull({.obstacles = {mesh}});
  EXPECT_THAT(hull.role<Remarks>()->warnings,
              testing::ElementsAre(HasSubstr("which adds 0.5 m^3 (16.7 %)")));
  mesh.shape.collision = CollisionMeshes::kDecomposition;
  SystemBench<ObstacleSource> parts(ObstacleSource::Params{.obstacles = {mesh}});
  EXPECT_THAT(parts->role<Remarks>()->warnings, testing::IsEmpty());
  const ObstacleBody& body = *parts->obstacles.Eval(parts.context()).obstacles.at(0).body;
  EXPECT_GE(std::get<geometry::Compound>(body.collider->shape()).parts.size(), 2u);
  const ShapeParams again = ShapeParamsOf(body);
  EXPECT_EQ(again.type, ShapeType::kMesh);
  EXPECT_EQ(again.collision, CollisionMeshes::kDecomposition);
  EXPECT_EQ(again.file, mesh.shape.file);
}

TEST(ObstacleSourceTest, PutsABoxWhereAnOctreeIsOccupied) {
  const test::TemporaryFolder folder;
  ObstacleSource::ObstacleParams map = Ball("map", Vector3d::Zero());
  map.shape = {};
  map.shape.type = ShapeType::kOctree;
  map.shape.file = folder
                       .Write("map.bt",
                              "# Octomap OcTree binary file\nid OcTree\nsize 2\nres 1e-4\n"
                              "data\n" +
                                  std::string("\x00\x80", 2))
                       .string();
  SystemBench<ObstacleSource> bench(ObstacleSource::Params{.obstacles = {map}});
  const ObstacleBody& body = *bench->obstacles.Eval(bench.context()).obstacles.at(0).body;
  const auto& parts = std::get<geometry::Compound>(body.collider->shape()).parts;
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_NEAR(parts[0].X_SP.translation().x(), 1.6384, 1e-12);
  EXPECT_EQ(ShapeParamsOf(body).type, ShapeType::kOctree);
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
