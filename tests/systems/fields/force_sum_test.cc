// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/force_sum.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace force_sum_test {

LinkForceSet Forces(std::initializer_list<double> along_x) {
  LinkForceSet set;
  for (const double x : along_x) {
    set.forces.push_back(
        {models::Name("link"), models::Name("box"), {x, 0.0, 0.0}, Eigen::Vector3d::Zero()});
  }
  return set;
}

TEST(ForceSumTest, ListsTheForcesOfBothFieldsTheFirstOnesFirst) {
  SystemBench<ForceSum> bench(ForceSum::Params{});
  bench->forces0.Fix(bench.context(), Forces({1.0}));
  bench->forces1.Fix(bench.context(), Forces({2.0, 3.0}));
  const LinkForceSet& sum = bench->forces.Eval(bench.context());
  ASSERT_EQ(sum.forces.size(), 3u);
  EXPECT_EQ(sum.forces[0].force.x(), 1.0);
  EXPECT_EQ(sum.forces[1].force.x(), 2.0);
  EXPECT_EQ(sum.forces[2].force.x(), 3.0);
}

TEST(ForceSumTest, ForgetsForcesThatAreGone) {
  SystemBench<ForceSum> bench(ForceSum::Params{});
  bench->forces0.Fix(bench.context(), Forces({1.0, 2.0}));
  bench->forces1.Fix(bench.context(), Forces({3.0}));
  EXPECT_EQ(bench->forces.Eval(bench.context()).forces.size(), 3u);
  bench->forces0.Fix(bench.context(), Forces({}));
  const LinkForceSet& sum = bench->forces.Eval(bench.context());
  ASSERT_EQ(sum.forces.size(), 1u);
  EXPECT_EQ(sum.forces[0].force.x(), 3.0);
}

TEST(ForceSumTest, RefusesToRunWithOneFieldOnly) {
  DiagramBuilder builder;
  const auto& sum = builder.Add<ForceSum>("sum", ForceSum::Params{});
  builder.ExportInput("forces0", sum.forces0);
  EXPECT_THROW(builder.Build(), WiringError);
}

}  // namespace force_sum_test
}  // namespace oca::systems
