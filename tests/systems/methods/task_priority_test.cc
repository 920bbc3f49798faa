// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/task_priority.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "tests/allocation_count.h"
#include "tests/systems/method_scene.h"

namespace oca::systems {
namespace task_priority_test {

using Bench = MethodBench<TaskPriority>;
constexpr const char* kElbow = "planar2_link_1";
constexpr const char* kTip = "planar2_link_2";

/// In full from 0.5 m on, so that numbers are easy.
TaskPriority::Params Wide() { return {.activation_distance = 1.0}; }

Eigen::VectorXd Answer(const TaskPriority::Params& params, const Eigen::Vector2d& wish,
                       const ProximitySet& set) {
  return Bench(params).Answer(Eigen::Vector2d::Zero(), wish, set);
}

TEST(TaskPriorityTest, GrantsARequestThatNothingIsNear) {
  EXPECT_EQ(Answer({}, {0.5, -0.25}, {}), Eigen::Vector2d(0.5, -0.25));
  EXPECT_EQ(Answer({}, {0.5, -0.25}, {{Above(kElbow, 0.5, 0.4, 2.0)}}),
            Eigen::Vector2d(0.5, -0.25));
}

TEST(TaskPriorityTest, FarFromContactTheElbowEvadesUnderTheTipByHand) {
  // The tip (0.9, 0.4) may not move in y; the elbow, at 0.3 m, may be approached with
  // 2 * 0.25 m/s by an obstacle that comes with 1: it has to leave with 0.5 m/s.
  const Eigen::VectorXd u = Answer(Wide(), {0, 0}, {{Above(kElbow, 0.5, 0.3, 1.0)}});
  EXPECT_NEAR((u - Eigen::Vector2d(-1.0, 2.25)).norm(), 0.0, 1e-12);
}

TEST(TaskPriorityTest, CloseToContactTheElbowEvadesFirstByHand) {
  Bench method(Wide());
  const Eigen::VectorXd u = method.Answer(Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                          {{Above(kElbow, 0.5, 0.1, 1.0)}});
  EXPECT_NEAR((u - Eigen::Vector2d(-1.8, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(method.share(), 1.0);
  EXPECT_EQ(method.rows(), 1);
}

TEST(TaskPriorityTest, HalfWayItIsTheMeanOfBoth) {
  // At 0.175 m, between 0.1 and 0.25, the fade is 1/2; 1 - 0.25 m/s are asked for.
  const Eigen::VectorXd u = Answer(Wide(), {0, 0}, {{Above(kElbow, 0.5, 0.175, 1.0)}});
  EXPECT_NEAR((u - 0.5 * 0.75 * (Eigen::Vector2d(-2.0, 4.5) + Eigen::Vector2d(-2, 0))).norm(), 0.0,
              1e-12);
}

TEST(TaskPriorityTest, TheTipItselfEvadesOnlyOnceTheRolesSwap) {
  EXPECT_NEAR(
      (Answer(Wide(), {0.3, 0}, {{Above(kTip, 0.9, 0.26, 2.0)}}) - Eigen::Vector2d(0.3, 0)).norm(),
      0.0, 1e-12);
  const Eigen::VectorXd u = Answer(Wide(), {0.3, 0}, {{Above(kTip, 0.9, 0.1, 2.0)}});
  EXPECT_NEAR(0.9 * u[0] + 0.4 * u[1], -1.9, 1e-12);
}

TEST(TaskPriorityTest, NeverHoldsBackARetreat) {
  EXPECT_EQ(Answer({}, {-2, 0.3}, {{Above(kElbow, 0.5, -0.01)}}), Eigen::Vector2d(-2, 0.3));
}

TEST(TaskPriorityTest, RetreatsFromContactAndFromDeepPenetration) {
  for (const double distance : {0.0, -1e-9, -0.05, -0.4, -5.0}) {
    const Eigen::VectorXd u = Answer({}, {1, 1}, {{Above(kElbow, 0.5, distance)}});
    const double asked = std::min(2.0 * (0.05 - distance), 0.5);
    EXPECT_NEAR(-0.5 * u[0], asked, 1e-12) << distance;
    EXPECT_NEAR(u[1], 1.0, 1e-12);
  }
}

TEST(TaskPriorityTest, ObstaclesOnEitherSideShareWhatCannotBeHad) {
  Proximity below = Mirrored(Above(kElbow, 0.5, 0.02));
  const Eigen::VectorXd u = Answer({}, {0.5, 0}, {{Above(kElbow, 0.5, 0.02), below}});
  EXPECT_TRUE(u.allFinite());
  EXPECT_LT(std::fabs(0.5 * u[0]), 0.25);
}

TEST(TaskPriorityTest, KeepsTheTipOfASevenJointArmWhileNothingIsClose) {
  TaskPriority::Params params = Wide();
  params.swap_distance = 0.15;
  for (const auto task : {TaskPriorityLaw::TipTask::kPosition, TaskPriorityLaw::TipTask::kPose}) {
    params.tip_task = task;
    Bench method(params, "lwr4");
    const auto& model = method.model();
    const LinkPoses poses = PosesOf(model, BentArm());
    const Eigen::Vector3d elbow = poses.poses[4].translation();
    const Eigen::Vector3d n = Eigen::Vector3d(1, 2, 0.5).normalized();
    const ProximitySet set{{Near("lwr4_link_4", elbow, 0.3, n, 0.7 * n)}};
    const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -0.05, 0.07);
    const Eigen::VectorXd change = method.Answer(BentArm(), wish, set) - wish;
    robot::Matrix6X J(6, 7);
    robot::LinkJacobian(model, poses.poses, model.num_links() - 1, J);
    EXPECT_GT(change.norm(), 1e-2);
    const Eigen::VectorXd moved = J * change;
    EXPECT_LT(moved.head<3>().norm(), 1e-10);
    EXPECT_EQ(moved.norm() < 1e-10, task == TaskPriorityLaw::TipTask::kPose);
  }
}

TEST(TaskPriorityTest, MovesWithTheWorld) {
  Eigen::Isometry3d X(Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()));
  X.translation() << 0.3, -1.0, 2.0;
  Bench here({}, "lwr4");
  Bench there({}, "lwr4", X);
  const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -0.5, 0.7);
  ProximitySet set = AroundBentArm(here.model(), 0.12);
  const Eigen::VectorXd u = here.Answer(BentArm(), wish, set);
  for (Proximity& proximity : set.proximities) proximity = Moved(X, proximity);
  EXPECT_NEAR((there.Answer(BentArm(), wish, set) - u).norm(), 0.0, 1e-9);
  EXPECT_GT((u - wish).norm(), 1e-2);
}

TEST(TaskPriorityTest, AMirroredSceneMirrorsTheMotion) {
  Bench method({});
  const Eigen::Vector2d q(0.4, 0.7), wish(0.5, -0.2);
  const Proximity scene =
      Near(kTip, {0.7, 0.5, 0}, 0.12, Eigen::Vector3d(-0.6, -0.8, 0), {0, -0.5, 0});
  const Eigen::VectorXd u = method.Answer(q, wish, {{scene}});
  const Eigen::VectorXd mirrored = method.Answer(-q, -wish, {{Mirrored(scene)}});
  EXPECT_NEAR((u + mirrored).norm(), 0.0, 1e-12);
  EXPECT_GT((u - wish).norm(), 1e-2);
}

TEST(TaskPriorityTest, ChangesByABoundedAmountAsAnObstacleComesNear) {
  EXPECT_LT(SteepestChange<TaskPriority>({}), 200.0);
}

TEST(TaskPriorityTest, DoesNotJumpAsTheListOfObstaclesChanges) {
  Bench method({}, "lwr4");
  const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -0.5, 0.7);
  ProximitySet set = AroundBentArm(method.model(), 0.4 - 1e-5);
  set.proximities[1].obstacle_velocity = -2.0 * Eigen::Vector3d::UnitZ();
  const Eigen::VectorXd with = method.Answer(BentArm(), wish, set);
  set.proximities.erase(set.proximities.begin() + 1);
  EXPECT_NEAR((method.Answer(wish, set) - with).norm(), 0.0, 1e-5);
}

TEST(TaskPriorityTest, NoObstacleTakesMoreThanTheDampingLeaves) {
  // A change of the nearest feature may turn the normal at once; both answers are within this.
  const TaskPriority::Params params;
  Bench method(params, "lwr4");
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(7);
  ProximitySet set = AroundBentArm(method.model(), 0.12);
  set.proximities = {set.proximities[1]};
  for (int i = 0; i < 100; ++i) {
    set.proximities[0].normal =
        Eigen::Vector3d(std::cos(0.3 * i), std::sin(0.3 * i), 0.1 * (i % 7)).normalized();
    const Eigen::VectorXd u = method.Answer(BentArm(), rest, set);
    EXPECT_LE(u.norm(), params.retreat_speed / params.most_damping);
  }
}

TEST(TaskPriorityTest, RefusesWhatItCannotUse) {
  const auto make = [](auto&& change) {
    TaskPriority::Params params;
    change(params);
    TaskPriority{params, TestModels("planar2")};
  };
  EXPECT_NO_THROW(make([](auto& p) { p.tip = "planar2_link_1"; }));
  EXPECT_THROW(make([](auto& p) { p.tip = "nose"; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.approach_gain = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.safe_distance = -0.1; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.retreat_speed = -0.1; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.swap_distance = p.contact_distance; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.activation_distance = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.most_damping = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.damping_threshold = 0.5 * p.most_damping; }), ConfigError);
  EXPECT_THROW(Answer({}, {0, 0}, {{Above("lwr4_link_3", 0.5, 0.1)}}), SimulationError);
}

TEST(TaskPriorityTest, TicksWithoutTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  Bench method({}, "lwr4");
  const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -0.5, 0.7);
  const ProximitySet set = AroundBentArm(method.model(), 0.12);
  method.Answer(BentArm(), wish, set);
  auto& bench = method.bench();
  bench->proximities.Fix(bench.context(), set);
  const std::int64_t before = AllocationCount();
  bench->velocity.Eval(bench.context());
  EXPECT_EQ(AllocationCount(), before);
}

}  // namespace task_priority_test
}  // namespace oca::systems
