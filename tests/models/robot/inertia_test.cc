// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/inertia.h"

#include <gmock/gmock.h>

namespace oca::robot::test {
namespace inertia_test {

using testing::HasSubstr;

std::string Why(double a, double b, double c, double mass = 1.0) {
  return ImpossibleInertia(
      {mass, Eigen::Vector3d::Zero(), Eigen::Vector3d(a, b, c).asDiagonal().toDenseMatrix()});
}

TEST(InertiaTest, ABodyCanHaveThoseOnTheBound) {
  EXPECT_EQ(Why(0.1, 0.1, 0.0), "");       // a thin rod, which has none about its axis
  EXPECT_EQ(Why(0.0, 0.0, 0.0), "");       // a point
  EXPECT_EQ(Why(0.1, 0.2, 0.3), "");       // a plate
  EXPECT_EQ(Why(0.1, 0.2, 0.3005), "");    // as files round
  EXPECT_EQ(Why(0.1, 0.1, 9.0, 0.0), "");  // without mass nothing is known
}

TEST(InertiaTest, NoBodyHasOneMomentAboveTheOthersOrBelowZero) {
  EXPECT_THAT(Why(0.1, 0.2, 0.31), HasSubstr("0.1, 0.2, 0.31 kg m^2, the last above the sum"));
  EXPECT_THAT(Why(0.1, 0.1, -0.01), HasSubstr("one below 0"));
  Inertia ball{1.0, Eigen::Vector3d::Zero(), 0.01 * Eigen::Matrix3d::Identity()};
  EXPECT_EQ(ImpossibleInertia(ball), "");
  ball.I_C(0, 1) = ball.I_C(1, 0) = 0.02;  // so large that a principal moment is negative
  EXPECT_THAT(ImpossibleInertia(ball), HasSubstr("one below 0"));
}

}  // namespace inertia_test
}  // namespace oca::robot::test
