// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/motion_judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace motion_judge_test {

using Eigen::VectorXd;

constexpr double kReach = 0.5;

/// planar3 with these limits on the acceleration of every joint.
std::shared_ptr<const robot::RobotModel> ArmOfAcceleration(double limit) {
  const auto arm = test::Arm("planar3");
  std::vector<robot::Joint> joints = arm->joints();
  for (robot::Joint& joint : joints) joint.acceleration_limit = limit;
  return std::make_shared<const robot::RobotModel>(arm->name(), arm->links(), joints, arm->X_WB(),
                                                   arm->disabled_pairs());
}

/// A motion of joint `joint`: sine of `amplitude` and `rate`; the others rest at 0.
BandRequest Swing(int joint, double amplitude, double rate) {
  return [=](double time, int derivative, Eigen::Ref<VectorXd> out) {
    out.setZero();
    const double phase = rate * time + 0.5 * std::numbers::pi * derivative;
    out[joint] = amplitude * std::pow(rate, derivative) * std::sin(phase);
  };
}

BandRequest Rest() { return Swing(0, 0.0, 1.0); }

BandBody BallAt(double x, double y) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = Eigen::Vector3d(x, y, 0.0);
  return {models::Name("ball"), geometry::MakeCollider(geometry::Sphere{0.1}, "ball"),
          [X](double) { return X; }, true};
}

class MotionJudgeTest : public testing::Test {
 protected:
  MotionVerdict Judge(double duration = 1.0) {
    const BandCurve curve = deviation.empty() ? BandCurve(3, Times(duration)) : deviation;
    return MotionJudge(model, request, bodies, self_collision, ignored, kReach)
        .Judge(curve, duration, kMotionGrid);
  }
  static std::vector<double> Times(double duration) {
    std::vector<double> times;
    for (int i = 0; i <= 8; ++i) times.push_back(duration * i / 8);
    return times;
  }
  std::shared_ptr<const robot::RobotModel> model = test::Arm("planar3");
  BandRequest request = Rest();
  BandCurve deviation;
  std::vector<BandBody> bodies;
  bool self_collision = false;
  std::vector<std::pair<int, int>> ignored;
};

TEST_F(MotionJudgeTest, MeasuresTheNearestPairOfAnArmAtRest) {
  bodies = {BallAt(0.7, 0.25), BallAt(0.2, -0.3)};
  const MotionVerdict verdict = Judge();
  EXPECT_NEAR(verdict.min_distance, 0.25 - 0.1 - 0.05, 1e-9);
  EXPECT_EQ(verdict.link.text(), "planar3_link_2");
  EXPECT_EQ(verdict.body.text(), "ball");
  EXPECT_TRUE(verdict.clear());
  EXPECT_EQ(verdict.speed, 0.0);
}

TEST_F(MotionJudgeTest, TellsContactFromNearlyContact) {
  bodies = {BallAt(0.7, 0.15 + 1e-6)};
  EXPECT_TRUE(Judge().clear());
  bodies = {BallAt(0.7, 0.15 - 1e-6)};
  EXPECT_FALSE(Judge().clear());
}

TEST_F(MotionJudgeTest, SeesABodyWhereItIsAtEachInstant) {
  bodies = {BallAt(0.0, 0.0)};  // passes the arm's tip in the middle, 0.03 m off
  bodies[0].stands = false;
  bodies[0].pose = [](double time) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = Eigen::Vector3d(1.2 + 0.05 + 0.1 + 0.03, 4.0 * (time - 0.5), 0.0);
    return X;
  };
  const MotionVerdict verdict = Judge();
  EXPECT_NEAR(verdict.min_distance, 0.03, 1e-9);
  EXPECT_NEAR(verdict.time, 0.5, 1e-9);
}

TEST_F(MotionJudgeTest, DoesNotLookAtAPairThatMayTouch) {
  bodies = {BallAt(0.7, 0.0), BallAt(0.7, 0.25)};
  EXPECT_FALSE(Judge().clear());
  ignored = {{model->FindLink("planar3_link_2"), 0}};
  EXPECT_NEAR(Judge().min_distance, 0.05, 1e-9);  // the first ball off link 1 and link 3
}

TEST_F(MotionJudgeTest, SeesOwnLinksOnlyIfAsked) {
  request = [](double, int derivative, Eigen::Ref<VectorXd> out) {
    out.setZero();
    if (derivative == 0) out << 0.0, 2.8, 2.8;
  };
  EXPECT_TRUE(Judge().clear());
  self_collision = true;
  const MotionVerdict verdict = Judge();
  EXPECT_FALSE(verdict.clear());
  EXPECT_EQ(verdict.link.text(), "planar3_link_3");
  EXPECT_EQ(verdict.body.text(), "planar3_link_1");
}

TEST_F(MotionJudgeTest, TakesAMotionToItsLimitOfSpeedAndNotAbove) {
  request = Swing(0, 0.1, 20.0);  // 2 rad/s at most, which is the limit
  EXPECT_NEAR(Judge().speed, 1.0, 1e-12);
  EXPECT_TRUE(Judge().clear());
  request = Swing(0, 0.1 * (1.0 + 1e-6), 20.0);
  EXPECT_FALSE(Judge().clear());
}

