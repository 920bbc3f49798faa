// SPDX-License-Identifier: BSD-3-Clause
#include "models/planning/clairvoyant.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/models/planning/scene.h"

namespace oca::models {
namespace {

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
    bodies.push_back({Name("ball"), MakeCollider(Sphere{0.05}, "ball"),
                      [x, speed](double time) {
                        Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
                        X.translation().x() = x;
                        X.translation().y() = 1.0 - speed * std::max(time - 1.0, 0.0);
                        return X;
                      },
                      false});
  }
  std::shared_ptr<const RobotModel> model;
  std::vector<BandBody> bodies;
  ClairvoyantTask task;
};

TEST(ClairvoyantTest, LeavesARequestAloneThatIsClear) {
  Rest rest;
  rest.Throw(0.8, 0.2);  // ends 0.6 m away
  const ClairvoyantPlan plan = rest.Plan();
  EXPECT_TRUE(plan.clear);
  EXPECT_EQ(plan.start, BandStart::kRequest);
  EXPECT_EQ(plan.min_distance, kClairvoyantReach);
  EXPECT_EQ(plan.speed, 0.0);
}

TEST(ClairvoyantTest, GivesWayToABallThatStopsInTheArm) {
  Rest rest;
  rest.Throw(0.8, 0.5);
  const ClairvoyantPlan plan = rest.Plan();
  EXPECT_TRUE(plan.clear) << plan.min_distance;
  EXPECT_GT(plan.speed, 0.0);
  EXPECT_LE(plan.speed, 1.0 + 1e-9);
  EXPECT_LE(plan.acceleration, 1.0 + 1e-9);
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
  EXPECT_FALSE(plan.clear);
  EXPECT_LT(plan.min_distance, 0.0);
}

TEST(ClairvoyantTest, PlansTheSameTwice) {
  Rest one, other;
  one.Throw(0.8, 0.5);
  other.Throw(0.8, 0.5);
  const ClairvoyantPlan a = one.Plan(), b = other.Plan();
  EXPECT_TRUE(a.curve.controls() == b.curve.controls());
  EXPECT_EQ(a.min_distance, b.min_distance);
}

}  // namespace
}  // namespace oca::models
