// SPDX-License-Identifier: BSD-3-Clause
// Values worked out by hand, boundaries and refused input of Distance.
#include "oca/models/geometry/distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace oca::geometry {
namespace distance_test {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

std::shared_ptr<const Collider> Make(const Shape& shape) { return MakeCollider(shape, "test"); }

Isometry3d At(double x, double y, double z) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() = Vector3d(x, y, z);
  return X;
}

Isometry3d Turned(double angle, const Vector3d& axis, double x, double y, double z) {
  return At(x, y, z) * AngleAxisd(angle, axis);
}

Shape CubeMesh(double edge) {
  std::vector<Vector3d> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(0.5 * edge * Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
  }
  return ConvexMesh{MakeConvexHull(corners, "cube")};
}

const Shape kUnitBox = Box{Vector3d::Ones()};

void ExpectSphereAgainstUnitCube(const Shape& cube) {
  const auto sphere = Make(Sphere{0.1});
  const auto body = Make(cube);
  const auto distance = [&](double x, double y, double z) {
    return Distance(*sphere, At(x, y, z), *body, Isometry3d::Identity()).distance;
  };
  EXPECT_NEAR(distance(1, 0, 0), 0.4, 1e-12);
  EXPECT_NEAR(distance(1, 1, 0), std::sqrt(0.5) - 0.1, 1e-12);   // 0.6071067812
  EXPECT_NEAR(distance(1, 1, 1), std::sqrt(0.75) - 0.1, 1e-12);  // 0.7660254038
  EXPECT_NEAR(distance(0.3, 0, 0), -0.3, 1e-12);
  EXPECT_NEAR(distance(0, 0, 0), -0.6, 1e-12);
}

TEST(DistanceTest, SphereAgainstBoxAsWorkedOutByHand) { ExpectSphereAgainstUnitCube(kUnitBox); }

TEST(DistanceTest, SphereAgainstCubeMeshEqualsSphereAgainstBox) {
  ExpectSphereAgainstUnitCube(CubeMesh(1.0));
}

TEST(DistanceTest, PointsAndNormalOfASphereBesideABox) {
  const auto result =
      Distance(*Make(Sphere{0.1}), At(1, 0.2, 0.1), *Make(kUnitBox), Isometry3d::Identity());
  EXPECT_TRUE(result.point_a.isApprox(Vector3d(0.9, 0.2, 0.1), 1e-12));
  EXPECT_TRUE(result.point_b.isApprox(Vector3d(0.5, 0.2, 0.1), 1e-12));
  EXPECT_TRUE(result.normal.isApprox(Vector3d::UnitX(), 1e-12));
  EXPECT_EQ(result.status, DistanceStatus::kExact);
}

