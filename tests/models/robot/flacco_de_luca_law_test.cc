// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/flacco_de_luca_law.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/models/robot/law_scene.h"

namespace oca::robot::test {
namespace flacco_de_luca_law_test {

using Bench = LawBench<FlaccoDeLucaLaw>;
constexpr const char* kElbow = "planar2_link_1";
constexpr const char* kTip = "planar2_link_2";

/// As FlaccoDeLuca has it by default; LawBench sets the tip.
FlaccoDeLucaLaw Usual() {
  return {.tip = 0,
          .all_links = false,
          .repulsion_speed = 0.5,
          .influence_distance = 0.4,
          .alpha = 6.0,
          .max_joint_velocity = 2.0,
          .damping = {0.05, 0.1}};
}

FlaccoDeLucaLaw All() {
  FlaccoDeLucaLaw law = Usual();
  law.all_links = true;
  return law;
}

Eigen::VectorXd Answer(const FlaccoDeLucaLaw& law, const Eigen::Vector2d& wish,
                       const ProximitySet& set) {
  return Bench(law).Answer(Eigen::Vector2d::Zero(), wish, set);
}

TEST(FlaccoDeLucaLawTest, TheRiskIsThePublishedSigmoid) {
  const FlaccoDeLucaLaw law = Usual();
  EXPECT_NEAR(law.Risk(0.2), 0.5, 1e-15);
  EXPECT_NEAR(law.Risk(0.0), 0.9975273768, 1e-10);
  EXPECT_NEAR(law.Risk(0.4), 0.0024726232, 1e-10);
  EXPECT_NEAR(law.Risk(0.1), 1.0 / (1.0 + std::exp(-3.0)), 1e-15);
}

TEST(FlaccoDeLucaLawTest, TheSlopeOfTheRiskIsThatOfItsFormula) {
  const FlaccoDeLucaLaw law = Usual();
  for (const double d : {-0.05, 0.0, 0.1, 0.2, 0.39}) {
    const double step = 1e-6;
    const double numeric = (law.Risk(d + step) - law.Risk(d - step)) / (2 * step);
    const double risk = law.Risk(d);
    EXPECT_NEAR(numeric, -2.0 * 6.0 / 0.4 * risk * (1.0 - risk), 1e-8) << d;
  }
}

TEST(FlaccoDeLucaLawTest, GrantsARequestThatNothingIsNear) {
  EXPECT_EQ(Answer(Usual(), {0.5, -0.25}, {}), Eigen::Vector2d(0.5, -0.25));
  EXPECT_EQ(Answer(Usual(), {0.5, -0.25}, {{Above(kTip, 0.9, 0.41)}}), Eigen::Vector2d(0.5, -0.25));
}

TEST(FlaccoDeLucaLawTest, RepulsesTheTipByHand) {
  // Risk 1/2 at half the influence distance: the tip leaves with 0.25 m/s, in -y.
  const Eigen::VectorXd u = Answer(Usual(), {0, 0}, {{Above(kTip, 0.9, 0.2)}});
  EXPECT_NEAR((u + 0.25 / 0.97 * Eigen::Vector2d(0.9, 0.4)).norm(), 0.0, 1e-12);
}

TEST(FlaccoDeLucaLawTest, TakesSpeedFromTheJointsThatLeadTheElbowToAnObstacle) {
  // Half of 2 rad/s is left to joint 1 upwards, all of it downwards; joint 2 does not matter.
  const ProximitySet set{{Above(kElbow, 0.5, 0.2)}};
  EXPECT_NEAR((Answer(Usual(), {1.5, 0.4}, set) - Eigen::Vector2d(1.0, 0.4)).norm(), 0.0, 1e-12);
  EXPECT_EQ(Answer(Usual(), {-1.5, 0.4}, set), Eigen::Vector2d(-1.5, 0.4));
  EXPECT_EQ(Answer(Usual(), {0.99, 0.4}, set), Eigen::Vector2d(0.99, 0.4));
}

TEST(FlaccoDeLucaLawTest, TheOtherJointsTakeOverWhatABoundTakes) {
  // Joint 1 may not rise any faster than 0.005 rad/s, but the tip is pushed up.
  const ProximitySet set{{Above(kElbow, 0.5, 0.0), Mirrored(Above(kTip, 0.9, 0.2))}};
  const Eigen::VectorXd u = Answer(Usual(), {0, 0}, set);
  EXPECT_NEAR(0.9 * u[0] + 0.4 * u[1], 0.25, 1e-12);
  EXPECT_NEAR(u[0], 2.0 * (1.0 - 0.9975273768), 1e-9);
}

TEST(FlaccoDeLucaLawTest, RepulsesEveryLinkIfAsked) {
  const ProximitySet set{{Above(kElbow, 0.5, 0.2)}};
  EXPECT_EQ(Answer(Usual(), {0, 0}, set), Eigen::Vector2d::Zero());
  EXPECT_NEAR((Answer(All(), {0, 0}, set) - Eigen::Vector2d(-0.5, 0)).norm(), 0.0, 1e-12);
}

TEST(FlaccoDeLucaLawTest, TurnsFromAllButRunsFromTheNearest) {
  // Two obstacles at the same distance, above and above right: between them, at the same speed.
  Proximity right = Above(kTip, 0.9, 0.2);
  right.normal = Eigen::Vector3d(-1, 0, 0);
  const Eigen::VectorXd u = Answer(Usual(), {0, 0}, {{Above(kTip, 0.9, 0.2), right}});
  EXPECT_NEAR(0.9 * u[0] + 0.4 * u[1], -0.25 * std::sqrt(0.5), 1e-12);
}

TEST(FlaccoDeLucaLawTest, IsFiniteBetweenOpposedObstacles) {
  const Proximity above = Above(kTip, 0.9, 0.1);
  EXPECT_TRUE(Answer(Usual(), {0.2, 0}, {{above, Mirrored(above)}}).allFinite());
}

TEST(FlaccoDeLucaLawTest, RetreatsFromContactAndFromDeepPenetration) {
  for (const double distance : {0.0, -1e-9, -0.05, -0.4, -100.0}) {
    const Eigen::VectorXd u = Answer(Usual(), {0, 0}, {{Above(kTip, 0.9, distance)}});
    const double speed = 0.9 * u[0] + 0.4 * u[1];
    EXPECT_LE(speed, -0.997 * 0.5) << distance;
    EXPECT_GE(speed, -0.5 - 1e-12) << distance;
    // And what is asked for in this direction is granted.
    EXPECT_EQ(Answer(Usual(), {-1, 0}, {{Above(kElbow, 0.5, distance)}}), Eigen::Vector2d(-1, 0));
  }
}

TEST(FlaccoDeLucaLawTest, KeepsTheJointSpeedsWhateverComes) {
  FlaccoDeLucaLaw law = All();
  law.repulsion_speed = 20.0;
  Bench method(law, "lwr4");
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -5.0, 0.2 * i);
    const Eigen::VectorXd u =
        method.Answer(BentArm(), wish, AroundBentArm(method.model(), 0.4 - 0.02 * i));
    EXPECT_LE(u.lpNorm<Eigen::Infinity>(), 2.0);
  }
}

