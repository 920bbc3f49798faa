// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/velocity_aware_field.h"

#include <gtest/gtest.h>

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

// Head on, F = velocity_gain |v| (1/p^2 - 1/max_distance^2).
TEST(VelocityAwareFieldTest, ForceAndSlopesAreThoseOfItsLaw) {
  const Params params{.velocity_gain = 1.0, .exponent = 2.0, .max_distance = 0.6};
  Scene scene = At(0.3, Vector3d::UnitX(), {-1.0, 0.0, 0.0});
  const Vector3d by_hand(1.0 / 0.09 - 1.0 / 0.36, 0.0, 0.0);
  EXPECT_NEAR((ForceIn(scene, params) - by_hand).norm(), 0.0, 1e-12);
  EXPECT_EQ(ForceIn(At(0.6, Vector3d::UnitX(), {-1.0, 0.0, 0.0}), params).norm(), 0.0);
  // Of a pair whose range is half of max_distance, 0.15 m count as 0.3 m.
  scene.proximities.proximities[0].range = 0.3;
  scene.proximities.proximities[0].distance = 0.15;
  EXPECT_NEAR((ForceIn(scene, params) - by_hand).norm(), 0.0, 1e-12);
  SystemBench<VelocityAwareField> bench(params);
  bench->proximities.Fix(bench.context(), scene.proximities);
  bench->links.Fix(bench.context(), scene.links);
  const ContactSlope slope = bench->slopes.Eval(bench.context()).slopes.at(0);
  const robot::VelocityAwareLaw law{1.0, 2.0, 0.6, 0.01};
  const Vector3d n = Vector3d::UnitX();
  EXPECT_NEAR((slope.slope - 2.0 * law.Slope(0.3, n, -n)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((slope.damping - law.Damping(0.3) * n).norm(), 0.0, 1e-12);
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
