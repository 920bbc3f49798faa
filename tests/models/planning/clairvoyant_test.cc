// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/clairvoyant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "oca/models/error.h"
#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace clairvoyant_test {

using Eigen::VectorXd;

/// The planar arm rests, stretched along x, for 3 s.
class Rest {
 public:
  Rest() : model(test::Arm("planar3")) {
    task.request = [](double, int, Eigen::Ref<VectorXd> out) { out.setZero(); };
    task.duration = 3.0;
    task.starts = 4;
  }
  ClairvoyantPlan Plan() {
    task.bodies = bodies;
    return PlanClairvoyantly(model, task);
  }
  /// A ball through the arm at x, in y from 1 m on at `speed`; 1 s in the script before it starts.
  void Throw(double x, double speed) {
    bodies.push_back({models::Name("ball"), geometry::MakeCollider(geometry::Sphere{0.05}, "ball"),
                      [x, speed](double time) {
                        Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
                        X.translation().x() = x;
                        X.translation().y() = 1.0 - speed * std::max(time - 1.0, 0.0);
                        return X;
                      },
                      false});
  }
  std::shared_ptr<const robot::RobotModel> model;
  std::vector<BandBody> bodies;
  ClairvoyantTask task;
};

TEST(ClairvoyantTest, LeavesARequestAloneThatIsClear) {
  Rest rest;
  rest.Throw(0.8, 0.2);  // ends 0.6 m away
  const ClairvoyantPlan plan = rest.Plan();
  EXPECT_TRUE(plan.verdict.clear());
  EXPECT_EQ(plan.start, BandStart::kRequest);
  EXPECT_EQ(plan.verdict.min_distance, kClairvoyantReach);
  EXPECT_EQ(plan.verdict.speed, 0.0);
}

TEST(ClairvoyantTest, GivesWayToABallThatStopsInTheArm) {
  Rest rest;
  rest.Throw(0.8, 0.5);
  const ClairvoyantPlan plan = rest.Plan();
  EXPECT_TRUE(plan.verdict.clear()) << plan.verdict.min_distance;
  EXPECT_GT(plan.verdict.speed, 0.0);
  EXPECT_LE(plan.verdict.speed, 1.0 + 1e-9);
  EXPECT_LE(plan.verdict.acceleration, 1.0 + 1e-9);
}

TEST(ClairvoyantTest, DoesNotClearWhatNobodyCan) {
  Rest rest;  // a ball in the arm from the beginning
  rest.Throw(0.5, 0.0);
  rest.bodies[0].pose = [](double) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation().x() = 0.5;
    return X;
  };
  const ClairvoyantPlan plan = rest.Plan();
  EXPECT_FALSE(plan.verdict.clear());
  EXPECT_LT(plan.verdict.min_distance, 0.0);
  EXPECT_EQ(plan.tries, 0);  // the arm is in contact before it can move
}

TEST(ClairvoyantTest, StaysWithinTheLimitsOrSaysThatItCannot) {
  Rest rest;
  rest.Throw(0.8, 2.0);  // in the arm half a second after it starts, and through it
  const auto within = [&](double acceleration_limit) {
    std::vector<robot::Joint> joints = rest.model->joints();
    for (robot::Joint& joint : joints) joint.acceleration_limit = acceleration_limit;
    rest.model =
        std::make_shared<const robot::RobotModel>(rest.model->name(), rest.model->links(), joints,
                                                  rest.model->X_WB(), rest.model->disabled_pairs());
    return rest.Plan();
  };
  const ClairvoyantPlan plan = within(3.0);
  EXPECT_TRUE(plan.verdict.clear()) << plan.verdict.min_distance;
  EXPECT_LE(plan.verdict.acceleration, 1.0 + 1e-9);
  EXPECT_GT(plan.verdict.acceleration, 0.1);
  const ClairvoyantPlan lame = within(0.01);  // 0.01 rad until the ball is there
  EXPECT_FALSE(lame.verdict.clear());
  EXPECT_GT(lame.tries, rest.task.starts);
}

TEST(ClairvoyantTest, KeepsOwnLinksApartWithoutAnyBody) {
  Rest rest;
  rest.task.duration = 6.0;
  rest.task.request = [](double time, int derivative, Eigen::Ref<VectorXd> out) {
    out.setZero();  // joints 2 and 3 curl up to 2.8 rad, where links 1 and 3 are in contact
    constexpr double kRate = 2.0 * std::numbers::pi / 6.0;
    const double phase = kRate * time;
    const double s = derivative == 0   ? 0.5 * (1.0 - std::cos(phase))
                     : derivative == 1 ? 0.5 * kRate * std::sin(phase)
                                       : 0.5 * kRate * kRate * std::cos(phase);
    out[1] = out[2] = 2.8 * s;
  };
  EXPECT_EQ(rest.Plan().tries, 0);
  rest.task.self_collision = true;
  const ClairvoyantPlan plan = rest.Plan();
  EXPECT_TRUE(plan.verdict.clear()) << plan.verdict.min_distance;
  EXPECT_GT(plan.tries, 0);
  EXPECT_LT(plan.verdict.final_error, 1e-9);
}

TEST(ClairvoyantTest, StartsWhereTheArmIs) {
  Rest rest;
  rest.Throw(0.8, 0.2);
  rest.task.start = Eigen::Vector3d(0.3, 0.0, 0.0);  // 0.3 rad off its request
  const ClairvoyantPlan plan = rest.Plan();
  VectorXd x(3);
  plan.curve.Evaluate(0.0, 0, x);
  EXPECT_LT((x - rest.task.start).cwiseAbs().maxCoeff(), 1e-9);
  plan.curve.Evaluate(0.0, 1, x);
  EXPECT_LT(x.cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_TRUE(plan.verdict.clear());
  EXPECT_LT(plan.verdict.final_error, 1e-9);
}

TEST(ClairvoyantTest, EndsElsewhereWhereTheGoalIsInTheWay) {
  Rest rest;
  rest.Throw(0.8, 0.5);  // stays in the arm
  rest.task.duration = 3.2;
  const ClairvoyantPlan plan = rest.Plan();
  EXPECT_TRUE(plan.verdict.clear());
  EXPECT_GT(plan.verdict.final_error, 0.01);
}

TEST(ClairvoyantTest, RefusesATaskWithoutLengthAndAStartOfOtherJoints) {
  Rest rest;
  rest.task.duration = 0.0;
  EXPECT_THROW(rest.Plan(), models::ModelError);
  rest.task.duration = 3.0;
  rest.task.start = VectorXd::Zero(2);
  EXPECT_THROW(rest.Plan(), models::ModelError);
}

TEST(ClairvoyantTest, PlansTheSameTwice) {
  Rest one, other;
  one.Throw(0.8, 0.5);
  other.Throw(0.8, 0.5);
  const ClairvoyantPlan a = one.Plan(), b = other.Plan();
  EXPECT_TRUE(a.curve.controls() == b.curve.controls());
  EXPECT_EQ(a.verdict.min_distance, b.verdict.min_distance);
}

}  // namespace clairvoyant_test
}  // namespace oca::planning
