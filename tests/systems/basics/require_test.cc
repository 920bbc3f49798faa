// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/require.h"

#include <gtest/gtest.h>

#include <functional>

#include "oca/framework/dataflow/error.h"

namespace oca::systems {
namespace require_test {

std::string Refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RequireTest, NamesTheParameterAndTheNumber) {
  EXPECT_EQ(Refusal([] { RequireAbove("speed", -1.5, 0.0); }),
            "speed: too small; got -1.5; expected > 0");
  EXPECT_EQ(Refusal([] { RequireAtLeast("speed", -1.5, 0.0); }),
            "speed: too small; got -1.5; expected >= 0");
}

TEST(RequireTest, DrawsTheLineAtTheBound) {
  EXPECT_NO_THROW(RequireAtLeast("x", 0.0, 0.0));
  EXPECT_THROW(RequireAbove("x", 0.0, 0.0), ConfigError);
  EXPECT_NO_THROW(RequireAbove("x", 1e-300, 0.0));
}

TEST(RequireTest, ComparesBoundsComponentByComponent) {
  const PerComponent two(Eigen::VectorXd(Eigen::Vector2d(0.0, 1.0)));
  EXPECT_NO_THROW(RequireOrdered("lower", two, "upper", 1.0));
  EXPECT_EQ(Refusal([&] { RequireOrdered("lower", two, "upper", 0.5); }),
            "lower: above upper; got 1 and 0.5; expected lower <= upper");
  EXPECT_THROW(RequireOrdered("lower", two, "upper", Eigen::VectorXd(Eigen::Vector3d::Ones())),
               ConfigError);
}

TEST(RequireTest, TellsPeriodsApartAtZero) {
  EXPECT_NO_THROW(RequirePositive("period", Period(1, 1000000000)));
  EXPECT_THROW(RequirePositive("period", Period()), ConfigError);
}

TEST(RequireTest, GainsUseUpAtMostAllWithinAPeriod) {
  EXPECT_NO_THROW(RequireGain("gain", 100.0, Period(1, 100)));
  EXPECT_THROW(RequireGain("gain", 100.1, Period(1, 100)), ConfigError);
}

}  // namespace require_test
}  // namespace oca::systems
