// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/repulsive_law.h"

#include <gtest/gtest.h>

#include <cmath>

namespace oca::robot {
namespace repulsive_law_test {

// Golden values of eq. (3.1) with eta = 1, rho0 = 0.3.
TEST(RepulsiveLawTest, GivesTheForceOfEquation31) {
  const RepulsiveLaw law{1.0, 0.3, 0.01};
  EXPECT_EQ(law.Force(0.3), 0.0);
  EXPECT_NEAR(law.Force(0.25), 10.6667, 1e-4);
  EXPECT_NEAR(law.Force(0.2), 41.6667, 1e-4);
  EXPECT_NEAR(law.Force(0.1), 666.667, 1e-3);
  EXPECT_NEAR(law.Force(0.05), 6666.67, 1e-2);
  EXPECT_NEAR(law.Force(0.01), 966666.67, 1e-2);
}

TEST(RepulsiveLawTest, TheSlopeIsTheDerivativeOfTheForceAndThatOfTheFloorBelowIt) {
  const RepulsiveLaw law{2.0, 0.3, 0.01};
  for (const double rho : {0.011, 0.05, 0.2, 0.2999}) {
    constexpr double kStep = 1e-7;
    const double numeric = (law.Force(rho - kStep) - law.Force(rho + kStep)) / (2.0 * kStep);
    EXPECT_NEAR(law.Slope(rho), numeric, 1e-5 * numeric) << rho;
  }
  EXPECT_NEAR(law.Slope(0.3), 2.0 / std::pow(0.3, 4), 1e-9);
  EXPECT_EQ(law.Slope(0.3000001), 0.0);
  EXPECT_EQ(law.Slope(-0.5), law.Slope(0.01));
}

TEST(RepulsiveLawTest, StaysFiniteAndOutwardFromTheFloorIntoPenetration) {
  const RepulsiveLaw law{1.0, 0.3, 0.01};
  const double largest = law.Force(0.01);
  for (const double distance : {0.0099, 0.0, -1e-9, -0.2}) {
    EXPECT_EQ(law.Force(distance), largest);
  }
  EXPECT_LT(law.Force(0.0101), largest);
  EXPECT_NEAR(law.Force(0.01 + 1e-12), largest, 1e-3);  // slope -3e8 N/m: continuous
}

TEST(RepulsiveLawTest, IsMinusTheSlopeOfThePotential) {
  const RepulsiveLaw law{2.0, 0.4, 0.01};
  const auto potential = [](double rho) {  // eq. (2.3)
    const double root = 1.0 / rho - 1.0 / 0.4;
    return 0.5 * 2.0 * root * root;
  };
  for (const double rho : {0.02, 0.1, 0.25, 0.39}) {
    constexpr double kStep = 1e-6;
    const double slope = (potential(rho + kStep) - potential(rho - kStep)) / (2.0 * kStep);
    EXPECT_NEAR(law.Force(rho), -slope, 1e-6 * std::fabs(slope) + 1e-6) << rho;
  }
}

}  // namespace repulsive_law_test
}  // namespace oca::robot
