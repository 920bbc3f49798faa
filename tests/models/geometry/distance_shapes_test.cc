// SPDX-License-Identifier: BSD-3-Clause
// Cone, ellipsoid, half-space and compound: values by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "oca/models/error.h"
#include "tests/models/geometry/random_bodies.h"

namespace oca::geometry {
namespace distance_shapes_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

std::shared_ptr<const Collider> Make(const Shape& shape) { return MakeCollider(shape, "body"); }

Isometry3d At(double x, double y, double z) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() = Vector3d(x, y, z);
  return X;
}

double ToSphere(const Shape& shape, double x, double y, double z) {
  return Distance(*Make(Sphere{0.1}), At(x, y, z), *Make(shape), Isometry3d::Identity()).distance;
}

std::string RefusalOf(const Shape& shape) {
  try {
    Make(shape);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "";
}

// Radius 3, from z = -2 to the apex at 2: the slant is 5 long, its normal (0.8, 0.6).
TEST(DistanceShapesTest, SphereAroundACone) {
  const Cone cone{3.0, 4.0};
  EXPECT_NEAR(ToSphere(cone, 0, 0, 3), 0.9, 1e-15);                // above the apex
  EXPECT_NEAR(ToSphere(cone, 1, 0, -3), 0.9, 1e-15);               // below the base
  EXPECT_NEAR(ToSphere(cone, 1.5 + 0.8, 0, 0.6), 0.9, 1e-15);      // beside the slant
  EXPECT_NEAR(ToSphere(cone, 6, 0, -6), 4.9, 1e-15);               // at the rim, 3-4-5
  EXPECT_NEAR(ToSphere(cone, 0, 0, -1.5), -0.6, 1e-15);            // out through the base
  EXPECT_NEAR(ToSphere(cone, 1.5 - 0.16, 0, -0.12), -0.3, 1e-15);  // out through the slant
}

TEST(DistanceShapesTest, SphereAroundAnEllipsoid) {
  const Ellipsoid ellipsoid{{1.0, 2.0, 3.0}};
  EXPECT_NEAR(ToSphere(ellipsoid, 2, 0, 0), 0.9, 1e-15);
  EXPECT_NEAR(ToSphere(ellipsoid, 0, -4, 0), 1.9, 1e-15);
  EXPECT_NEAR(ToSphere(ellipsoid, 0, 0, 0), -1.1, 1e-15);  // the shortest semi-axis
  // From the surface point at 45 degrees of parameter, one metre along the normal.
  const Vector3d surface = Vector3d(1, 2, 0) / std::sqrt(2.0);
  const Vector3d p = surface + Vector3d(2, 1, 0).normalized();
  EXPECT_NEAR(ToSphere(ellipsoid, p.x(), p.y(), p.z()), 0.9, 1e-15);
}

TEST(DistanceShapesTest, ARoundEllipsoidIsASphere) {
  RandomBodies random(301);
  const auto ball = Make(Sphere{0.3}), ellipsoid = Make(Ellipsoid{{0.3, 0.3, 0.3}});
  for (int i = 0; i < 300; ++i) {
    const auto other = random.Body(i % RandomBodies::kKinds);
    const Isometry3d X = random.Pose(1.0);
    EXPECT_NEAR(Distance(*other, X, *ellipsoid, At(0, 0, 0)).distance,
                Distance(*other, X, *ball, At(0, 0, 0)).distance, 2e-6)
        << KindName(*other);
  }
}

TEST(DistanceShapesTest, TheLowestPointCountsAboveAHalfSpace) {
  const auto floor = Make(HalfSpace{});
  const auto above = [&](const Shape& shape, double z) {
    return Distance(*Make(shape), At(5, -3, z), *floor, At(0, 0, 0.5));
  };
  EXPECT_NEAR(above(Sphere{0.1}, 1.0).distance, 0.4, 1e-15);
  EXPECT_NEAR(above(Box{{1, 1, 1}}, 1.0).distance, 0.0, 1e-15);
  EXPECT_NEAR(above(Capsule{0.1, 0.4}, 0.5).distance, -0.3, 1e-15);
  EXPECT_NEAR(above(Cone{0.3, 1.0}, 2.0).distance, 1.0, 1e-15);
  EXPECT_NEAR(above(Ellipsoid{{0.1, 0.2, 0.3}}, 2.0).distance, 1.2, 1e-15);
  const auto found = above(Cylinder{0.1, 1.0}, 2.0);
  EXPECT_NEAR(found.normal.z(), 1.0, 1e-15);
  EXPECT_NEAR(found.point_a.z(), 1.5, 1e-15);
  EXPECT_NEAR(found.point_b.z(), 0.5, 1e-15);
  // The other way round the normal turns about.
  const auto turned = Distance(*floor, At(0, 0, 0.5), *Make(Sphere{0.1}), At(0, 0, 1));
  EXPECT_NEAR(turned.normal.z(), -1.0, 1e-15);
}

TEST(DistanceShapesTest, TwoHalfSpacesHaveNoDistance) {
  const auto floor = Make(HalfSpace{});
  const auto found = Distance(*floor, At(0, 0, 0), *floor, At(0, 0, 1));
  EXPECT_EQ(found.status, DistanceStatus::kInvalid);
  EXPECT_TRUE(std::isnan(found.distance));
}

TEST(DistanceShapesTest, OfACompoundTheNearestPartCounts) {
  // A dumbbell: balls of 0.2 m at +-1 m and a bar between them.
  const auto dumbbell = Make(Compound{{{At(1, 0, 0), Sphere{0.2}},
                                       {At(-1, 0, 0), Sphere{0.2}},
                                       {At(0, 0, 0), Box{{2, 0.1, 0.1}}}}});
  const auto ball = Make(Sphere{0.1});
  PairCache cache;
  for (const double x : {1.0, -1.0, 0.0, 1.0}) {  // warm from the wrong part, too
    const auto found = Distance(*ball, At(x, 0, 1), *dumbbell, At(0, 0, 0), 10.0, &cache);
    EXPECT_NEAR(found.distance, x == 0.0 ? 0.85 : 0.7, 1e-15);
    EXPECT_NEAR(found.normal.z(), 1.0, 1e-15);
  }
  EXPECT_EQ(Distance(*ball, At(0, 0, 9), *dumbbell, At(0, 0, 0), 1.0).status,
            DistanceStatus::kBeyond);
  // In overlap the deepest part: 0.3 m into the ball, 0.15 m into the bar.
  EXPECT_NEAR(Distance(*ball, At(1, 0, 0), *dumbbell, At(0, 0, 0)).distance, -0.3, 1e-15);
  EXPECT_DOUBLE_EQ(dumbbell->bounding_radius(), 1.2);
}

TEST(DistanceShapesTest, TwoCompoundsAreAsFarAsTheirNearestParts) {
  const Compound pair{{{At(-1, 0, 0), Sphere{0.2}}, {At(1, 0, 0), Sphere{0.3}}}};
  const auto a = Make(pair), b = Make(pair);
  EXPECT_NEAR(Distance(*a, At(0, 0, 0), *b, At(4, 0, 0)).distance, 1.5, 1e-15);
  EXPECT_NEAR(Distance(*a, At(0, 0, 0), *b, At(-4, 0, 0)).distance, 1.5, 1e-15);
  EXPECT_NEAR(Distance(*a, At(0, 0, 5), *Make(HalfSpace{}), At(0, 0, 0)).distance, 4.7, 1e-15);
}

TEST(DistanceShapesTest, RefusesWhatHasNoSizeOrNoEnd) {
  EXPECT_THAT(RefusalOf(Cone{0.0, 1.0}), HasSubstr("body: cone radius; got 0"));
  EXPECT_THAT(RefusalOf(Cone{1.0, -1.0}), HasSubstr("cone length; got -1"));
  EXPECT_THAT(RefusalOf(Cone{1.0, 1e-10}), HasSubstr("too flat"));
  EXPECT_THAT(RefusalOf(Ellipsoid{{1.0, 1.0, 0.0}}), HasSubstr("ellipsoid radius z; got 0"));
  EXPECT_THAT(RefusalOf(Compound{}), HasSubstr("compound; got no parts"));
  EXPECT_THAT(RefusalOf(Compound{{{At(0, 0, 0), HalfSpace{}}}}),
              HasSubstr("part 0; got a half-space"));
  EXPECT_THAT(RefusalOf(Compound{{{At(0, 0, 0), Sphere{1}}, {At(0, 0, 0), Compound{}}}}),
              HasSubstr("part 1; got a compound"));
  EXPECT_THAT(RefusalOf(Compound{{{At(NAN, 0, 0), Sphere{1}}}}), HasSubstr("part 0: pose; got"));
  EXPECT_THAT(RefusalOf(Compound{{{At(0, 0, 0), Sphere{0}}}}),
              HasSubstr("part 0: sphere radius; got 0"));
}

TEST(DistanceShapesTest, OneCentreForTwoBodiesOfAnyKindsStillHasAWayOut) {
  for (const double scale : {1e-6, 1.0, 1e3}) {
    RandomBodies random(302, scale);
    for (int i = 0; i < RandomBodies::kKinds; ++i) {
      for (int k = 0; k < RandomBodies::kKinds; ++k) {
        const auto a = random.Body(i), b = random.Body(k);
        const Isometry3d X = random.Pose(1.0);
        const auto found = Distance(*a, X, *b, X);
        ASSERT_LT(found.distance, 0.0) << KindName(*a) << " and " << KindName(*b);
        ASSERT_NEAR(found.normal.norm(), 1.0, 1e-12);
        ASSERT_NEAR(SlabWidth(*a, X, *b, X, found.normal), found.distance, 1e-7 * scale)
            << KindName(*a) << " and " << KindName(*b);
      }
    }
  }
}

TEST(DistanceShapesTest, FacesThatTouchAreNoDistanceApart) {
  const auto box = Make(Box{{1, 1, 1}});
  EXPECT_NEAR(Distance(*box, At(1, 0.3, 0.2), *box, At(0, 0, 0)).distance, 0.0, 1e-12);
  EXPECT_NEAR(Distance(*Make(Cone{0.3, 1.0}), At(0, 0, 1), *box, At(0, 0, 0)).distance, 0.0, 1e-9);
  EXPECT_NEAR(Distance(*Make(Cylinder{0.3, 1.0}), At(0, 0, 1), *box, At(0, 0, 0)).distance, 0.0,
              1e-9);
  EXPECT_NEAR(Distance(*Make(Ellipsoid{{1, 1, 0.5}}), At(0, 0, 1), *box, At(0, 0, 0)).distance, 0.0,
              1e-9);
  const auto slab = Make(Box{{1, 1, 1e-6}});
  EXPECT_NEAR(Distance(*slab, At(0, 0, 1e-6), *slab, At(0, 0, 0)).distance, 0.0, 1e-15);
}

}  // namespace distance_shapes_test
}  // namespace oca::geometry
