// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/task_priority_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/models/robot/law_scene.h"

namespace oca::robot::test {
namespace task_priority_law_test {

using Bench = LawBench<TaskPriorityLaw>;
constexpr const char* kElbow = "planar2_link_1";
constexpr const char* kTip = "planar2_link_2";

/// As TaskPriority has it by default; LawBench sets the tip.
TaskPriorityLaw Usual() {
  return {.tip = 0,
          .keeps_orientation = false,
          .safe_distance = 0.05,
          .approach_gain = 2.0,
          .retreat_speed = 0.5,
          .activation_distance = 0.4,
          .swap_distance = 0.25,
          .contact_distance = 0.1,
          .damping = {0.05, 0.1}};
}

/// In full from 0.5 m on, so that numbers are easy.
TaskPriorityLaw Wide() {
  TaskPriorityLaw law = Usual();
  law.activation_distance = 1.0;
  return law;
}

Eigen::VectorXd Answer(const TaskPriorityLaw& law, const Eigen::Vector2d& wish,
                       const ProximitySet& set) {
  return Bench(law).Answer(Eigen::Vector2d::Zero(), wish, set);
}

TEST(TaskPriorityLawTest, GrantsARequestThatNothingIsNear) {
  EXPECT_EQ(Answer(Usual(), {0.5, -0.25}, {}), Eigen::Vector2d(0.5, -0.25));
  EXPECT_EQ(Answer(Usual(), {0.5, -0.25}, {{Above(kElbow, 0.5, 0.4, 2.0)}}),
            Eigen::Vector2d(0.5, -0.25));
}

TEST(TaskPriorityLawTest, FarFromContactTheElbowEvadesUnderTheTipByHand) {
  // The tip (0.9, 0.4) may not move in y; the elbow, at 0.3 m, may be approached with
  // 2 * 0.25 m/s by an obstacle that comes with 1: it has to leave with 0.5 m/s.
  const Eigen::VectorXd u = Answer(Wide(), {0, 0}, {{Above(kElbow, 0.5, 0.3, 1.0)}});
  EXPECT_NEAR((u - Eigen::Vector2d(-1.0, 2.25)).norm(), 0.0, 1e-12);
}

TEST(TaskPriorityLawTest, CloseToContactTheElbowEvadesFirstByHand) {
  Bench method(Wide());
  const Eigen::VectorXd u = method.Answer(Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                          {{Above(kElbow, 0.5, 0.1, 1.0)}});
  EXPECT_NEAR((u - Eigen::Vector2d(-1.8, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(method.result().share, 1.0);
  EXPECT_EQ(method.result().rows, 1);
}

TEST(TaskPriorityLawTest, HalfWayItIsTheMeanOfBoth) {
  // At 0.175 m, between 0.1 and 0.25, the fade is 1/2; 1 - 0.25 m/s are asked for.
  const Eigen::VectorXd u = Answer(Wide(), {0, 0}, {{Above(kElbow, 0.5, 0.175, 1.0)}});
  EXPECT_NEAR((u - 0.5 * 0.75 * (Eigen::Vector2d(-2.0, 4.5) + Eigen::Vector2d(-2, 0))).norm(), 0.0,
              1e-12);
}

TEST(TaskPriorityLawTest, TheTipItselfEvadesOnlyOnceTheRolesSwap) {
  EXPECT_NEAR(
      (Answer(Wide(), {0.3, 0}, {{Above(kTip, 0.9, 0.26, 2.0)}}) - Eigen::Vector2d(0.3, 0)).norm(),
      0.0, 1e-12);
  const Eigen::VectorXd u = Answer(Wide(), {0.3, 0}, {{Above(kTip, 0.9, 0.1, 2.0)}});
  EXPECT_NEAR(0.9 * u[0] + 0.4 * u[1], -1.9, 1e-12);
}

TEST(TaskPriorityLawTest, NeverHoldsBackARetreat) {
  EXPECT_EQ(Answer(Usual(), {-2, 0.3}, {{Above(kElbow, 0.5, -0.01)}}), Eigen::Vector2d(-2, 0.3));
}

TEST(TaskPriorityLawTest, RetreatsFromContactAndFromDeepPenetration) {
  for (const double distance : {0.0, -1e-9, -0.05, -0.4, -5.0}) {
    const Eigen::VectorXd u = Answer(Usual(), {1, 1}, {{Above(kElbow, 0.5, distance)}});
    const double asked = std::min(2.0 * (0.05 - distance), 0.5);
    EXPECT_NEAR(-0.5 * u[0], asked, 1e-12) << distance;
    EXPECT_NEAR(u[1], 1.0, 1e-12);
  }
}

TEST(TaskPriorityLawTest, ObstaclesOnEitherSideShareWhatCannotBeHad) {
  Proximity below = Mirrored(Above(kElbow, 0.5, 0.02));
  const Eigen::VectorXd u = Answer(Usual(), {0.5, 0}, {{Above(kElbow, 0.5, 0.02), below}});
  EXPECT_TRUE(u.allFinite());
  EXPECT_LT(std::fabs(0.5 * u[0]), 0.25);
}

TEST(TaskPriorityLawTest, KeepsTheTipOfASevenJointArmWhileNothingIsClose) {
  TaskPriorityLaw law = Wide();
  law.swap_distance = 0.15;
  for (const bool pose : {false, true}) {
    law.keeps_orientation = pose;
    Bench method(law, "lwr4");
    const auto& model = method.model();
    const auto X_WL = LinkPoses(model, BentArm());
    const Eigen::Vector3d elbow = X_WL[4].translation();
    const Eigen::Vector3d n = Eigen::Vector3d(1, 2, 0.5).normalized();
    const ProximitySet set{{Near("lwr4_link_4", elbow, 0.3, n, 0.7 * n)}};
    const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -0.05, 0.07);
    const Eigen::VectorXd change = method.Answer(BentArm(), wish, set) - wish;
    Matrix6X J(6, 7);
    LinkJacobian(model, X_WL, model.num_links() - 1, J);
    EXPECT_GT(change.norm(), 1e-2);
    const Eigen::VectorXd moved = J * change;
    EXPECT_LT(moved.head<3>().norm(), 1e-10);
    EXPECT_EQ(moved.norm() < 1e-10, pose);
  }
}

TEST(TaskPriorityLawTest, MovesWithTheWorld) {
  Eigen::Isometry3d X(Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()));
  X.translation() << 0.3, -1.0, 2.0;
  Bench here(Usual(), "lwr4");
  Bench there(Usual(), "lwr4", X);
  const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -0.5, 0.7);
  ProximitySet set = AroundBentArm(here.model(), 0.12);
  const Eigen::VectorXd u = here.Answer(BentArm(), wish, set);
  for (Proximity& proximity : set.proximities) proximity = Moved(X, proximity);
  EXPECT_NEAR((there.Answer(BentArm(), wish, set) - u).norm(), 0.0, 1e-9);
  EXPECT_GT((u - wish).norm(), 1e-2);
}

TEST(TaskPriorityLawTest, AMirroredSceneMirrorsTheMotion) {
  Bench method(Usual());
  const Eigen::Vector2d q(0.4, 0.7), wish(0.5, -0.2);
  const Proximity scene =
      Near(kTip, {0.7, 0.5, 0}, 0.12, Eigen::Vector3d(-0.6, -0.8, 0), {0, -0.5, 0});
  const Eigen::VectorXd u = method.Answer(q, wish, {{scene}});
  const Eigen::VectorXd mirrored = method.Answer(-q, -wish, {{Mirrored(scene)}});
  EXPECT_NEAR((u + mirrored).norm(), 0.0, 1e-12);
  EXPECT_GT((u - wish).norm(), 1e-2);
}

TEST(TaskPriorityLawTest, ChangesByABoundedAmountAsAnObstacleComesNear) {
  EXPECT_LT(SteepestChange(Usual()), 200.0);
}

TEST(TaskPriorityLawTest, DoesNotJumpAsTheListOfObstaclesChanges) {
  Bench method(Usual(), "lwr4");
  const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -0.5, 0.7);
  ProximitySet set = AroundBentArm(method.model(), 0.4 - 1e-5);
  set.proximities[1].obstacle_velocity = -2.0 * Eigen::Vector3d::UnitZ();
  const Eigen::VectorXd with = method.Answer(BentArm(), wish, set);
  set.proximities.erase(set.proximities.begin() + 1);
  EXPECT_NEAR((method.Answer(BentArm(), wish, set) - with).norm(), 0.0, 1e-5);
}

TEST(TaskPriorityLawTest, NoObstacleTakesMoreThanTheDampingLeaves) {
  // A change of the nearest feature may turn the normal at once; both answers are within this.
  const TaskPriorityLaw law = Usual();
  Bench method(law, "lwr4");
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(7);
  ProximitySet set = AroundBentArm(method.model(), 0.12);
  set.proximities = {set.proximities[1]};
  for (int i = 0; i < 100; ++i) {
    set.proximities[0].normal =
        Eigen::Vector3d(std::cos(0.3 * i), std::sin(0.3 * i), 0.1 * (i % 7)).normalized();
    const Eigen::VectorXd u = method.Answer(BentArm(), rest, set);
    EXPECT_LE(u.norm(), law.retreat_speed / law.damping.most);
  }
}

}  // namespace task_priority_law_test
}  // namespace oca::robot::test
