// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/fuse_capsules.h"

#include <gtest/gtest.h>

#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace fuse_capsules_test {

// A cylinder of length 0.4 with spheres at its ends, all in the frame X.
std::vector<CollisionElement> Pill(const Eigen::Isometry3d& X, double cylinder_radius,
                                   double sphere_radius, double top, double bottom) {
  const auto at = [&X](double z) { return X * Eigen::Translation3d(0, 0, z); };
  return {{X, geometry::Cylinder{cylinder_radius, 0.4}, "cylinder"},
          {at(top), geometry::Sphere{sphere_radius}, "top"},
          {at(bottom), geometry::Sphere{sphere_radius}, "bottom"}};
}

TEST(FuseCapsulesTest, CylinderWithTwoSphereEndsIsACapsule) {
  Random random(41);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Isometry3d X = RandomPose(random);
    const auto fused = FuseCapsules(Pill(X, 0.05, 0.05, 0.2, -0.2));
    ASSERT_EQ(fused.size(), 1u);
    const auto* capsule = std::get_if<geometry::Capsule>(&fused[0].shape);
    ASSERT_NE(capsule, nullptr);
    EXPECT_EQ(capsule->radius, 0.05);
    EXPECT_EQ(capsule->length, 0.4);
    EXPECT_TRUE(fused[0].X_LC.isApprox(X));
    EXPECT_EQ(fused[0].source, "cylinder");
  }
}

TEST(FuseCapsulesTest, StaysApartWhereTheSpaceWouldDiffer) {
  const auto X = Eigen::Isometry3d::Identity();
  EXPECT_EQ(FuseCapsules(Pill(X, 0.05, 0.05 + 1e-6, 0.2, -0.2)).size(), 3u);  // other radius
  EXPECT_EQ(FuseCapsules(Pill(X, 0.05, 0.05, 0.2 + 1e-6, -0.2)).size(), 3u);  // off the end
  EXPECT_EQ(FuseCapsules(Pill(X, 0.05, 0.05, 0.2, 0.2)).size(), 3u);          // one end only
  EXPECT_EQ(FuseCapsules(Pill(X, 0.05, 0.05, 0.2 + 1e-11, -0.2)).size(), 1u);
}

TEST(FuseCapsulesTest, SphereAtAnElbowEndsBothCylinders) {
  auto X = Eigen::Isometry3d::Identity();
  auto elements = Pill(X, 0.05, 0.05, 0.2, -0.2);
  X.linear() = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  X.translation() = Eigen::Vector3d(0, 0, 0.2) + X.linear() * Eigen::Vector3d(0, 0, 0.2);
  elements.push_back({X, geometry::Cylinder{0.05, 0.4}, "forearm"});
  elements.push_back({X * Eigen::Translation3d(0, 0, 0.2), geometry::Sphere{0.05}, "wrist"});
  const auto fused = FuseCapsules(elements);
  ASSERT_EQ(fused.size(), 2u);
  EXPECT_TRUE(std::holds_alternative<geometry::Capsule>(fused[0].shape));
  EXPECT_TRUE(std::holds_alternative<geometry::Capsule>(fused[1].shape));
}

TEST(FuseCapsulesTest, LeavesOtherShapesInTheirOrder) {
  const auto X = Eigen::Isometry3d::Identity();
  const auto fused =
      FuseCapsules({{X, geometry::Box{{1, 1, 1}}, "box"}, {X, geometry::Sphere{1.0}, "ball"}});
  ASSERT_EQ(fused.size(), 2u);
  EXPECT_EQ(fused[0].source, "box");
  EXPECT_EQ(fused[1].source, "ball");
}

}  // namespace fuse_capsules_test
}  // namespace oca::robot::test
