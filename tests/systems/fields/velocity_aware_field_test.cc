// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/velocity_aware_field.h"

#include <gtest/gtest.h>

#include <random>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace velocity_aware_field_test {

using Eigen::Vector3d;
using Params = VelocityAwareField::Params;

/// A link at the origin of the world, moving with v and turning with w; something at `distance`
/// against `normal`.
struct Scene {
  ProximitySet proximities;
  LinkPoses links;
};

Scene At(double distance, const Vector3d& normal, const Vector3d& v) {
  Scene scene;
  Proximity proximity;
  proximity.link = models::Name("link");
  proximity.obstacle = models::Name("box");
  proximity.distance = distance;
  proximity.normal = normal;
  scene.proximities.proximities.push_back(proximity);
  scene.links.links = {models::Name("link")};
  scene.links.poses = {Eigen::Isometry3d::Identity()};
  scene.links.bodies = {0};
  scene.links.velocities = {{v, Vector3d::Zero()}};
  return scene;
}

Vector3d ForceIn(const Scene& scene, const Params& params = {}) {
  SystemBench<VelocityAwareField> bench(params);
  bench->proximities.Fix(bench.context(), scene.proximities);
  bench->links.Fix(bench.context(), scene.links);
  return bench->forces.Eval(bench.context()).forces.at(0).force;
}

// Head on, U = lambda |v| s and F = lambda |v| (1/p^2 - 1/rho0^2) = 1/0.09 - 1/0.36.
TEST(VelocityAwareFieldTest, BrakesAHeadOnApproachAsByHand) {
  const Params params{.velocity_gain = 1.0, .exponent = 2.0, .max_distance = 0.6};
  const Vector3d force = ForceIn(At(0.3, Vector3d::UnitX(), {-1.0, 0.0, 0.0}), params);
  EXPECT_NEAR((force - Vector3d(1.0 / 0.09 - 1.0 / 0.36, 0.0, 0.0)).norm(), 0.0, 1e-12);
}

// At 60 degrees off the normal: c = -1/2, F_n = (1/4) 25/3, F_t = 2 (1/2) s/p sin 60.
TEST(VelocityAwareFieldTest, LeadsAroundWhatItPassesAslant) {
  const Params params{.velocity_gain = 1.0, .exponent = 2.0, .max_distance = 0.6};
  const Vector3d v(-0.5, std::sqrt(0.75), 0.0);
  const Vector3d force = ForceIn(At(0.3, Vector3d::UnitX(), v), params);
  EXPECT_NEAR(force.x(), 0.25 * (1.0 / 0.09 - 1.0 / 0.36), 1e-12);
  EXPECT_NEAR(force.y(), 0.25 / 0.3 / 0.3 * std::sqrt(0.75), 1e-12);
  EXPECT_EQ(force.z(), 0.0);
}

TEST(VelocityAwareFieldTest, IsTheNegativeGradientOfItsPotential) {
  const VelocityAwareField field({.velocity_gain = 0.7, .exponent = 2.5, .max_distance = 0.5});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int felt = 0;
  for (int sample = 0; sample < 200; ++sample) {
    const Vector3d x = 0.3 * Vector3d(uniform(random), uniform(random), uniform(random));
    const Vector3d v(uniform(random), uniform(random), uniform(random));
    if (x.norm() < 0.05) continue;
    Vector3d gradient;
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 3; ++i) {
      const Vector3d d = kStep * Vector3d::Unit(i);
      gradient[i] = (field.Potential(x + d, v) - field.Potential(x - d, v)) / (2.0 * kStep);
    }
    const Vector3d force = field.Force(x.norm(), x.normalized(), v);
    EXPECT_NEAR((force + gradient).norm(), 0.0, 1e-5 * (1.0 + force.norm()));
    felt += force.norm() > 0.0 ? 1 : 0;
  }
  EXPECT_GT(felt, 50);
}

TEST(VelocityAwareFieldTest, IsZeroAtRestMovingAwayAndFromTheRimOutwards) {
  const Vector3d n = Vector3d::UnitX();
  EXPECT_EQ(ForceIn(At(0.3, n, Vector3d::Zero())).norm(), 0.0);
  EXPECT_EQ(ForceIn(At(0.3, n, {0.0, 1.0, 0.0})).norm(), 0.0);
  EXPECT_EQ(ForceIn(At(0.3, n, {1.0, 0.0, 0.0})).norm(), 0.0);
  EXPECT_EQ(ForceIn(At(0.6, n, {-1.0, 0.0, 0.0})).norm(), 0.0);
  const double inside = ForceIn(At(0.6 - 1e-6, n, {-1.0, 1.0, 0.0})).norm();
  EXPECT_GT(inside, 0.0);
  EXPECT_LT(inside, 1e-4);
}

TEST(VelocityAwareFieldTest, ChangesLittleWhereTheVelocityDoes) {
  const Vector3d n = Vector3d::UnitX();
  for (const Vector3d& v : {Vector3d(-1e-9, 1.0, 0.0), Vector3d(-1e-9, 0.0, 0.0)}) {
    EXPECT_LT(ForceIn(At(0.05, n, v)).norm(), 1e-5);  // next to nothing, as at rest or in passing
  }
}

