// SPDX-License-Identifier: BSD-3-Clause
// The methods behind Distance, one against the other: algebra, GJK, polytope, Bullet.
#include <gtest/gtest.h>

#include <algorithm>

#include "oca/models/geometry/bullet_penetration.h"
#include "oca/models/geometry/closed_forms.h"
#include "oca/models/geometry/gjk.h"
#include "oca/models/geometry/polytope_depth.h"
#include "tests/models/geometry/random_bodies.h"

namespace oca::geometry::internal {
namespace core_methods_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kFar = std::numeric_limits<double>::infinity();

TEST(CoreMethodsTest, ClosedFormsExistForTheSimplePairsOnly) {
  RandomBodies random(51);
  const auto exists = [&](int a, int b) {
    const auto first = random.Body(a), second = random.Body(b);
    CoreDistance found;
    return ClosedForm({*first, *second, random.Pose(0.5)}, &found);
  };
  for (const int solid : {0, 1, 2, 3, 5, 6}) EXPECT_TRUE(exists(solid, 0));
  EXPECT_TRUE(exists(1, 1));
  EXPECT_TRUE(exists(2, 1));
  EXPECT_FALSE(exists(4, 0));
  EXPECT_FALSE(exists(5, 1));
  EXPECT_FALSE(exists(3, 3));
}

TEST(CoreMethodsTest, EverythingThatEndsHasAClosedFormWithAHalfSpace) {
  RandomBodies random(55);
  const auto floor = MakeCollider(HalfSpace{}, "floor");
  for (int kind = 0; kind < RandomBodies::kKinds; ++kind) {
    CoreDistance found;
    EXPECT_TRUE(ClosedForm({*floor, *random.Body(kind), random.Pose(0.5)}, &found));
  }
  CoreDistance found;
  EXPECT_FALSE(ClosedForm({*floor, *floor, random.Pose(0.5)}, &found));
}

// Segments beside, above and askew, some of them along the axes: what GJK finds, GJK's proof holds.
TEST(CoreMethodsTest, CylindersAndSegmentsAreAsFarApartAsTheSearchSays) {
  RandomBodies random(56);
  int apart = 0, overlaps = 0;
  double off = 0.0, normal = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const auto cylinder = random.Body(3), capsule = random.Body(1);
    const CorePair pair{*cylinder, *capsule, i % 4 == 0 ? random.GridPose() : random.Pose(0.6)};
    CoreDistance closed, found;
    const auto status = Gjk(pair, kFar, false, nullptr, &found);
    if (!ClosedForm(pair, &closed)) {
      ++overlaps;
      EXPECT_EQ(status, GjkStatus::kTouching);
      continue;
    }
    ++apart;
    ASSERT_EQ(status, GjkStatus::kSeparated);
    off = std::max(off, std::abs(closed.distance - found.distance) - found.gap);
    const double width = closed.normal.dot(pair.Support(-closed.normal).w);
    off = std::max(off, std::abs(width - closed.distance));
    if (i % 4 != 0) normal = std::max(normal, (closed.normal - found.normal).norm());
  }
  EXPECT_GT(apart, 5'000);
  EXPECT_GT(overlaps, 1'000);
  EXPECT_LE(off, 1e-12);
  EXPECT_LE(normal, 1e-6);
}

TEST(CoreMethodsTest, ASegmentBesideACylinder) {
  const auto cylinder = MakeCollider(Cylinder{0.5, 2.0}, "cylinder");
  const auto capsule = MakeCollider(Capsule{0.1, 1.0}, "capsule");
  Isometry3d X_AB = Isometry3d::Identity();
  CoreDistance found;
  const auto place = [&](const Vector3d& p) {
    X_AB.translation() = p;
    return ClosedForm({*cylinder, *capsule, X_AB}, &found);
  };
  ASSERT_TRUE(place(Vector3d(0.8, 0.0, 0.3)));  // along the side
  EXPECT_NEAR(found.distance, 0.3, 1e-15);
  EXPECT_NEAR(found.normal.x(), -1.0, 1e-15);
  ASSERT_TRUE(place(Vector3d(0.2, 0.0, 1.75)));  // its end above the cap
  EXPECT_NEAR(found.distance, 0.25, 1e-15);
  ASSERT_TRUE(place(Vector3d(0.8, 0.0, 1.9)));  // its end beside the rim
  EXPECT_NEAR(found.distance, 0.5, 1e-15);
  EXPECT_NEAR((found.point_a - Vector3d(0.5, 0.0, 1.0)).norm(), 0.0, 1e-15);
  X_AB.linear() = Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitX()).toRotationMatrix();
  ASSERT_TRUE(place(Vector3d(0.9, 0.0, 1.3)));  // its middle beside the rim
  EXPECT_NEAR(found.distance, 0.5, 1e-15);
  EXPECT_NEAR((found.point_b - X_AB.translation()).norm(), 0.0, 1e-15);
  EXPECT_TRUE(place(Vector3d(0.5 + 1e-9, 0.0, 0.0)));
  EXPECT_FALSE(place(Vector3d(0.5, 0.0, 0.0)));
  EXPECT_FALSE(place(Vector3d(0.2, 0.0, 0.0)));
}

TEST(CoreMethodsTest, GjkAndPolytopeAgreeWithAlgebra) {
  RandomBodies random(52);
  int apart = 0, overlaps = 0;
  for (int i = 0; i < 5'000; ++i) {
    const auto a = random.Body(1 + random.Integer(3)), point = random.Body(0);
    const CorePair pair{*a, *point, random.Pose(0.4)};
    CoreDistance exact;
    ASSERT_TRUE(ClosedForm(pair, &exact));
    CoreDistance found;
    if (Gjk(pair, kFar, false, nullptr, &found) == GjkStatus::kSeparated) {
      ++apart;
    } else if (a->core() == Collider::Core::kSegment) {
      continue;  // a segment less a point has no volume; Distance takes the closed form
    } else {
      ++overlaps;
      found = PolytopeDepth(pair, Vector3d::Zero());
    }
    ASSERT_NEAR(found.distance, exact.distance, 1e-10) << KindName(*a);
    ASSERT_LE((found.point_a - exact.point_a).norm(), 1e-4) << KindName(*a);
    ASSERT_LE((found.normal - exact.normal).norm(), 1e-4) << KindName(*a);
  }
  EXPECT_GT(apart, 1'000);
  EXPECT_GT(overlaps, 300);
}

TEST(CoreMethodsTest, BulletFindsTheShortWayOutOfAFlatDisc) {
  const auto disc = MakeCollider(Cylinder{0.5, 0.1}, "disc");
  Isometry3d X_AB = Isometry3d::Identity();
  X_AB.translation() = Vector3d(0.1, 0.05, 0.02);
  const Vector3d exit = BulletExit({*disc, *disc, X_AB});
  EXPECT_NEAR(exit.norm(), 1.0, 1e-12);
  EXPECT_NEAR(exit.z(), 1.0, 1e-9);  // A - B spans -0.12 to 0.08 along z
}

TEST(CoreMethodsTest, PolytopeNeedsNoHintToBeAsGoodAsBullet) {
  RandomBodies random(53);
  double worst = 0.0;
  int overlaps = 0;
  for (int i = 0; i < 3'000; ++i) {
    const auto cylinder = random.Body(3), other = random.Body(1 + random.Integer(4));
    const CorePair pair{*cylinder, *other, random.Pose(0.2)};
    CoreDistance unused;
    if (Gjk(pair, kFar, false, nullptr, &unused) != GjkStatus::kTouching) continue;
    ++overlaps;
    const double alone = PolytopeDepth(pair, Vector3d::Zero()).distance;
    const Vector3d exit = BulletExit(pair);
    ASSERT_GT(exit.norm(), 0.5);
    const double bullet = -exit.dot(pair.Support(exit).w);
    worst = std::max(worst, bullet - alone);  // > 0 where Bullet's way out is the shorter one
  }
  EXPECT_GT(overlaps, 1'000);
  EXPECT_LE(worst, 1e-9);
}

TEST(CoreMethodsTest, PolytopeProvesItsDepth) {
  RandomBodies random(54);
  for (int i = 0; i < 2'000; ++i) {
    const auto a = random.Body(4), b = random.Body(2);
    const CorePair pair{*a, *b, random.Pose(0.2)};
    CoreDistance unused;
    if (Gjk(pair, kFar, false, nullptr, &unused) != GjkStatus::kTouching) continue;
    const CoreDistance depth = PolytopeDepth(pair, Vector3d::Zero());
    ASSERT_LE(depth.gap, 1e-10);
    ASSERT_NEAR(depth.normal.dot(pair.Support(-depth.normal).w), depth.distance, 1e-10);
  }
}

TEST(CoreMethodsTest, GjkReportsALowerBoundBeyondItsLimit) {
  const auto box = MakeCollider(Box{Vector3d::Ones()}, "box");
  Isometry3d X_AB = Isometry3d::Identity();
  X_AB.translation() = Vector3d(3, 0.2, 0.1);
  const CorePair pair{*box, *box, X_AB};
  CoreDistance found;
  EXPECT_EQ(Gjk(pair, 2.01, false, nullptr, &found), GjkStatus::kSeparated);
  EXPECT_NEAR(found.distance, 2.0, 1e-10);
  EXPECT_EQ(Gjk(pair, 1.99, false, nullptr, &found), GjkStatus::kBeyond);
  EXPECT_GT(found.distance, 1.99);
  EXPECT_LE(found.distance, 2.0 + 1e-12);
}

}  // namespace core_methods_test
}  // namespace oca::geometry::internal
