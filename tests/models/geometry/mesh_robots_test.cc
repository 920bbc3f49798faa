// SPDX-License-Identifier: BSD-3-Clause
// Public robot descriptions, if the data folder stands beside the source tree.
#include <gtest/gtest.h>

#include <filesystem>

#include "oca/models/geometry/distance.h"
#include "oca/models/geometry/mesh.h"
#include "oca/models/geometry/mesh_surface.h"

namespace oca::geometry {
namespace mesh_robots_test {

namespace fs = std::filesystem;
using Eigen::Vector3d;

const fs::path kRobots = fs::path(OCA_SOURCE_DIR "/../shared/data/robots");

class MeshRobotsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kRobots)) GTEST_SKIP() << "no robot data at " << kRobots;
  }
};

struct Bounds {
  Vector3d low, high;
};

Bounds BoundsOf(const fs::path& file) {
  const TriangleMesh mesh = LoadMesh(file);
  Bounds bounds{mesh.vertices.at(0), mesh.vertices.at(0)};
  for (const Vector3d& p : mesh.vertices) {
    bounds.low = bounds.low.cwiseMin(p);
    bounds.high = bounds.high.cwiseMax(p);
  }
  return bounds;
}

// Compares <folder>/<name><first> with <folder>/<name><second>; returns the number of pairs.
int ExpectEqualBounds(const fs::path& folder, const char* first, const char* second,
                      double tolerance) {
  int pairs = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    fs::path other = entry.path();
    other.replace_extension(second);
    if (entry.path().extension() != first || !fs::exists(other)) continue;
    ++pairs;
    const Bounds a = BoundsOf(entry.path()), b = BoundsOf(other);
    EXPECT_LE((a.low - b.low).cwiseAbs().maxCoeff(), tolerance) << entry.path();
    EXPECT_LE((a.high - b.high).cwiseAbs().maxCoeff(), tolerance) << entry.path();
  }
  return pairs;
}

TEST_F(MeshRobotsTest, LwrStlAndColladaHaveEqualBounds) {
  EXPECT_EQ(ExpectEqualBounds(kRobots / "kuka_lwr/meshes_arm", ".stl", ".dae", 2e-6), 7);
}

TEST_F(MeshRobotsTest, IiwaObjAndStlHaveEqualBounds) {
  EXPECT_EQ(ExpectEqualBounds(kRobots / "kuka_iiwa/meshes", ".obj", ".stl", 2e-6), 8);
}

TEST_F(MeshRobotsTest, EveryHullContainsEveryVertexOfItsMesh) {
  int meshes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kRobots)) {
    const auto extension = entry.path().extension();
    if (extension != ".stl" && extension != ".dae" && extension != ".obj") continue;
    ++meshes;
    const TriangleMesh mesh = LoadMesh(entry.path());
    const auto hull = LoadMeshHull(entry.path()).hull;
    EXPECT_EQ(hull->triangles.size(), 2 * hull->vertices.size() - 4);
    const auto body = MakeCollider(ConvexMesh{hull}, "link");
    const auto dot = MakeCollider(Sphere{1e-6}, "dot");
    double worst = -1.0;
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 7) {
      X.translation() = mesh.vertices[i];
      const auto result = Distance(*dot, X, *body, Eigen::Isometry3d::Identity());
      worst = std::max(worst, result.distance + 1e-6);
    }
    EXPECT_LE(worst, 1e-10) << entry.path();
  }
  EXPECT_EQ(meshes, 41);
}

// Pinned as first loaded: whoever changes the hull of a known link shall notice.
TEST_F(MeshRobotsTest, HullOfAKnownLinkStaysAsItIs) {
  const auto hull = LoadMeshHull(kRobots / "kuka_lwr/meshes_arm/arm_segment_a.stl").hull;
  EXPECT_EQ(hull->vertices.size(), 253u);
  EXPECT_NEAR(hull->volume, 0.003240, 1e-6);
}

}  // namespace mesh_robots_test
}  // namespace oca::geometry
