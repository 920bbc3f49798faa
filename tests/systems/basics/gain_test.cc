// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/gain.h"

#include <gtest/gtest.h>

#include <limits>
#include <type_traits>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/integrator.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace gain_test {

TEST(GainTest, MultipliesEveryComponentByAScalar) {
  SystemBench<Gain> bench(Gain::Params{.gain = -2.0});
  bench->in.Fix(bench.context(), Eigen::VectorXd::Constant(1, 3.0));
  EXPECT_EQ(bench->out.Eval(bench.context())[0], -6.0);
}

TEST(GainTest, MultipliesEachComponentByItsOwnFactor) {
  SystemBench<Gain> bench(Gain::Params{.gain = Eigen::VectorXd(Eigen::Vector3d(1.0, 0.0, -0.5))});
  bench->in.Fix(bench.context(), Eigen::Vector3d(4.0, 5.0, 6.0));
  EXPECT_EQ(Eigen::Vector3d(bench->out.Eval(bench.context())), Eigen::Vector3d(4.0, 0.0, -3.0));
}

TEST(GainTest, TakesAnyColumnOfNumbersInBraces) {
  DiagramBuilder builder;
  const auto& fixed = builder.Add<Gain>("fixed", {.gain = Eigen::Vector3d(1.0, 2.0, 3.0)});
  const auto& zero = builder.Add<Gain>("zero", {.gain = Eigen::VectorXd::Zero(3)});
  const auto& one = builder.Add<Gain>("one");
  const auto& sum = builder.Add<Integrator>("sum");
  builder.ExportInput("in", fixed.in);
  builder.ExportInput("in", zero.in);
  builder.Connect(fixed.out, one.in);
  builder.Connect(one.out, sum.in);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("in").Fix(context, Eigen::Vector3d(4.0, 5.0, 6.0));
  EXPECT_EQ(Eigen::Vector3d(one.out.Eval(context)), Eigen::Vector3d(4.0, 10.0, 18.0));
  EXPECT_EQ(Eigen::Vector3d(zero.out.Eval(context)), Eigen::Vector3d::Zero());
  EXPECT_EQ(sum.out.Eval(context).size(), 3);
  static_assert(!std::is_constructible_v<PerComponent, Eigen::Matrix2d>);
}

TEST(GainTest, RefusesAnInputOfAnotherLength) {
  SystemBench<Gain> bench(Gain::Params{.gain = Eigen::VectorXd(Eigen::Vector2d(1.0, 2.0))});
  EXPECT_THROW(bench->in.Fix(bench.context(), Eigen::Vector3d::Ones()), ConfigError);
}

TEST(GainTest, RefusesAGainThatIsNotFinite) {
  EXPECT_THROW(Gain({.gain = std::numeric_limits<double>::quiet_NaN()}), ConfigError);
}

}  // namespace gain_test
}  // namespace oca::systems
