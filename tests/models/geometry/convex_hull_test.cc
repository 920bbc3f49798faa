// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/convex_hull.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "oca/models/error.h"
#include "tests/models/geometry/random_bodies.h"

namespace oca::geometry {
namespace convex_hull_test {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

std::vector<Vector3d> Cube(double edge, int per_edge) {
  std::vector<Vector3d> points;
  for (int i = 0; i < per_edge; ++i) {
    for (int j = 0; j < per_edge; ++j) {
      for (int k = 0; k < per_edge; ++k) {
        points.push_back(edge / (per_edge - 1) * Vector3d(i, j, k));
      }
    }
  }
  return points;
}

std::string RefusalOf(const std::vector<Vector3d>& points) {
  try {
    MakeConvexHull(points, "link 3");
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

// Closed, oriented, and every point on the inner side of every face.
void ExpectConvexSurfaceAround(const ConvexHull& hull, const std::vector<Vector3d>& points,
                               double tolerance) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : hull.triangles) {
    for (int i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    const Vector3d& a = hull.vertices[t[0]];
    const Vector3d n = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a);
    if (n.norm() < 1e-9) continue;  // a sliver's normal says nothing in double precision
    for (const Vector3d& p : points) ASSERT_LE(n.normalized().dot(p - a), tolerance);
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_EQ(hull.triangles.size(), 2 * hull.vertices.size() - 4);
}

TEST(ConvexHullTest, CubeAsWorkedOutByHand) {
  const auto hull = MakeConvexHull(Cube(2.0, 2), "cube");
  EXPECT_EQ(hull->name, "cube");
  EXPECT_EQ(hull->vertices.size(), 8u);
  EXPECT_EQ(hull->triangles.size(), 12u);
  EXPECT_NEAR(hull->volume, 8.0, 1e-12);
  EXPECT_NEAR(hull->radius, std::sqrt(3.0), 1e-12);
  EXPECT_TRUE(hull->centre.isApprox(Vector3d::Ones(), 1e-12));
  EXPECT_TRUE(hull->centroid.isApprox(Vector3d::Ones(), 1e-12));
  ExpectConvexSurfaceAround(*hull, Cube(2.0, 2), 1e-12);
}

TEST(ConvexHullTest, TetrahedronAsWorkedOutByHand) {
  const std::vector<Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto hull = MakeConvexHull(corners, "corner");
  EXPECT_EQ(hull->triangles.size(), 4u);
  EXPECT_NEAR(hull->volume, 1.0 / 6.0, 1e-15);
  EXPECT_TRUE(hull->centroid.isApprox(Vector3d::Constant(0.25), 1e-12));
}

TEST(ConvexHullTest, PointsInsideOnFacesAndOnEdgesAreNoCorners) {
  const auto hull = MakeConvexHull(Cube(1.0, 6), "grid");
  EXPECT_EQ(hull->vertices.size(), 8u);
  EXPECT_NEAR(hull->volume, 1.0, 1e-12);
}

TEST(ConvexHullTest, RepeatedPointsAreWelded) {
  auto points = Cube(1.0, 2);
  for (int i = 0; i < 3; ++i) points.insert(points.end(), points.begin(), points.begin() + 8);
  EXPECT_EQ(MakeConvexHull(points, "cube")->vertices.size(), 8u);
}

TEST(ConvexHullTest, ContainsEveryPointOfRandomClouds) {
  RandomBodies random(3);
  for (int i = 0; i < 50; ++i) {
    std::vector<Vector3d> points(5 + random.Integer(400));
    const Vector3d stretch(random.Uniform(0.01, 1), random.Uniform(0.01, 1), 1.0);
    for (Vector3d& p : points) p = random.Direction().cwiseProduct(stretch);
    ExpectConvexSurfaceAround(*MakeConvexHull(points, "cloud"), points, 1e-11);
  }
}

// Points that nearly lie in one face: where tolerances tear the surface of a hull.
TEST(ConvexHullTest, NoiseOnTheFacesDoesNotTearTheSurface) {
  RandomBodies random(4);
  for (const double noise : {1e-6, 1e-9, 1e-12, 1e-15}) {
    auto points = Cube(1.0, 7);
    for (Vector3d& p : points) p += noise * random.Direction();
    const auto hull = MakeConvexHull(points, "noisy cube");
    ExpectConvexSurfaceAround(*hull, points, 1e-10);
    EXPECT_NEAR(hull->volume, 1.0, 10 * noise + 1e-11);
  }
}

// On a sphere, and on two rims that lie in no plane of the axes: 12,000 corners at most, and faces
// on which thousands of points lie but for rounding.
std::vector<Vector3d> ManyCorners(bool rims, const Vector3d& offset) {
  RandomBodies random(5);
  const Eigen::Matrix3d R = random.Pose(0.0).linear();
  std::vector<Vector3d> points(12'000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double angle = 1e-3 * static_cast<double>(i);
    const Vector3d on_rim(std::cos(angle), std::sin(angle), i % 2 == 0 ? 1.0 : -1.0);
    points[i] = offset + (rims ? R * on_rim : random.Direction());
  }
  return points;
}

TEST(ConvexHullTest, PlanesOfManyCornersHoldEveryVertexAndLieCloseToTheirTriangle) {
  for (const bool rims : {false, true}) {
    for (const double away : {0.0, 1e3}) {
      const auto points = ManyCorners(rims, Vector3d(away, -away, 0.0));
      const auto hull = MakeConvexHull(points, "many corners");
      ASSERT_GT(hull->vertices.size(), 4096u);
      ASSERT_EQ(hull->planes.size(), hull->triangles.size());
      const double room = 3e-12 + 1e-14 * away;
      for (std::size_t i = 0; i < hull->planes.size(); i += 97) {
        const auto& [normal, offset] = hull->planes[i];
        EXPECT_NEAR(normal.norm(), 1.0, 1e-15);
        for (const int corner : hull->triangles[i]) {
          ASSERT_GT(normal.dot(hull->vertices[corner]), offset - 2.0 * room);
        }
        for (const Vector3d& p : points) ASSERT_LE(normal.dot(p), offset);
      }
    }
  }
}

TEST(ConvexHullTest, SurfacesOfManyCornersAreClosed) {
  for (const bool rims : {false, true}) {
    const auto hull = MakeConvexHull(ManyCorners(rims, Vector3d::Zero()), "many corners");
    ExpectConvexSurfaceAround(*hull, {}, 0.0);
    EXPECT_NEAR(hull->volume, (rims ? 2.0 : 4.0 / 3.0) * M_PI, 5e-3);
  }
}

TEST(ConvexHullTest, SizeMakesNoDifference) {
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    const auto hull = MakeConvexHull(Cube(scale, 3), "cube");
    EXPECT_EQ(hull->vertices.size(), 8u);
    EXPECT_NEAR(hull->volume / std::pow(scale, 3), 1.0, 1e-11);
  }
}

TEST(ConvexHullTest, ColumnsAreFilledToEightWithTheFirstVertex) {
  const std::vector<Vector3d> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const auto hull = MakeConvexHull(corners, "corner");
  ASSERT_EQ(hull->column_size, 8);
  ASSERT_EQ(hull->columns.size(), 24u);
  for (int i = 0; i < 8; ++i) {
    const Vector3d column(hull->columns[i], hull->columns[8 + i], hull->columns[16 + i]);
    EXPECT_EQ(column, hull->vertices[i < 4 ? i : 0]);
  }
}

TEST(ConvexHullTest, RefusesTooFewPoints) {
  EXPECT_THAT(RefusalOf({}), HasSubstr("link 3: too few points for a convex hull; got 0"));
  EXPECT_THAT(RefusalOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), HasSubstr("got 3; expected 4"));
}

TEST(ConvexHullTest, RefusesPointsThatAreNotFinite) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    auto points = Cube(1.0, 2);
    points[5].y() = bad;
    EXPECT_THAT(RefusalOf(points),
                AllOf(HasSubstr("link 3: vertex 5 is not finite"), HasSubstr("expected numbers")));
  }
}

TEST(ConvexHullTest, RefusesAPointALineAndAPlane) {
  EXPECT_THAT(RefusalOf(std::vector<Vector3d>(9, Vector3d::Ones())), HasSubstr("size"));
  std::vector<Vector3d> line, plane;
  for (int i = 0; i < 9; ++i) line.emplace_back(0.1 * i, 0.2 * i, 0.3 * i);
  for (int i = 0; i < 9; ++i) plane.emplace_back(i % 3, i / 3, 0.5 * (i % 3));
  EXPECT_THAT(RefusalOf(line), HasSubstr("one plane or line"));
  EXPECT_THAT(RefusalOf(plane), HasSubstr("one plane or line"));
}

TEST(ConvexHullTest, ThinnestPlateIsAMillionthOfItsExtent) {
  const auto plate = [](double thickness) {
    auto points = Cube(2.0, 2);
    for (Vector3d& p : points) p.z() *= thickness / 2.0;
    return points;
  };
  EXPECT_EQ(RefusalOf(plate(1.1e-6)), "accepted");
  EXPECT_THAT(RefusalOf(plate(0.9e-6)), HasSubstr("expected a body with volume"));
}

}  // namespace convex_hull_test
}  // namespace oca::geometry
