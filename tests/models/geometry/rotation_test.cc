// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/rotation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "oca/models/error.h"

namespace oca::geometry {
namespace rotation_test {

using Eigen::Vector3d;
using Eigen::Vector4d;
using ::testing::HasSubstr;

constexpr double kQuarter = std::numbers::pi / 2.0;

TEST(RotationTest, RollsThenPitchesThenYawsAboutFixedAxes) {
  // A quarter turn about x takes y to z; the yaw then leaves z where it is.
  const Eigen::Quaterniond R = FromRollPitchYaw({kQuarter, 0.0, kQuarter});
  EXPECT_LT((R * Vector3d::UnitY() - Vector3d::UnitZ()).norm(), 1e-15);
  EXPECT_LT((R * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-15);
  const Eigen::Quaterniond pitch = FromRollPitchYaw({0.0, kQuarter, 0.0});
  EXPECT_LT((pitch * Vector3d::UnitZ() - Vector3d::UnitX()).norm(), 1e-15);
}

TEST(RotationTest, TakesUnitsRoundedToThreeDigitsAndNoOthers) {
  EXPECT_DOUBLE_EQ(FromQuaternion({0.0, 0.0, 0.707, 0.707}, "here").norm(), 1.0);
  EXPECT_DOUBLE_EQ(CheckedUnitVector({0.577, 0.577, 0.577}, "here").norm(), 1.0);
  EXPECT_NO_THROW(FromQuaternion(Vector4d(0.0, 0.0, 0.0, 1.0009), "here"));
  EXPECT_THROW(FromQuaternion(Vector4d(0.0, 0.0, 0.0, 1.0011), "here"), models::ModelError);
  EXPECT_NO_THROW(CheckedUnitVector({0.9991, 0.0, 0.0}, "here"));
  try {
    CheckedUnitVector({0.9989, 0.0, 0.0}, "here");
    FAIL() << "was accepted";
  } catch (const models::ModelError& error) {
    EXPECT_THAT(error.what(), HasSubstr("here: length; got 0.9989; expected 1, a unit vector"));
  }
}

}  // namespace rotation_test
}  // namespace oca::geometry
