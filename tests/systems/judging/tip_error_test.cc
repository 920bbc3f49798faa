// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/judging/tip_error.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace tip_error_test {

TipError::Params Hand() {
  TipError::Params params;
  params.link = "hand";
  params.pose.xyz = {1.0, 2.0, 3.0};
  params.pose.rpy = Eigen::Vector3d(0.0, 0.0, 0.5);
  return params;
}

LinkPoses HandAt(const Eigen::Vector3d& position, double yaw) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = position;
  pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return {{models::Name("hand")}, {pose}, {0}};
}

TEST(TipErrorTest, IsTheDistanceAndTheAngleToThePose) {
  SystemBench<TipError> bench(Hand());
  bench->links.Fix(bench.context(), HandAt({1.0, 2.3, 3.4}, -0.25));
  EXPECT_NEAR(bench->position_error.Eval(bench.context())[0], 0.5, 1e-15);
  EXPECT_NEAR(bench->rotation_error.Eval(bench.context())[0], 0.75, 1e-15);
  EXPECT_EQ(bench->position.Eval(bench.context()), Eigen::Vector3d(1.0, 2.3, 3.4));
  bench->links.Fix(bench.context(), HandAt({1.0, 2.0, 3.0}, 0.5));
  EXPECT_NEAR(bench->position_error.Eval(bench.context())[0], 0.0, 1e-15);
  EXPECT_NEAR(bench->rotation_error.Eval(bench.context())[0], 0.0, 1e-15);
}

TEST(TipErrorTest, RefusesNoNameAWrongPoseAndALinkThatDoesNotComeIn) {
  TipError::Params params = Hand();
  params.link = "";
  EXPECT_THROW(TipError{params}, ConfigError);
  params = Hand();
  params.pose.xyz.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(TipError{params}, ConfigError);
  params = Hand();
  params.link = "foot";
  SystemBench<TipError> bench(params);
  bench->links.Fix(bench.context(), HandAt({1.0, 2.0, 3.0}, 0.5));
  EXPECT_ANY_THROW(bench->position.Eval(bench.context()));
}

}  // namespace tip_error_test
}  // namespace oca::systems