TEST(DistanceTest, SphereInsideABoxLeavesThroughTheNearestFace) {
  const auto result =
      Distance(*Make(Sphere{0.1}), At(0.1, -0.4, 0.2), *Make(kUnitBox), Isometry3d::Identity());
  EXPECT_NEAR(result.distance, -0.2, 1e-12);
  EXPECT_TRUE(result.normal.isApprox(-Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(result.point_b.isApprox(Vector3d(0.1, -0.5, 0.2), 1e-12));
  EXPECT_TRUE(result.point_a.isApprox(Vector3d(0.1, -0.3, 0.2), 1e-12));
}

TEST(DistanceTest, SpheresWithOneCentreStillHaveAUnitNormal) {
  const auto result = Distance(*Make(Sphere{0.1}), At(1, 2, 3), *Make(Sphere{0.2}), At(1, 2, 3));
  EXPECT_DOUBLE_EQ(result.distance, -0.1 - 0.2);
  EXPECT_NEAR(result.normal.norm(), 1.0, 1e-15);
}

TEST(DistanceTest, SphereAgainstCylinderFromEachSide) {
  const auto sphere = Make(Sphere{0.1});
  const auto cylinder = Make(Cylinder{0.5, 2.0});
  const auto distance = [&](double x, double y, double z) {
    return Distance(*sphere, At(x, y, z), *cylinder, Isometry3d::Identity()).distance;
  };
  EXPECT_NEAR(distance(0.6, 0.8, 0.9), 0.4, 1e-12);   // beside: 1 - 0.5 - 0.1
  EXPECT_NEAR(distance(0.1, 0.2, -1.5), 0.4, 1e-12);  // below the bottom
  EXPECT_NEAR(distance(0.8, 0, 1.4), 0.4, 1e-12);     // off the rim: 3-4-5 triangle
  EXPECT_NEAR(distance(0.3, 0, 0), -0.3, 1e-12);      // inside, out through the side
  EXPECT_NEAR(distance(0, 0, 0.9), -0.2, 1e-12);      // inside, out through the top
  EXPECT_NEAR(distance(0, 0, 0), -0.6, 1e-12);        // on the axis
}

TEST(DistanceTest, CapsulesSideBySideEndToEndAndCrossed) {
  const auto a = Make(Capsule{0.1, 1.0});
  const auto b = Make(Capsule{0.2, 1.0});
  const auto distance = [&](const Isometry3d& X_WB) {
    return Distance(*a, Isometry3d::Identity(), *b, X_WB).distance;
  };
  EXPECT_NEAR(distance(At(1, 0, 0.3)), 0.7, 1e-12);
  EXPECT_NEAR(distance(At(0, 0, 2)), 0.7, 1e-12);
  EXPECT_NEAR(distance(At(0.3, 0.4, 0)), 0.2, 1e-12);
  EXPECT_NEAR(distance(Turned(M_PI / 2, Vector3d::UnitY(), 0.2, 0.5, 0.1)), 0.2, 1e-12);
  EXPECT_NEAR(distance(Turned(M_PI / 2, Vector3d::UnitY(), 0.2, 0.0, 0.1)), -0.3, 1e-12);
  EXPECT_NEAR(distance(Isometry3d::Identity()), -0.3, 1e-12);
}

TEST(DistanceTest, CrossedAxesSeparateAcrossBoth) {
  const auto a = Make(Capsule{0.1, 1.0});
  const auto result =
      Distance(*a, Isometry3d::Identity(), *a, Turned(M_PI / 2, Vector3d::UnitY(), 0, 0, 0));
  EXPECT_NEAR(std::abs(result.normal.y()), 1.0, 1e-12);
}

TEST(DistanceTest, ParallelCapsulesMeetInTheMiddleOfWhatTheyShare) {
  const auto a = Make(Capsule{0.1, 1.0});
  const auto result = Distance(*a, Isometry3d::Identity(), *a, At(1, 0, 0.6));
  EXPECT_TRUE(result.point_a.isApprox(Vector3d(0.1, 0, 0.3), 1e-12));
  EXPECT_TRUE(result.point_b.isApprox(Vector3d(0.9, 0, 0.3), 1e-12));
}

TEST(DistanceTest, CrossedEdgesOfTwoCubes) {
  // Each cube stands on an edge; the edges cross at right angles. Half a diagonal is sqrt(1/2).
  const auto cube = Make(kUnitBox);
  const Isometry3d X_WA = Turned(M_PI / 4, Vector3d::UnitX(), 0, 0, 2.0);
  const Isometry3d X_WB = Turned(M_PI / 4, Vector3d::UnitY(), 0, 0, 0);
  const auto apart = Distance(*cube, X_WA, *cube, X_WB);
  EXPECT_NEAR(apart.distance, 2.0 - std::sqrt(2.0), 1e-10);
  EXPECT_TRUE(apart.normal.isApprox(Vector3d::UnitZ(), 1e-6));
  const auto overlap = Distance(*cube, Turned(M_PI / 4, Vector3d::UnitX(), 0, 0, 1.3), *cube, X_WB);
  EXPECT_NEAR(overlap.distance, 1.3 - std::sqrt(2.0), 1e-10);
  EXPECT_TRUE(overlap.normal.isApprox(Vector3d::UnitZ(), 1e-9));
}

TEST(DistanceTest, IdenticalPosesSeparateAlongTheThinnestWay) {
  const Isometry3d X = Turned(0.7, Vector3d(1, 2, 3).normalized(), 0.1, 0.2, 0.3);
  const auto depth = [&](const Shape& shape) {
    return -Distance(*Make(shape), X, *Make(shape), X).distance;
  };
  EXPECT_NEAR(depth(Box{Vector3d(1.0, 0.2, 0.5)}), 0.2, 1e-10);
  EXPECT_NEAR(depth(CubeMesh(0.4)), 0.4, 1e-10);
  EXPECT_NEAR(depth(Cylinder{0.5, 0.3}), 0.3, 1e-9);
  EXPECT_NEAR(depth(Cylinder{0.1, 1.0}), 0.2, 1e-6);  // a ring of equally good ways
  EXPECT_NEAR(depth(Capsule{0.1, 1.0}), 0.2, 1e-10);
  EXPECT_NEAR(depth(Sphere{0.1}), 0.2, 1e-10);
}

TEST(DistanceTest, TouchingFacesAreAtZeroWithTheFaceNormal) {
  const auto box = Make(kUnitBox);
  const std::vector<std::shared_ptr<const Collider>> others = {
      Make(kUnitBox), Make(CubeMesh(1.0)), Make(Cylinder{0.3, 1.0}), Make(Sphere{0.5})};
  for (const auto& other : others) {
    const auto result = Distance(*other, At(0.1, 0.1, 1.0), *box, Isometry3d::Identity());
    EXPECT_NEAR(result.distance, 0.0, 1e-10);
    EXPECT_NEAR(result.normal.z(), 1.0, 1e-9);
    EXPECT_NEAR(result.point_a.z(), 0.5, 1e-9);
    EXPECT_NEAR(result.point_b.z(), 0.5, 1e-9);
  }
}

TEST(DistanceTest, SignIsRightOnBothSidesOfTouch) {
  const auto box = Make(kUnitBox);
  const auto cylinder = Make(Cylinder{0.3, 1.0});
  for (const double gap : {1e-6, 1e-8, -1e-8, -1e-6}) {
    const auto result = Distance(*cylinder, At(0.1, 0.1, 1.0 + gap), *box, At(0, 0, 0));
    EXPECT_NEAR(result.distance, gap, 1e-9);
  }
}

TEST(DistanceTest, FlatPlatesAndNeedlesAreNoSpecialCase) {
  const auto plate = Make(Box{Vector3d(1.0, 1.0, 1e-6)});
  EXPECT_NEAR(Distance(*plate, At(0, 0, 0.5), *plate, At(0.3, 0, 0)).distance, 0.5 - 1e-6, 1e-10);
  EXPECT_NEAR(Distance(*plate, At(0.2, 0.1, 0), *plate, At(0, 0, 0)).distance, -1e-6, 1e-10);
  const std::vector<Vector3d> corners = {{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}, {3e-4, 3e-4, 1.0}};
  const auto needle = Make(ConvexMesh{MakeConvexHull(corners, "needle")});
  EXPECT_NEAR(Distance(*needle, At(0, 0, 0.7), *plate, At(0, 0, 0)).distance, 0.7 - 5e-7, 1e-10);
  EXPECT_NEAR(Distance(*needle, At(0, 0, -0.9), *plate, At(0, 0, 0)).distance, -0.1 - 5e-7, 1e-10);
}

TEST(DistanceTest, ASmallPartAboveAWideFloor) {
  const auto floor = Make(Box{Vector3d(1000.0, 1000.0, 1.0)});
  const auto pin = Make(Cylinder{1e-3, 4e-3});
  for (const double gap : {0.01, 1e-4, -1e-3}) {
    const auto result = Distance(*pin, At(30.0, 400.0, 0.5 + 2e-3 + gap), *floor, At(0, 0, 0));
    EXPECT_NEAR(result.distance, gap, 1e-7);
    EXPECT_NEAR(result.normal.z(), 1.0, 1e-6);
  }
}

TEST(DistanceTest, StopsAtMaxDistanceAndNotBefore) {
  const auto box = Make(kUnitBox);
  const auto status = [&](const Shape& shape, double max_distance) {
    return Distance(*Make(shape), At(2, 0, 0), *box, At(0, 0, 0), max_distance);
  };
  for (const Shape& shape : {Shape(Cylinder{0.5, 1.0}), kUnitBox, CubeMesh(1.0)}) {
    EXPECT_EQ(status(shape, 1.001).status, DistanceStatus::kExact);  // the distance is 1
    const auto beyond = status(shape, 0.999);
    EXPECT_EQ(beyond.status, DistanceStatus::kBeyond);
    EXPECT_GT(beyond.distance, 0.999);
    EXPECT_LE(beyond.distance, 1.0 + 1e-12);
  }
}

TEST(DistanceTest, BoundingSpheresCullWithALowerBound) {
  const auto box = Make(kUnitBox);
  const auto result = Distance(*box, At(10, 0, 0), *box, At(0, 0, 0), 1.0);
  EXPECT_EQ(result.status, DistanceStatus::kBeyond);
  EXPECT_NEAR(result.distance, 10 - std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(result.normal.norm(), 1.0, 1e-12);
}

TEST(DistanceTest, APoseThatIsNotFiniteIsReported) {
  const auto box = Make(kUnitBox);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    const auto first = Distance(*box, At(bad, 0, 0), *box, At(0, 0, 0), 0.1);
    const auto second = Distance(*box, At(0, 0, 0), *box, At(0, bad, 0), 0.1);
    EXPECT_EQ(first.status, DistanceStatus::kInvalid);
    EXPECT_EQ(second.status, DistanceStatus::kInvalid);
    EXPECT_TRUE(std::isnan(first.distance) && std::isnan(second.distance));
  }
}

}  // namespace distance_test
}  // namespace oca::geometry
