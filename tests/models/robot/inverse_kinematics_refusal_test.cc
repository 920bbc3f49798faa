// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <limits>
#include <span>
#include <string>

#include "oca/models/error.h"
#include "oca/models/robot/attach_objects.h"
#include "oca/models/robot/inverse_kinematics.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace inverse_kinematics_refusal_test {

using testing::HasSubstr;

RobotModel Arm(const std::string& name) {
  return LoadUrdf(ProductFile("robots/" + name + "/" + name + ".urdf"));
}

TEST(InverseKinematicsTest, RefusesWhatIsNotANumberOrNotPositive) {
  const RobotModel model = Arm("lwr4");
  const int tip = TipLink(model);
  const Eigen::VectorXd bent = Eigen::VectorXd::Constant(7, 0.5);
  const Eigen::Isometry3d X_WG = LinkPoses(model, bent)[tip];
  EXPECT_THROW(SolveInverseKinematics(model, tip, X_WG, Eigen::VectorXd::Zero(6), {}),
               models::ModelError);
  Eigen::VectorXd start = bent;
  start[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(SolveInverseKinematics(model, tip, X_WG, start, {}), models::ModelError);
  Eigen::Isometry3d lost = X_WG;
  lost.translation().x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(SolveInverseKinematics(model, tip, lost, bent, {}), models::ModelError);
  InverseKinematicsSettings settings;
  settings.starts = 0;
  EXPECT_THROW(SolveInverseKinematics(model, tip, X_WG, bent, settings), models::ModelError);
  settings = {};
  settings.clearance = -0.1;
  EXPECT_THROW(SolveInverseKinematics(model, tip, X_WG, bent, settings), models::ModelError);
  settings = {};
  settings.position_tolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(SolveInverseKinematics(model, tip, X_WG, bent, settings), models::ModelError);
}

TEST(TipLinkTest, IsTheOneThatCarriesNoOther) {
  const RobotModel model = Arm("lwr4");
  EXPECT_EQ(model.links()[TipLink(model)].name.text(), "lwr4_flange");
  const AttachedObject box{
      "box", "lwr4_link_7", Eigen::Isometry3d::Identity(), geometry::Sphere{0.1}, {}};
  const RobotModel gripping = AttachObjects(model, std::span(&box, 1));
  EXPECT_EQ(gripping.links()[TipLink(gripping)].name.text(), "lwr4_flange");
  try {
    TipLink(Arm("lwr4_dual"));
    FAIL() << "accepted";
  } catch (const models::ModelError& error) {
    EXPECT_THAT(error.what(), HasSubstr("left_lwr4_flange, right_lwr4_flange"));
  }
}

}  // namespace inverse_kinematics_refusal_test
}  // namespace oca::robot::test
