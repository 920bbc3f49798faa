// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/repulsive_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace repulsive_field_test {

ProximitySet At(double distance, const Eigen::Vector3d& normal = Eigen::Vector3d::UnitZ()) {
  Proximity proximity;
  proximity.link = models::Name("link");
  proximity.obstacle = models::Name("box");
  proximity.distance = distance;
  proximity.point_on_link = {0.1, 0.2, 0.3};
  proximity.normal = normal;
  return {{proximity}};
}

TEST(RepulsiveFieldTest, PushesAlongTheNormalAtThePointOnTheLink) {
  SystemBench<RepulsiveField> bench(RepulsiveField::Params{.force_gain = 3.0});
  bench->proximities.Fix(bench.context(), At(0.2, {0.0, 0.6, -0.8}));
  const LinkForceSet& forces = bench->forces.Eval(bench.context());
  ASSERT_EQ(forces.forces.size(), 1u);
  EXPECT_EQ(forces.forces[0].link, models::Name("link"));
  EXPECT_EQ(forces.forces[0].obstacle, models::Name("box"));
  EXPECT_NEAR((forces.forces[0].force - 125.0 * Eigen::Vector3d(0.0, 0.6, -0.8)).norm(), 0.0,
              1e-12);
  EXPECT_EQ(forces.forces[0].point, Eigen::Vector3d(0.1, 0.2, 0.3));
}

TEST(RepulsiveFieldTest, IsZeroFromTheLimitDistanceOutwards) {
  SystemBench<RepulsiveField> bench(RepulsiveField::Params{});
  for (const double distance : {0.3, 0.3000001, 5.0}) {
    bench->proximities.Fix(bench.context(), At(distance));
    const LinkForceSet& forces = bench->forces.Eval(bench.context());
    ASSERT_EQ(forces.forces.size(), 1u);
    EXPECT_EQ(forces.forces[0].force, Eigen::Vector3d::Zero());
  }
  bench->proximities.Fix(bench.context(), At(0.2999999));
  EXPECT_GT(bench->forces.Eval(bench.context()).forces.at(0).force.z(), 0.0);
}

ProximitySet OwnAt(double distance, double range) {
  ProximitySet set = At(distance);
  set.proximities[0].own_link = models::Name("other");
  set.proximities[0].range = range;
  return set;
}

// With a third of the field's range for these links, they see its forces at a third of the
// distances.
TEST(RepulsiveFieldTest, OfOwnLinksBeginsAtTheirRange) {
  SystemBench<RepulsiveField> bench(RepulsiveField::Params{});
  const auto force = [&](const ProximitySet& set) {
    bench->proximities.Fix(bench.context(), set);
    return bench->forces.Eval(bench.context()).forces.at(0).force.z();
  };
  for (const double rho : {0.25, 0.1, 0.02, 0.0, -0.1}) {
    EXPECT_NEAR(force(OwnAt(rho / 3.0, 0.1)), force(At(rho)), 1e-9 * force(At(rho))) << rho;
  }
  EXPECT_GT(force(OwnAt(0.0999, 0.1)), 0.0);
  EXPECT_EQ(force(OwnAt(0.1001, 0.1)), 0.0);
  EXPECT_EQ(force(OwnAt(0.2, 0.7)), force(At(0.2))) << "a range beyond the field's";
  constexpr double kStep = 1e-8;
  for (const double rho : {0.02, 0.08}) {
    const double numeric =
        (force(OwnAt(rho - kStep, 0.1)) - force(OwnAt(rho + kStep, 0.1))) / (2.0 * kStep);
    bench->proximities.Fix(bench.context(), OwnAt(rho, 0.1));
    const ContactSlopes& slopes = bench->slopes.Eval(bench.context());
    ASSERT_EQ(slopes.slopes.size(), 1u);
    EXPECT_NEAR(slopes.slopes[0].slope.z(), numeric, 1e-5 * numeric);
  }
  bench->proximities.Fix(bench.context(), OwnAt(0.1001, 0.1));
  EXPECT_TRUE(bench->slopes.Eval(bench.context()).slopes.empty());
}

TEST(RepulsiveFieldTest, GivesOneForceAProximityInTheirOrder) {
  SystemBench<RepulsiveField> bench(RepulsiveField::Params{});
  ProximitySet set = At(0.2);
  set.proximities.push_back(At(1.0).proximities[0]);
  set.proximities.push_back(At(0.1).proximities[0]);
  bench->proximities.Fix(bench.context(), set);
  const LinkForceSet& forces = bench->forces.Eval(bench.context());
  ASSERT_EQ(forces.forces.size(), 3u);
  EXPECT_NEAR(forces.forces[0].force.z(), 41.6667, 1e-4);
  EXPECT_EQ(forces.forces[1].force.z(), 0.0);
  EXPECT_NEAR(forces.forces[2].force.z(), 666.667, 1e-3);
  bench->proximities.Fix(bench.context(), ProximitySet{});
  EXPECT_TRUE(bench->forces.Eval(bench.context()).forces.empty());
}

TEST(RepulsiveFieldTest, RefusesDistancesAndGainsThatMakeNoField) {
  using Params = RepulsiveField::Params;
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(RepulsiveField(Params{.force_gain = -1.0}), ConfigError);
  EXPECT_THROW(RepulsiveField(Params{.force_gain = kNaN}), ConfigError);
  EXPECT_THROW(RepulsiveField(Params{.max_distance = 0.0}), ConfigError);
  EXPECT_THROW(RepulsiveField(Params{.min_distance = 0.0}), ConfigError);
  EXPECT_THROW(RepulsiveField(Params{.max_distance = 0.1, .min_distance = 0.1}), ConfigError);
  EXPECT_NO_THROW(RepulsiveField(Params{.max_distance = 0.1, .min_distance = 0.0999}));
  EXPECT_NO_THROW(RepulsiveField(Params{.force_gain = 0.0}));
}

}  // namespace repulsive_field_test
}  // namespace oca::systems