TEST_F(MotionJudgeTest, TakesAMotionToItsLimitOfAccelerationAndNotAbove) {
  const auto at_share = [&](double share) {
    model = ArmOfAcceleration(10.0);
    // Its largest acceleration, at a quarter of a turn, lies on the grid.
    request = Swing(1, share * 10.0 / (25.0 * std::numbers::pi * std::numbers::pi),
                    5.0 * std::numbers::pi);
    return Judge();
  };
  EXPECT_NEAR(at_share(1.0).acceleration, 1.0, 1e-9);
  EXPECT_TRUE(at_share(1.0).clear());
  EXPECT_FALSE(at_share(1.0 + 1e-6).clear());
  model = test::Arm("planar3");  // no limit
  request = Swing(1, 0.1, 5.0 * std::numbers::pi);
  EXPECT_EQ(Judge().acceleration, 0.0);
}

TEST_F(MotionJudgeTest, TakesAMotionToItsLimitOfPositionAndNotAbove) {
  request = Swing(2, 2.9, 0.5);
  EXPECT_NEAR(Judge(3.2).position, 1.0, 1e-6);
  EXPECT_TRUE(Judge(3.2).clear());
  request = Swing(2, 2.9 * (1.0 + 1e-5), 0.5);
  EXPECT_FALSE(Judge(3.2).clear());
}

TEST_F(MotionJudgeTest, KeepsALimitOnOneSide) {
  const auto with = [&](double lower, double upper) {
    std::vector<robot::Joint> joints = model->joints();
    joints[2].lower_limit = lower;
    joints[2].upper_limit = upper;
    model = std::make_shared<const robot::RobotModel>(model->name(), model->links(), joints);
  };
  const auto stands = [&](double at) {
    request = [at](double, int derivative, Eigen::Ref<VectorXd> out) {
      out.setZero();
      if (derivative == 0) out[2] = at;
    };
    deviation = BandCurve(3, Times(1.0));
    const VectorXd back = -at * VectorXd::Unit(3, 2);  // starts at 0
    deviation.StartWith(back, VectorXd::Zero(3), VectorXd::Zero(3));
    deviation.Follow([](double) -> VectorXd { return VectorXd::Zero(3); });
    return Judge(1.0).position;
  };
  with(-robot::kUnlimited, 0.5);
  EXPECT_EQ(stands(0.49), 0.0);
  EXPECT_EQ(stands(-2.0), 0.0);
  EXPECT_EQ(stands(0.51), 2.0);
  with(-0.5, robot::kUnlimited);
  EXPECT_EQ(stands(-0.51), 2.0);
  EXPECT_EQ(stands(2.0), 0.0);
  with(-1e308, 1e308);
  EXPECT_EQ(stands(2.0), 0.0);
  // Exactly at a limit below, or above, 0.
  with(-robot::kUnlimited, -0.5);
  request = [](double, int derivative, Eigen::Ref<VectorXd> out) {
    out.setZero();
    if (derivative == 0) out[2] = -0.5;
  };
  deviation = {};
  EXPECT_EQ(Judge().position, 0.0);
}

TEST_F(MotionJudgeTest, LetsAMotionThatStartsBeyondALimitComeBack) {
  request = [](double time, int derivative, Eigen::Ref<VectorXd> out) {
    out.setZero();
    if (derivative == 0) out[2] = 3.0 - 0.2 * time;
    if (derivative == 1) out[2] = -0.2;
  };
  EXPECT_TRUE(Judge().clear());
  request = [](double time, int derivative, Eigen::Ref<VectorXd> out) {
    out.setZero();
    if (derivative == 0) out[2] = 3.0 + 0.01 * time;
    if (derivative == 1) out[2] = 0.01;
  };
  EXPECT_FALSE(Judge().clear());
}

TEST_F(MotionJudgeTest, DoesNotTakeWhatIsNoNumberForClear) {
  request = [](double time, int derivative, Eigen::Ref<VectorXd> out) {
    out.setZero();
    if (derivative == 1 && time > 0.5) out[1] = std::nan("");
  };
  EXPECT_FALSE(Judge().clear());
  request = [](double time, int derivative, Eigen::Ref<VectorXd> out) {
    out.setZero();
    if (derivative == 0 && time > 0.5) out[1] = std::nan("");
  };
  EXPECT_FALSE(Judge().clear());
}

TEST_F(MotionJudgeTest, NamesTheTimesAtWhichSomethingLacks) {
  bodies = {BallAt(0.0, 0.0)};  // in the arm from 0.2 to 0.4 s and from 2 to 2.2 s
  bodies[0].stands = false;
  bodies[0].pose = [](double time) {
    const bool there = (time > 0.1995 && time < 0.4005) || (time > 1.9995 && time < 2.2005);
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = Eigen::Vector3d(there ? 0.7 : 10.0, 0.0, 0.0);
    return X;
  };
  const MotionVerdict verdict = Judge(3.0);
  ASSERT_EQ(verdict.troubles.size(), 2u);
  EXPECT_NEAR(verdict.troubles[0].first, 0.2, 1e-9);
  EXPECT_NEAR(verdict.troubles[0].second, 0.4, 1e-9);
  EXPECT_NEAR(verdict.troubles[1].first, 2.0, 1e-9);
  EXPECT_NEAR(verdict.troubles[1].second, 2.2, 1e-9);
  EXPECT_GT(verdict.shortfall, 0.0);
}

TEST_F(MotionJudgeTest, CountsWhatTheMotionEndsOffTheRequest) {
  deviation = BandCurve(3, Times(1.0));
  deviation.Follow([](double) { return VectorXd(Eigen::Vector3d(0.1, -0.3, 0.2)); });
  EXPECT_NEAR(Judge().final_error, 0.3, 1e-9);
}

}  // namespace motion_judge_test
}  // namespace oca::planning
