// SPDX-License-Identifier: BSD-3-Clause
// The shapes of an ObstacleSource that come from files: clouds, heightmaps, meshes, octrees.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>

#include "oca/systems/sensing/obstacle_source.h"
#include "oca/systems/signals/roles.h"
#include "tests/models/geometry/mesh_files.h"
#include "tests/systems/sensing/source_scene.h"
#include "tests/systems/system_bench.h"
#include "tests/temporary_folder.h"

namespace oca::systems {
namespace source_shapes_test {

using Eigen::Vector3d;
using source_scene::Ball;
using source_scene::RefusalOf;
using ::testing::HasSubstr;

TEST(SourceShapesTest, PutsABallAroundEachPointOfACloud) {
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

TEST(SourceShapesTest, RefusesACloudWithoutRadiusFileOrPoints) {
  ObstacleSource::ObstacleParams cloud = Ball("cloud", Vector3d::Zero());
  cloud.shape.type = ShapeType::kCloud;
  EXPECT_THAT(RefusalOf({.obstacles = {cloud}}), HasSubstr("file: got none"));
  cloud.shape.file = "";
  EXPECT_THAT(RefusalOf({.obstacles = {cloud}}),
              HasSubstr("shape.file: got an empty file name; expected a path"));
  cloud.shape.file = "missing.csv";
  EXPECT_THAT(RefusalOf({.obstacles = {cloud}}), HasSubstr("missing.csv"));
  const test::TemporaryFolder folder;
  cloud.shape.file = folder.Write("empty.csv", "x,y,z\n").string();
  EXPECT_THAT(RefusalOf({.obstacles = {cloud}}), HasSubstr("empty.csv: "));
  cloud.shape.radius.reset();
  EXPECT_THAT(RefusalOf({.obstacles = {cloud}}), HasSubstr("radius: got none"));
}

TEST(SourceShapesTest, RaisesABoxForACellOfAHeightmap) {
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

TEST(SourceShapesTest, RefusesTheSizesOfAHeightmapElsewhere) {
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

TEST(SourceShapesTest, AMeshIsItsHullWithAWarningOrItsParts) {
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

TEST(SourceShapesTest, PutsABoxWhereAnOctreeIsOccupied) {
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

}  // namespace source_shapes_test
}  // namespace oca::systems
