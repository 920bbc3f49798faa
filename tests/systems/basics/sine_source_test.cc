// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/sine_source.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace sine_source_test {

TEST(SineSourceTest, OscillatesAroundItsOffset) {
  // 10 + 2 sin(2 pi 0.5 t + pi / 6)
  SystemBench<SineSource> bench(SineSource::Params{
      .amplitude = 2.0, .frequency = 0.5, .phase = std::numbers::pi / 6.0, .offset = 10.0});
  const double expected[][2] = {{0.0, 11.0}, {1.0 / 3.0, 12.0}, {1.0, 9.0}, {2.0, 11.0}};
  for (const auto& [time, value] : expected) {
    bench.AdvanceTo(time);
    EXPECT_NEAR(bench->value.Eval(bench.context())[0], value, 1e-14) << time;
  }
}

TEST(SineSourceTest, RefusesListsOfDifferentLengthAndNaN) {
  EXPECT_THROW(SineSource({.amplitude = Eigen::VectorXd(Eigen::Vector2d::Ones()),
                           .phase = Eigen::VectorXd(Eigen::Vector3d::Ones())}),
               ConfigError);
  EXPECT_THROW(SineSource({.frequency = std::numeric_limits<double>::quiet_NaN()}), ConfigError);
}

}  // namespace sine_source_test
}  // namespace oca::systems