TEST(VelocityAwareFieldTest, StaysFiniteAndOutwardAtContactAndInDeepPenetration) {
  const Vector3d n(0.0, 0.6, -0.8);
  const Vector3d v(0.3, -0.5, 0.2);
  const Vector3d floor = ForceIn(At(0.01, n, v));
  for (const double distance : {0.0, -1e-9, -0.1, -1.0}) {
    const Vector3d force = ForceIn(At(distance, n, v));
    EXPECT_EQ(force, floor);
    EXPECT_GT(force.dot(n), 0.0);
  }
}

TEST(VelocityAwareFieldTest, OnlyTheRelativeVelocityCounts) {
  Scene scene = At(0.3, Vector3d::UnitX(), {-0.4, 0.2, 0.1});
  const Vector3d alone = ForceIn(scene);
  const Vector3d wind(3.0, -2.0, 1.0);
  scene.links.velocities[0].linear += wind;
  scene.proximities.proximities[0].obstacle_velocity = wind;
  EXPECT_NEAR((ForceIn(scene) - alone).norm(), 0.0, 1e-12);
  scene.links.velocities[0].linear = wind;
  EXPECT_EQ(ForceIn(scene).norm(), 0.0);
}

TEST(VelocityAwareFieldTest, MovingTheWorldMovesTheForceAndAMirrorMirrorsIt) {
  const Vector3d n = Vector3d(1.0, 2.0, -1.0).normalized();
  const Vector3d v(-0.6, 0.1, 0.7);
  const Vector3d force = ForceIn(At(0.2, n, v));
  const Eigen::Matrix3d R = Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5).normalized().toRotationMatrix();
  EXPECT_NEAR((ForceIn(At(0.2, R * n, R * v)) - R * force).norm(), 0.0, 1e-12);
  const Eigen::Matrix3d M = Vector3d(1.0, -1.0, 1.0).asDiagonal();
  EXPECT_NEAR((ForceIn(At(0.2, M * n, M * v)) - M * force).norm(), 0.0, 1e-12);
}

// Two links of one arm: the other link's own velocity is the obstacle's.
TEST(VelocityAwareFieldTest, AnOwnLinkMovesWithItsPose) {
  Scene scene = At(0.2, Vector3d::UnitX(), Vector3d::Zero());
  scene.links.links.push_back(models::Name("other"));
  scene.links.poses.push_back(Eigen::Isometry3d::Identity());
  scene.links.bodies.push_back(1);
  scene.links.velocities.push_back({{0.5, 0.0, 0.0}, Vector3d::Zero()});
  EXPECT_EQ(ForceIn(scene).norm(), 0.0);
  scene.proximities.proximities[0].own_link = models::Name("other");
  EXPECT_EQ(ForceIn(scene), ForceIn(At(0.2, Vector3d::UnitX(), {-0.5, 0.0, 0.0})));
}

TEST(VelocityAwareFieldTest, SlopesAreTheDerivativesOfTheForceOrMore) {
  const Vector3d n(0.6, 0.0, 0.8);
  const Vector3d v(-0.5, 0.4, -0.1);
  const Scene scene = At(0.25, n, v);
  SystemBench<VelocityAwareField> bench(Params{});
  bench->proximities.Fix(bench.context(), scene.proximities);
  bench->links.Fix(bench.context(), scene.links);
  const ContactSlope slope = bench->slopes.Eval(bench.context()).slopes.at(0);
  constexpr double kStep = 1e-6;
  const VelocityAwareField& field = bench.system();
  const Vector3d by_distance =
      (field.Force(0.25 - kStep, n, v) - field.Force(0.25 + kStep, n, v)) / (2.0 * kStep);
  EXPECT_NEAR((slope.slope - by_distance).norm(), 0.0, 1e-6 * by_distance.norm());
  for (double along = -1.0; along < 0.0; along += 0.05) {
    const Vector3d u = Vector3d(0.0, 0.3, 0.0) + along * n;
    const double by_rate =
        n.dot(field.Force(0.25, n, u - kStep * n) - field.Force(0.25, n, u + kStep * n)) /
        (2.0 * kStep);
    EXPECT_LE(by_rate, n.dot(slope.damping) * (1.0 + 1e-6)) << along;
  }
}

TEST(VelocityAwareFieldTest, RefusesWhatItCannotUse) {
  EXPECT_THROW(VelocityAwareField({.exponent = 1.99}), ConfigError);
  EXPECT_NO_THROW(VelocityAwareField({.exponent = 2.0}));
  EXPECT_THROW(VelocityAwareField({.velocity_gain = -1e-9}), ConfigError);
  EXPECT_THROW(VelocityAwareField({.max_distance = 0.1, .min_distance = 0.1}), ConfigError);
  Scene still = At(0.3, Vector3d::UnitX(), Vector3d::Zero());
  still.links.velocities.clear();
  EXPECT_THROW(ForceIn(still), std::runtime_error);
  Scene stranger = At(0.3, Vector3d::UnitX(), Vector3d::Zero());
  stranger.proximities.proximities[0].link = models::Name("nobody");
  EXPECT_THROW(ForceIn(stranger), std::runtime_error);
}

}  // namespace velocity_aware_field_test
}  // namespace oca::systems
