// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/attractive_field.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace attractive_field_test {

AttractiveField::Params Pull() {
  AttractiveField::Params params;
  params.link = "hand";
  params.target = {1.0, 0.0, 0.0};
  params.gain = 5.0;
  params.saturation_distance = 0.2;
  return params;
}

LinkPoses HandAt(const Eigen::Vector3d& position) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position;
  return {{models::Name("hand")}, {pose}, {0}};
}

Eigen::Vector3d ForceAt(SystemBench<AttractiveField>& bench, const Eigen::Vector3d& position) {
  bench->links.Fix(bench.context(), HandAt(position));
  return bench->forces.Eval(bench.context()).forces.at(0).force;
}

TEST(AttractiveFieldTest, PullsTowardsTheTargetInProportionToTheDistance) {
  SystemBench<AttractiveField> bench(Pull());
  EXPECT_NEAR((ForceAt(bench, {0.9, 0.0, 0.1}) - Eigen::Vector3d(0.5, 0.0, -0.5)).norm(), 0.0,
              1e-15);
  EXPECT_EQ(ForceAt(bench, {1.0, 0.0, 0.0}), Eigen::Vector3d::Zero());
}

TEST(AttractiveFieldTest, PullsNoHarderBeyondTheSaturationDistance) {
  SystemBench<AttractiveField> bench(Pull());
  EXPECT_NEAR(ForceAt(bench, {0.8001, 0.0, 0.0}).x(), 0.9995, 1e-12);
  EXPECT_NEAR(ForceAt(bench, {0.7999, 0.0, 0.0}).x(), 1.0, 1e-12);
  EXPECT_NEAR((ForceAt(bench, {1.0, 3.0, 4.0}) - Eigen::Vector3d(0.0, -0.6, -0.8)).norm(), 0.0,
              1e-15);
}

TEST(AttractiveFieldTest, IsMinusTheGradientOfThePotential) {
  SystemBench<AttractiveField> bench(Pull());
  const auto potential = [](const Eigen::Vector3d& x) {  // eq. (2.2), conic beyond 0.2 m
    const double d = (x - Eigen::Vector3d(1.0, 0.0, 0.0)).norm();
    return d <= 0.2 ? 0.5 * 5.0 * d * d : 5.0 * 0.2 * (d - 0.1);
  };
  for (const Eigen::Vector3d& x :
       {Eigen::Vector3d(0.9, 0.05, 0.1), Eigen::Vector3d(0.3, -1.0, 2.0)}) {
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(axis);
      const double slope = (potential(x + step) - potential(x - step)) / 2e-6;
      EXPECT_NEAR(ForceAt(bench, x)[axis], -slope, 1e-8);
    }
  }
}

TEST(AttractiveFieldTest, PullsAtAPointFixedToTheLink) {
  AttractiveField::Params params = Pull();
  params.point = {0.0, 0.0, 0.1};
  SystemBench<AttractiveField> bench(params);
  LinkPoses links = HandAt({1.0, 0.0, 0.0});
  // Turned by a quarter about y, the point stands 0.1 m off along x.
  links.poses[0].linear() =
      Eigen::AngleAxisd(std::acos(0.0), Eigen::Vector3d::UnitY()).toRotationMatrix();
  bench->links.Fix(bench.context(), links);
  const LinkForce force = bench->forces.Eval(bench.context()).forces.at(0);
  EXPECT_EQ(force.link, models::Name("hand"));
  EXPECT_NEAR((force.point - Eigen::Vector3d(1.1, 0.0, 0.0)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((force.force - Eigen::Vector3d(-0.5, 0.0, 0.0)).norm(), 0.0, 1e-15);
}

TEST(AttractiveFieldTest, RefusesToRunWithoutAPoseOfItsLink) {
  SystemBench<AttractiveField> bench(Pull());
  LinkPoses links = HandAt(Eigen::Vector3d::Zero());
  links.links[0] = models::Name("foot");
  bench->links.Fix(bench.context(), links);
  EXPECT_THROW(bench->forces.Eval(bench.context()), SimulationError);
}

TEST(AttractiveFieldTest, RefusesParametersThatMakeNoField) {
  const auto with = [](auto change) {
    AttractiveField::Params params = Pull();
    change(params);
    return params;
  };
  using Params = AttractiveField::Params;
  EXPECT_THROW(AttractiveField(with([](Params& p) { p.link.clear(); })), ConfigError);
  EXPECT_THROW(AttractiveField(with([](Params& p) { p.gain = -1.0; })), ConfigError);
  EXPECT_THROW(AttractiveField(with([](Params& p) { p.saturation_distance = 0.0; })), ConfigError);
  EXPECT_THROW(AttractiveField(
                   with([](Params& p) { p.target.x() = std::numeric_limits<double>::infinity(); })),
               ConfigError);
  EXPECT_NO_THROW(AttractiveField(with([](Params& p) { p.gain = 0.0; })));
}

}  // namespace attractive_field_test
}  // namespace oca::systems