TEST(FlaccoDeLucaLawTest, MovesWithTheWorld) {
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

TEST(FlaccoDeLucaLawTest, AMirroredSceneMirrorsTheMotion) {
  Bench method(Usual());
  const Eigen::Vector2d q(0.4, 0.7), wish(0.5, -0.2);
  const Proximity tip = Near(kTip, {0.7, 0.5, 0}, 0.12, Eigen::Vector3d(-0.6, -0.8, 0));
  const Proximity elbow = Near(kElbow, {0.4, 0.2, 0}, 0.1, Eigen::Vector3d(0, -1, 0));
  const Eigen::VectorXd u = method.Answer(q, wish, {{tip, elbow}});
  const Eigen::VectorXd mirrored = method.Answer(-q, -wish, {{Mirrored(tip), Mirrored(elbow)}});
  EXPECT_NEAR((u + mirrored).norm(), 0.0, 1e-12);
  EXPECT_GT((u - wish).norm(), 1e-2);
}

TEST(FlaccoDeLucaLawTest, ChangesByABoundedAmountAsAnObstacleComesNear) {
  // rad/s within 0.1 mm: which joint is held first changes at once, as in the published algorithm.
  EXPECT_LT(SteepestChange(Usual()) * 1e-4, 0.3);
}

TEST(FlaccoDeLucaLawTest, AnObstacleThatEntersHasLittleSay) {
  const ProximitySet set{{Above(kTip, 0.9, 0.2)}};
  ProximitySet more = set;
  more.proximities.push_back(Mirrored(Above(kTip, 0.9, 0.4 - 1e-9)));
  EXPECT_NEAR((Answer(Usual(), {0.1, 0}, set) - Answer(Usual(), {0.1, 0}, more)).norm(), 0.0, 5e-3);
}

}  // namespace flacco_de_luca_law_test
}  // namespace oca::robot::test
