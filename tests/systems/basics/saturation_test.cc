// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/saturation.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace saturation_test {

double Saturated(const Saturation::Params& params, double x) {
  SystemBench<Saturation> bench(params);
  bench->in.Fix(bench.context(), Eigen::VectorXd::Constant(1, x));
  return bench->out.Eval(bench.context())[0];
}

TEST(SaturationTest, PassesWhatIsWithinAndCutsWhatIsBeyond) {
  const Saturation::Params params{.lower = -1.0, .upper = 2.0};
  const double expected[][2] = {{-1.001, -1.0}, {-1.0, -1.0}, {-0.999, -0.999},
                                {1.999, 1.999}, {2.0, 2.0},   {2.001, 2.0}};
  for (const auto& [x, y] : expected) EXPECT_EQ(Saturated(params, x), y);
}

TEST(SaturationTest, OneBoundLeavesTheOtherSideFree) {
  EXPECT_EQ(Saturated({.upper = 1.0}, -1e300), -1e300);
  EXPECT_EQ(Saturated({.lower = 1.0}, 1e300), 1e300);
}

TEST(SaturationTest, CutsEachComponentAtItsOwnBound) {
  SystemBench<Saturation> bench(
      Saturation::Params{.lower = 0.0, .upper = Eigen::VectorXd(Eigen::Vector2d(1.0, 2.0))});
  bench->in.Fix(bench.context(), Eigen::Vector2d(3.0, 3.0));
  EXPECT_EQ(Eigen::Vector2d(bench->out.Eval(bench.context())), Eigen::Vector2d(1.0, 2.0));
}

TEST(SaturationTest, RefusesBoundsInTheWrongOrder) {
  EXPECT_THROW(Saturation({.lower = 1.0, .upper = 0.999}), ConfigError);
  EXPECT_NO_THROW(Saturation({.lower = 1.0, .upper = 1.0}));
  EXPECT_THROW(Saturation({.lower = std::numeric_limits<double>::quiet_NaN()}), ConfigError);
}

}  // namespace saturation_test
}  // namespace oca::systems
