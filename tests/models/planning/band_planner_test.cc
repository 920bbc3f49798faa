// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_planner.h"

#include <gtest/gtest.h>

#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace band_planner_test {

using Eigen::VectorXd;

/// The planar arm of two joints in front of a post, asked to turn by 90 degrees in 4 s.
class Turn {
 public:
  Turn() : model(test::Arm("planar3")) {
    for (const robot::PlacedBody& post : test::Post()) {
      bodies.push_back(
          {models::Name("post"), post.collider, [X = post.X_WO](double) { return X; }, true});
    }
    for (VectorXd& x : task.deviation) x.setZero(model->num_positions());
    task.request = [n = model->num_positions()](double time, int derivative,
                                                Eigen::Ref<VectorXd> out) {
      const double s = std::clamp(time / 4.0, 0.0, 1.0);
      const double shape[3] = {s * s * (3.0 - 2.0 * s), 1.5 * s * (1.0 - s),
                               0.375 * (1.0 - 2.0 * s)};
      out = VectorXd::Zero(n);
      out[0] = (derivative > 0 && (s == 0.0 || s == 1.0) ? 0.0 : shape[derivative]) * 1.5708;
    };
    task.request_end = 4.0;
  }
  BandPlan Plan(const BandPlannerSettings& settings = {}) {
    task.bodies = bodies;
    BandPlanner planner(model, settings);
    return planner.Plan(task, nullptr);
  }
  std::shared_ptr<const robot::RobotModel> model;
  std::vector<BandBody> bodies;
  BandTask task;
};

/// Moves against y with `speed`, m/s.
BandBody Flying(const char* name, const robot::PlacedBody& body, double speed) {
  return {models::Name(name), body.collider,
          [X = body.X_WO, speed](double time) {
            Eigen::Isometry3d moved = X;
            moved.translation().y() -= speed * time;
            return moved;
          },
          false};
}

TEST(BandPlannerTest, LeavesARequestAloneThatIsClear) {
  Turn turn;
  turn.bodies.clear();
  const BandPlan plan = turn.Plan();
  EXPECT_EQ(plan.start, BandStart::kRequest);
  EXPECT_TRUE(plan.check.clear());
  EXPECT_TRUE(plan.curve.controls().isZero(0.0));
}

TEST(BandPlannerTest, FindsTheWayPastAPostThatTheRequestGoesThrough) {
  Turn turn;
  const BandPlan plan = turn.Plan();
  EXPECT_TRUE(plan.check.clear()) << plan.check.min_distance;
  EXPECT_TRUE(plan.curve.controls().rightCols(3).isZero(0.0));
}

TEST(BandPlannerTest, PlansTheSameTwice) {
  Turn turn;
  EXPECT_TRUE(turn.Plan().curve.controls() == turn.Plan().curve.controls());
}

TEST(BandPlannerTest, SaysWhatIsInTheWayWhereThereIsNoWay) {
  Turn turn;
  // A wall of posts at the goal.
  const robot::PlacedBody wall = test::BoxAt({0.4, 4.0, 2.0}, {0.0, 2.2, 0.0});
  turn.bodies.push_back(
      {models::Name("wall"), wall.collider, [X = wall.X_WO](double) { return X; }, true});
  const BandPlan plan = turn.Plan();
  // It rests in front of the wall, and says what leaves it no room.
  EXPECT_TRUE(plan.check.clear());
  EXPECT_FALSE(plan.reaches);
  EXPECT_FALSE(plan.curve.controls().rightCols(3).isZero(1e-3));
  EXPECT_LE(plan.goal_room, 0.0);
  EXPECT_EQ(plan.goal_body, models::Name("wall"));
}

TEST(BandPlannerTest, BoundsItsWorkAndGetsThereByMoreSearches) {
  Turn turn;
  const robot::PlacedBody wall = test::BoxAt({0.4, 4.0, 2.0}, {0.0, 2.2, 0.0});
  turn.bodies.push_back(
      {models::Name("wall"), wall.collider, [X = wall.X_WO](double) { return X; }, true});
  for (const long bound : {2000L, 6000L}) {
    for (turn.task.plans_before = 0; turn.task.plans_before < 4; ++turn.task.plans_before) {
      const BandPlan plan = turn.Plan({.most_paths = 0, .most_evaluations = bound});
      EXPECT_LT(plan.work.looks(), 1.25 * bound) << turn.task.plans_before;
    }
  }
  turn.bodies.pop_back();
  int clear = 0;
  for (turn.task.plans_before = 0; turn.task.plans_before < 8; ++turn.task.plans_before) {
    clear += turn.Plan({.most_paths = 0, .most_evaluations = 3000}).check.clear();
  }
  EXPECT_GT(clear, 0);
}

TEST(BandPlannerTest, DoesNotReturnWhereSomethingComesBetweenArmAndRequest) {
  // A wall sweeps over where the request rests and is past it when the plan ends.
  Turn turn;
  turn.task.request = [n = turn.model->num_positions()](double, int derivative,
                                                        Eigen::Ref<VectorXd> out) {
    out = VectorXd::Zero(n);
    if (derivative == 0) out[0] = 0.5;
  };
  turn.task.request_end = 0.0;
  turn.task.deviation[0][0] = -0.6;
  const robot::PlacedBody wall = test::BoxAt({3.0, 0.1, 1.0}, {1.6, 0.3, 0.0});
  turn.bodies = {Flying("wall", wall, 0.08)};
  const BandPlan plan = turn.Plan();
  EXPECT_TRUE(plan.check.clear()) << plan.check.min_distance << " at " << plan.check.time;
}

TEST(BandPlannerTest, DucksInTimeAwayFromWhatComes) {
  robot::LoadOptions options;
  options.X_WB.translation() = Eigen::Vector3d(0.0, 0.0, 0.85);
  options.acceleration_limits = VectorXd::Constant(1, 10.0);
  Turn turn;
  turn.model = std::make_shared<const robot::RobotModel>(
      robot::LoadUrdf(OCA_SOURCE_DIR "/models/robots/lwr4/lwr4.urdf", options));
  VectorXd home(7);
  home << 0.0, 1.48, 0.0, -0.61, 0.0, 0.52, 0.0;
  for (VectorXd& x : turn.task.deviation) x.setZero(7);
  turn.task.request = [home](double, int derivative, Eigen::Ref<VectorXd> out) {
    out = derivative == 0 ? home : VectorXd::Zero(7);
  };
  turn.task.request_end = 0.0;
  const robot::PlacedBody cube = test::BoxAt({0.2, 0.2, 0.2}, {0.45, 1.6, 1.2});
  turn.bodies = {Flying("cube", cube, 1.6)};
  const BandPlan plan = turn.Plan();
  EXPECT_TRUE(plan.check.clear()) << plan.check.min_distance;
  VectorXd x(7);
  plan.curve.Evaluate(1.0, 0, x);
  EXPECT_GT(x.cwiseAbs().maxCoeff(), 0.05);
  plan.curve.Evaluate(plan.curve.end(), 0, x);
  EXPECT_TRUE(x.isZero(0.0));
}

}  // namespace band_planner_test
}  // namespace oca::planning
