// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/collider.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "oca/models/error.h"
#include "oca/models/geometry/hull_support.h"
#include "tests/models/geometry/random_bodies.h"

namespace oca::geometry {
namespace collider_test {

using Eigen::Vector3d;
using testing::AllOf;
using testing::HasSubstr;

std::string RefusalOf(const Shape& shape) {
  try {
    MakeCollider(shape, "obstacle 'box'");
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ColliderTest, RefusesASizeThatIsNotFiniteAndPositive) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -0.1, kNaN, kInf}) {
    EXPECT_THAT(RefusalOf(Sphere{bad}), AllOf(HasSubstr("obstacle 'box': sphere radius; got "),
                                              HasSubstr("expected a finite length")));
    EXPECT_THAT(RefusalOf(Box{Vector3d(1, bad, 1)}), HasSubstr("box size y; got "));
    EXPECT_THAT(RefusalOf(Cylinder{bad, 1}), HasSubstr("cylinder radius; got "));
    EXPECT_THAT(RefusalOf(Cylinder{1, bad}), HasSubstr("cylinder length; got "));
    EXPECT_THAT(RefusalOf(Capsule{bad, 1}), HasSubstr("capsule radius; got "));
    EXPECT_THAT(RefusalOf(Capsule{1, bad}), HasSubstr("capsule length; got "));
  }
}

TEST(ColliderTest, RefusesABodyLargerThanDoublesCanTell) {
  EXPECT_EQ(RefusalOf(Sphere{1e6}), "accepted");
  EXPECT_THAT(RefusalOf(Sphere{1.1e6}), HasSubstr("size; got points up to 1.1e+06 m"));
  EXPECT_THAT(RefusalOf(Capsule{1.0, 1e300}), HasSubstr("expected at most 1e+06 m"));
  EXPECT_EQ(RefusalOf(HalfSpace{}), "accepted");
}

TEST(ColliderTest, RefusesAMeshWithoutHull) {
  EXPECT_THAT(RefusalOf(ConvexMesh{}), HasSubstr("got no hull"));
}

TEST(ColliderTest, RefusesABodyFlatterThanArithmeticCanTell) {
  EXPECT_THAT(RefusalOf(Box{Vector3d(1, 1, 0.9e-9)}), HasSubstr("too flat"));
  EXPECT_EQ(RefusalOf(Box{Vector3d(1, 1, 1.1e-9)}), "accepted");
  EXPECT_THAT(RefusalOf(Cylinder{0.5, 0.9e-9}), HasSubstr("too flat"));
  EXPECT_THAT(RefusalOf(Cylinder{0.4e-9, 1.0}), HasSubstr("too flat"));
}

TEST(ColliderTest, BoundingRadiiAsWorkedOutByHand) {
  const auto radius = [](const Shape& shape) {
    return MakeCollider(shape, "test")->bounding_radius();
  };
  EXPECT_DOUBLE_EQ(radius(Sphere{0.3}), 0.3);
  EXPECT_DOUBLE_EQ(radius(Box{Vector3d(2, 4, 4)}), 3.0);
  EXPECT_DOUBLE_EQ(radius(Cylinder{3.0, 8.0}), 5.0);
  EXPECT_DOUBLE_EQ(radius(Capsule{0.1, 1.0}), 0.6);
}

TEST(ColliderTest, NoSupportPointLiesOutsideTheBoundingSphere) {
  RandomBodies random(1);
  for (int i = 0; i < 5'000; ++i) {
    const auto body = random.Body(i % RandomBodies::kKinds);
    const Vector3d p = Farthest(*body, Eigen::Isometry3d::Identity(), random.Direction());
    EXPECT_LE((p - body->centre()).norm(), body->bounding_radius() * (1 + 1e-14));
  }
}

TEST(ColliderTest, SupportOfAZeroDirectionIsAPointOfTheBody) {
  const auto cylinder = MakeCollider(Cylinder{1.0, 2.0}, "test");
  EXPECT_TRUE(cylinder->Support(Vector3d::Zero()).isApprox(Vector3d(0, 0, 1)));
}

TEST(HullSupportTest, VectorInstructionsFindAVertexAsFarAsTheLoop) {
  RandomBodies random(2);
  for (const int count : {4, 7, 8, 9, 15, 16, 17, 200}) {
    std::vector<Vector3d> points(count);
    for (Vector3d& p : points) p = random.Direction();
    const auto hull = MakeConvexHull(points, "ball");
    for (int i = 0; i < 500; ++i) {
      const Vector3d d = random.Direction();
      const Vector3d& fast = hull->vertices[internal::FarthestVertex(*hull, d)];
      const Vector3d& plain = hull->vertices[internal::FarthestVertexPortable(*hull, d)];
      double best = -2.0;
      for (const Vector3d& p : hull->vertices) best = std::max(best, d.dot(p));
      EXPECT_NEAR(d.dot(fast), best, 1e-15);
      EXPECT_NEAR(d.dot(plain), best, 1e-15);
    }
  }
}

}  // namespace collider_test
}  // namespace oca::geometry
