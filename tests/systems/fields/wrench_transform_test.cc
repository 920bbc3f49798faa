// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/wrench_transform.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace wrench_transform_test {

Eigen::Isometry3d PoseAt(double x, double y, double z) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

/// A base that cannot move, an arm on a joint at (0, 0, 1), and a tool fixed to the arm.
LinkPoses Arm() {
  return {{models::Name("base"), models::Name("arm"), models::Name("tool")},
          {PoseAt(0, 0, 0), PoseAt(0, 0, 1), PoseAt(5, 0, 1)},
          {-1, 1, 1}};
}

LinkForce On(const char* link, const Eigen::Vector3d& force, const Eigen::Vector3d& point) {
  return {models::Name(link), models::Name("box"), force, point};
}

TEST(WrenchTransformTest, MovesAForceToTheOriginOfItsLink) {
  SystemBench<WrenchTransform> bench(WrenchTransform::Params{});
  bench->links.Fix(bench.context(), Arm());
  bench->forces.Fix(bench.context(), LinkForceSet{{On("arm", {1, 2, 3}, {0.1, 0.2, 0.3})}});
  const WrenchSet& wrenches = bench->wrenches.Eval(bench.context());
  ASSERT_EQ(wrenches.wrenches.size(), 1u);
  EXPECT_EQ(wrenches.wrenches[0].link, models::Name("arm"));
  EXPECT_EQ(wrenches.wrenches[0].force, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR((wrenches.wrenches[0].torque - Eigen::Vector3d(2, -1, 0)).norm(), 0.0, 1e-15);
  EXPECT_EQ(wrenches.wrenches[0].origin, Eigen::Vector3d(0, 0, 1));
}

TEST(WrenchTransformTest, AddsUpTheWrenchesOfABodyAndOfTheLinksFixedToIt) {
  SystemBench<WrenchTransform> bench(WrenchTransform::Params{});
  bench->links.Fix(bench.context(), Arm());
  bench->forces.Fix(bench.context(),
                    LinkForceSet{{On("tool", {0, 1, 0}, {5, 0, 1}), On("arm", {0, 1, 0}, {2, 0, 1}),
                                  On("arm", {0, 0, 1}, {0, 0, 1})}});
  const WrenchSet& wrenches = bench->wrenches.Eval(bench.context());
  ASSERT_EQ(wrenches.wrenches.size(), 1u);
  EXPECT_EQ(wrenches.wrenches[0].link, models::Name("arm"));
  EXPECT_EQ(wrenches.wrenches[0].force, Eigen::Vector3d(0, 2, 1));
  EXPECT_EQ(wrenches.wrenches[0].torque, Eigen::Vector3d(0, 0, 7));
  EXPECT_EQ(wrenches.wrenches[0].origin, Eigen::Vector3d(0, 0, 1));
}

TEST(WrenchTransformTest, LeavesOutLinksThatCannotMove) {
  SystemBench<WrenchTransform> bench(WrenchTransform::Params{});
  bench->links.Fix(bench.context(), Arm());
  bench->forces.Fix(bench.context(), LinkForceSet{{On("base", {1, 2, 3}, {0, 0, 0})}});
  EXPECT_TRUE(bench->wrenches.Eval(bench.context()).wrenches.empty());
}

TEST(WrenchTransformTest, OffersTheWrenchInTheFrameOfTheLink) {
  SystemBench<WrenchTransform> bench(WrenchTransform::Params{});
  LinkPoses links = Arm();
  // The link's x axis points along the world's y axis.
  links.poses[1].linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  bench->links.Fix(bench.context(), links);
  bench->forces.Fix(bench.context(), LinkForceSet{{On("arm", {1, 2, 3}, {0.1, 0.2, 0.3})}});
  const WrenchSet& in_link = bench->wrenches_in_link.Eval(bench.context());
  ASSERT_EQ(in_link.wrenches.size(), 1u);
  EXPECT_EQ(in_link.wrenches[0].link, models::Name("arm"));
  EXPECT_NEAR((in_link.wrenches[0].force - Eigen::Vector3d(2, -1, 3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((in_link.wrenches[0].torque - Eigen::Vector3d(-1, -2, 0)).norm(), 0.0, 1e-15);
  EXPECT_EQ(in_link.wrenches[0].origin, Eigen::Vector3d::Zero());
}

TEST(WrenchTransformTest, RefusesAForceOnALinkWithoutAPose) {
  SystemBench<WrenchTransform> bench(WrenchTransform::Params{});
  bench->links.Fix(bench.context(), Arm());
  bench->forces.Fix(bench.context(), LinkForceSet{{On("leg", {1, 2, 3}, {0, 0, 0})}});
  EXPECT_THROW(bench->wrenches.Eval(bench.context()), SimulationError);
}

}  // namespace wrench_transform_test
}  // namespace oca::systems
