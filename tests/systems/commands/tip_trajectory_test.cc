// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/tip_trajectory.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"

namespace oca::systems {
namespace tip_trajectory_test {

using ::testing::HasSubstr;

constexpr double kHeight = 0.5;  // of the base, m

ModelSet Arm() {
  robot::LoadOptions options;
  options.X_WB.translation().z() = kHeight;
  ModelSet models;
  models.Add("arm", std::make_shared<const robot::RobotModel>(
                        robot::LoadUrdf(OCA_SOURCE_DIR "/models/robots/lwr4/lwr4.urdf", options)));
  return models;
}

Eigen::VectorXd Posture() {
  Eigen::VectorXd q(7);
  q << 0.0, 0.5, 0.0, -1.6, 0.0, 0.9, 0.0;
  return q;
}

TipRequest::Params Line() {
  TipRequest::Params params;
  params.from = Eigen::Vector3d(0.1, 0.0, 0.65);
  params.to = Eigen::Vector3d(0.85, 0.0, 0.35);
  params.posture = Posture();
  return params;
}

TipRequest::Params Circle() {
  TipRequest::Params params;
  params.path = TipPath::kCircle;
  params.centre = Eigen::Vector3d(0.5, 0.0, 0.35);
  params.normal = Eigen::Vector3d::UnitX();
  params.radius = 0.25;
  params.posture = Posture();
  return params;
}

std::string RefusalOf(const TipRequest::Params& params) {
  try {
    TipRequest::Resolved(params, Arm());
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

/// Where the tip is in the base frame while the joints move along the trajectory.
class Tip {
 public:
  explicit Tip(const TipRequest::Params& params)
      : models_(Arm()),
        model_(models_.Get("arm")),
        trajectory_(TipRequest::MakeTrajectory(TipRequest::Resolved(params, models_))) {}
  Eigen::Vector3d At(double time) const {
    const auto X_WL = robot::LinkPoses(*model_, trajectory_.Evaluate(time, 0));
    Eigen::Vector3d p = X_WL[static_cast<std::size_t>(model_->bodies().back())].translation();
    p.z() -= kHeight;
    return p;
  }
  Eigen::VectorXd Joints(double time) const { return trajectory_.Evaluate(time, 0); }

 private:
  ModelSet models_;
  std::shared_ptr<const robot::RobotModel> model_;
  motion::Trajectory trajectory_;
};

TEST(TipTrajectoryTest, DrawsTheLineFromEndToEnd) {
  const Tip tip(Line());
  const Eigen::Vector3d from = *Line().from;
  const Eigen::Vector3d way = *Line().to - from;
  EXPECT_LT((tip.At(3.0) - from).norm(), 1e-8);
  EXPECT_LT((tip.At(13.0) - from - way).norm(), 1e-8);
  EXPECT_LT((tip.At(8.0) - from - 0.5 * way).norm(), 1e-5);  // half-way at half the time
  for (double time = 3.0; time <= 13.0; time += 0.0173) {
    const Eigen::Vector3d p = tip.At(time) - from;
    EXPECT_LT(p.cross(way.normalized()).norm(), 1e-5) << time;
  }
}

TEST(TipTrajectoryTest, GoesOnceRoundTheCircleFromItsTop) {
  const Tip tip(Circle());
  const Eigen::Vector3d centre = *Circle().centre;
  EXPECT_LT((tip.At(3.0) - centre - Eigen::Vector3d(0, 0, 0.25)).norm(), 1e-8);
  EXPECT_LT((tip.At(8.0) - centre + Eigen::Vector3d(0, 0, 0.25)).norm(), 1e-5);
  EXPECT_LT(tip.At(5.5).y(), centre.y());  // counter-clockwise about x: from z towards -y
  for (double time = 3.0; time <= 13.0; time += 0.0173) {
    const Eigen::Vector3d p = tip.At(time) - centre;
    EXPECT_NEAR(p.norm(), 0.25, 1e-5);
    EXPECT_NEAR(p.x(), 0.0, 1e-5);
  }
}

TEST(TipTrajectoryTest, StartsAtThePostureAndRestsThereUntilItStarts) {
  TipRequest::Params params = Line();
  params.start = 1.0;
  const Tip tip(params);
  EXPECT_EQ(tip.Joints(0.0), Posture());
  EXPECT_EQ(tip.Joints(1.0), Posture());
  EXPECT_GT((tip.Joints(2.0) - Posture()).norm(), 1e-3);
}

TEST(TipTrajectoryTest, RefusesAPathBeyondReachAndOneHalfGiven) {
  TipRequest::Params far = Line();
  far.to = Eigen::Vector3d(1.2, 0.0, 0.35);
  EXPECT_THAT(RefusalOf(far), HasSubstr("path: the tip cannot reach"));
  TipRequest::Params half = Line();
  half.to.reset();
  EXPECT_THAT(RefusalOf(half), HasSubstr("to: got none; expected one of a line"));
  TipRequest::Params both = Line();
  both.radius = 0.1;
  EXPECT_THAT(RefusalOf(both), HasSubstr("radius: got a value; expected none of a line"));
  TipRequest::Params flat = Circle();
  flat.normal = Eigen::Vector3d::Zero();
  EXPECT_THAT(RefusalOf(flat), HasSubstr("normal: got no direction"));
  TipRequest::Params short_posture = Line();
  short_posture.posture = Eigen::VectorXd::Zero(6);
  EXPECT_THAT(RefusalOf(short_posture), HasSubstr("posture: got 6 numbers; expected 7"));
  TipRequest::Params bent = Line();
  Eigen::VectorXd elbow = Posture();
  elbow[3] = -3.0;
  bent.posture = elbow;
  EXPECT_THAT(RefusalOf(bent), HasSubstr("path: takes joint 'lwr4_joint_4'"));
  EXPECT_EQ(RefusalOf(Line()), "accepted");
}

}  // namespace tip_trajectory_test
}  // namespace oca::systems
