// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/mesh_surface.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "oca/models/geometry/convex_hull.h"
#include "tests/models/geometry/mesh_files.h"
#include "tests/temporary_folder.h"

namespace oca::geometry {
namespace mesh_surface_test {

using Eigen::Vector3d;

/// A prism over an L of five unit squares less two: 3 m^2 by 1 m; every triangle has vertices of
/// its own, as in STL.
TriangleMesh Angle() {
  const std::vector<Vector3d> corners{{0, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                      {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  TriangleMesh mesh;
  const auto add = [&mesh](const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const int first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  const Vector3d up = Vector3d::UnitZ();
  // Two rectangles of the L from triangles that meet at corners only: 0-1-2-3 and 0-3-4-5.
  for (const auto& [a, b, c] :
       std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}) {
    add(corners[a] + up, corners[b] + up, corners[c] + up);
    add(corners[a], corners[c], corners[b]);
  }
  for (int i = 0; i < 6; ++i) {
    const Vector3d &a = corners[i], &b = corners[(i + 1) % 6];
    add(a, b, b + up);
    add(a, b + up, a + up);
  }
  return mesh;
}

TEST(MeshSurfaceTest, KnowsTheVolumeOfAClosedSurface) {
  TriangleMesh mesh = Angle();
  ASSERT_TRUE(EnclosedVolume(mesh).has_value());
  EXPECT_NEAR(*EnclosedVolume(mesh), 3.0, 1e-12);
  for (Vector3d& p : mesh.vertices) p = 1e-3 * p + Vector3d(7.0, -5.0, 3.0);
  for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);  // inside out
  EXPECT_NEAR(*EnclosedVolume(mesh), 3e-9, 1e-15);
}

TEST(MeshSurfaceTest, KnowsNoVolumeOfAnOpenOrTwistedSurface) {
  TriangleMesh open = Angle();
  open.triangles.pop_back();
  EXPECT_FALSE(EnclosedVolume(open).has_value());
  TriangleMesh twisted = Angle();
  std::swap(twisted.triangles[3][0], twisted.triangles[3][1]);
  EXPECT_FALSE(EnclosedVolume(twisted).has_value());
  EXPECT_FALSE(EnclosedVolume(TriangleMesh{}).has_value());
}

TEST(MeshSurfaceTest, SaysWhatAHullAdds) {
  const TriangleMesh mesh = Angle();
  const auto hull = MakeConvexHull(mesh.vertices, "angle");  // 3.5 m^3
  EXPECT_EQ(DescribeHullExcess(mesh, *hull),
            "counts as its convex hull, which adds 0.5 m^3 (16.7 %)");
  TriangleMesh open = mesh;
  open.triangles.pop_back();
  EXPECT_NE(DescribeHullExcess(open, *hull).find("is not closed"), std::string::npos);
}

TEST(MeshSurfaceTest, ReadsTheSameFromAFile) {
  const test::TemporaryFolder folder;
  const TriangleMesh mesh = LoadMesh(folder.Write("angle.obj", AngleObj()));
  EXPECT_NEAR(EnclosedVolume(mesh).value_or(-1.0), 3.0, 1e-6);
}

/// A square of 0.05 m turned out of every plane of the axes, as text; a line of triangles without
/// area if `line`.
std::string StickerObj(bool line) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.4, Vector3d(1, 2, 3).normalized()).matrix();
  std::string text;
  for (const Vector3d& corner :
       {Vector3d(0, 0, 0), Vector3d(0.05, 0, 0), Vector3d(0.05, 0.05, 0), Vector3d(0, 0.05, 0)}) {
    const Vector3d p = R * (line ? Vector3d(corner.x() + 0.3 * corner.y(), 0, 0) : corner);
    text += fmt::format("v {:.12f} {:.12f} {:.12f}\n", p.x(), p.y(), p.z());
  }
  return text + "f 1 2 3\nf 1 3 4\n";
}

TEST(MeshSurfaceTest, GivesAFlatMeshALeastThicknessAndSaysSo) {
  const test::TemporaryFolder folder;
  const auto sticker = LoadMeshHull(folder.Write("sticker.obj", StickerObj(false)));
  EXPECT_EQ(sticker.excess, "");
  EXPECT_EQ(sticker.flatness.find("is flat; counts as "), 0u) << sticker.flatness;
  const double extent = 2.0 * sticker.hull->radius;
  EXPECT_NEAR(extent, 0.05 * std::sqrt(2.0), 1e-3);
  EXPECT_GT(sticker.hull->volume, 0.0);
  EXPECT_LT(sticker.hull->volume, 0.05 * 0.05 * 1.1e-4 * extent);
  const auto line = LoadMeshHull(folder.Write("line.obj", StickerObj(true)));
  EXPECT_NE(line.flatness, "");
  const auto body = LoadMeshHull(folder.Write("angle.obj", AngleObj()));
  EXPECT_EQ(body.flatness, "");
}

TEST(MeshSurfaceTest, IsSilentUpToOnePerCent) {
  const TriangleMesh mesh = Angle();
  ConvexHull hull;
  hull.volume = 3.029;
  EXPECT_EQ(DescribeHullExcess(mesh, hull), "");
  hull.volume = 3.031;
  EXPECT_NE(DescribeHullExcess(mesh, hull), "");
}

}  // namespace mesh_surface_test
}  // namespace oca::geometry
