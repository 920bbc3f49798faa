// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/coarse_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace oca::geometry::internal {
namespace coarse_mesh_test {

using Eigen::Vector3d;

/// A square of 1 m in n x n cells of two triangles.
TriangleMesh Square(int n) {
  TriangleMesh mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) mesh.vertices.emplace_back(i / double(n), j / double(n), 0.0);
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

Vector3d Middle(const TriangleMesh& mesh, int triangle) {
  const auto& [a, b, c] = mesh.triangles.at(triangle);
  return (mesh.vertices.at(a) + mesh.vertices.at(b) + mesh.vertices.at(c)) / 3.0;
}

TEST(CoarseMeshTest, LeavesAMeshAsItIsUpToTheMost) {
  const TriangleMesh square = Square(3);
  const CoarseMesh coarse = Coarsen(square, 18);
  EXPECT_EQ(coarse.mesh.triangles, square.triangles);
  std::vector<int> same(18);
  std::iota(same.begin(), same.end(), 0);
  EXPECT_EQ(coarse.nearest, same);
  EXPECT_LT(Coarsen(square, 17).mesh.triangles.size(), 18u);
}

TEST(CoarseMeshTest, HasAtMostSoManyTrianglesAndGivesEachOneNearIt) {
  const TriangleMesh square = Square(60);
  const CoarseMesh coarse = Coarsen(square, 1000);
  EXPECT_LE(coarse.mesh.triangles.size(), 1000u);
  EXPECT_GE(coarse.mesh.triangles.size(), 300u);
  ASSERT_EQ(coarse.nearest.size(), square.triangles.size());
  for (int i = 0; i < static_cast<int>(square.triangles.size()); ++i) {
    const Vector3d apart = Middle(square, i) - Middle(coarse.mesh, coarse.nearest[i]);
    ASSERT_LT(apart.norm(), 0.15) << i;
  }
}

TEST(CoarseMeshTest, GivesWhatShrinksToAPointTheNearestTriangleThatIsLeft) {
  TriangleMesh mesh = Square(60);
  const int speck = static_cast<int>(mesh.triangles.size()),
            first = static_cast<int>(mesh.vertices.size());
  for (const Vector3d& corner : {Vector3d(0, 0, 0), Vector3d(1e-6, 0, 0), Vector3d(0, 1e-6, 0)}) {
    mesh.vertices.push_back(Vector3d(0.9, 0.1, 1.0) + corner);
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  const CoarseMesh coarse = Coarsen(mesh, 1000);
  const Vector3d middle = Middle(coarse.mesh, coarse.nearest.at(speck));
  EXPECT_LT((middle - Vector3d(0.9, 0.1, 0.0)).norm(), 0.15) << middle.transpose();
}

TEST(CoarseMeshTest, LeavesNothingOfAMeshThatIsAPoint) {
  TriangleMesh mesh{{Vector3d::Ones(), Vector3d::Ones(), Vector3d::Ones()}, {}};
  for (int i = 0; i < 5; ++i) mesh.triangles.push_back({0, 1, 2});
  const CoarseMesh coarse = Coarsen(mesh, 4);
  EXPECT_TRUE(coarse.mesh.triangles.empty());
  EXPECT_EQ(coarse.nearest, std::vector<int>(5, 0));
}

}  // namespace coarse_mesh_test
}  // namespace oca::geometry::internal
