// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/flacco_de_luca.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "tests/allocation_count.h"
#include "tests/systems/method_scene.h"

namespace oca::systems {
namespace flacco_de_luca_test {

using Bench = MethodBench<FlaccoDeLuca>;
constexpr const char* kElbow = "planar2_link_1";
constexpr const char* kTip = "planar2_link_2";

Eigen::VectorXd Answer(const FlaccoDeLuca::Params& params, const Eigen::Vector2d& wish,
                       const ProximitySet& set) {
  return Bench(params).Answer(Eigen::Vector2d::Zero(), wish, set);
}

FlaccoDeLuca::Params All() { return {.repulsion = FlaccoDeLucaLaw::Repulsion::kAll}; }

TEST(FlaccoDeLucaTest, TheRiskIsThePublishedSigmoid) {
  const FlaccoDeLucaLaw system({}, TestModels("planar2"));
  EXPECT_NEAR(system.Risk(0.2), 0.5, 1e-15);
  EXPECT_NEAR(system.Risk(0.0), 0.9975273768, 1e-10);
  EXPECT_NEAR(system.Risk(0.4), 0.0024726232, 1e-10);
  EXPECT_NEAR(system.Risk(0.1), 1.0 / (1.0 + std::exp(-3.0)), 1e-15);
}

TEST(FlaccoDeLucaTest, TheSlopeOfTheRiskIsThatOfItsFormula) {
  const FlaccoDeLucaLaw system({}, TestModels("planar2"));
  for (const double d : {-0.05, 0.0, 0.1, 0.2, 0.39}) {
    const double step = 1e-6;
    const double numeric = (system.Risk(d + step) - system.Risk(d - step)) / (2 * step);
    const double risk = system.Risk(d);
    EXPECT_NEAR(numeric, -2.0 * 6.0 / 0.4 * risk * (1.0 - risk), 1e-8) << d;
  }
}

TEST(FlaccoDeLucaTest, GrantsARequestThatNothingIsNear) {
  EXPECT_EQ(Answer({}, {0.5, -0.25}, {}), Eigen::Vector2d(0.5, -0.25));
  EXPECT_EQ(Answer({}, {0.5, -0.25}, {{Above(kTip, 0.9, 0.41)}}), Eigen::Vector2d(0.5, -0.25));
}

TEST(FlaccoDeLucaTest, RepulsesTheTipByHand) {
  // Risk 1/2 at half the influence distance: the tip leaves with 0.25 m/s, in -y.
  const Eigen::VectorXd u = Answer({}, {0, 0}, {{Above(kTip, 0.9, 0.2)}});
  EXPECT_NEAR((u + 0.25 / 0.97 * Eigen::Vector2d(0.9, 0.4)).norm(), 0.0, 1e-12);
}

TEST(FlaccoDeLucaTest, TakesSpeedFromTheJointsThatLeadTheElbowToAnObstacle) {
  // Half of 2 rad/s is left to joint 1 upwards, all of it downwards; joint 2 does not matter.
  const ProximitySet set{{Above(kElbow, 0.5, 0.2)}};
  EXPECT_NEAR((Answer({}, {1.5, 0.4}, set) - Eigen::Vector2d(1.0, 0.4)).norm(), 0.0, 1e-12);
  EXPECT_EQ(Answer({}, {-1.5, 0.4}, set), Eigen::Vector2d(-1.5, 0.4));
  EXPECT_EQ(Answer({}, {0.99, 0.4}, set), Eigen::Vector2d(0.99, 0.4));
}

TEST(FlaccoDeLucaTest, TheOtherJointsTakeOverWhatABoundTakes) {
  // Joint 1 may not rise any faster than 0.005 rad/s, but the tip is pushed up.
  const ProximitySet set{{Above(kElbow, 0.5, 0.0), Mirrored(Above(kTip, 0.9, 0.2))}};
  const Eigen::VectorXd u = Answer({}, {0, 0}, set);
  EXPECT_NEAR(0.9 * u[0] + 0.4 * u[1], 0.25, 1e-12);
  EXPECT_NEAR(u[0], 2.0 * (1.0 - 0.9975273768), 1e-9);
}

TEST(FlaccoDeLucaTest, RepulsesEveryLinkIfAsked) {
  const ProximitySet set{{Above(kElbow, 0.5, 0.2)}};
  EXPECT_EQ(Answer({}, {0, 0}, set), Eigen::Vector2d::Zero());
  EXPECT_NEAR((Answer(All(), {0, 0}, set) - Eigen::Vector2d(-0.5, 0)).norm(), 0.0, 1e-12);
}

TEST(FlaccoDeLucaTest, TurnsFromAllButRunsFromTheNearest) {
  // Two obstacles at the same distance, above and above right: between them, at the same speed.
  Proximity right = Above(kTip, 0.9, 0.2);
  right.normal = Eigen::Vector3d(-1, 0, 0);
  const Eigen::VectorXd u = Answer({}, {0, 0}, {{Above(kTip, 0.9, 0.2), right}});
  EXPECT_NEAR(0.9 * u[0] + 0.4 * u[1], -0.25 * std::sqrt(0.5), 1e-12);
}

TEST(FlaccoDeLucaTest, IsFiniteBetweenOpposedObstacles) {
  const Proximity above = Above(kTip, 0.9, 0.1);
  EXPECT_TRUE(Answer({}, {0.2, 0}, {{above, Mirrored(above)}}).allFinite());
}

TEST(FlaccoDeLucaTest, RetreatsFromContactAndFromDeepPenetration) {
  for (const double distance : {0.0, -1e-9, -0.05, -0.4, -100.0}) {
    const Eigen::VectorXd u = Answer({}, {0, 0}, {{Above(kTip, 0.9, distance)}});
    const double speed = 0.9 * u[0] + 0.4 * u[1];
    EXPECT_LE(speed, -0.997 * 0.5) << distance;
    EXPECT_GE(speed, -0.5 - 1e-12) << distance;
    // And what is asked for in this direction is granted.
    EXPECT_EQ(Answer({}, {-1, 0}, {{Above(kElbow, 0.5, distance)}}), Eigen::Vector2d(-1, 0));
  }
}

TEST(FlaccoDeLucaTest, KeepsTheJointSpeedsWhateverComes) {
  FlaccoDeLuca::Params params = All();
  params.repulsion_speed = 20.0;
  Bench method(params, "lwr4");
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -5.0, 0.2 * i);
    const Eigen::VectorXd u =
        method.Answer(BentArm(), wish, AroundBentArm(method.model(), 0.4 - 0.02 * i));
    EXPECT_LE(u.lpNorm<Eigen::Infinity>(), 2.0);
  }
}

TEST(FlaccoDeLucaTest, MovesWithTheWorld) {
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

TEST(FlaccoDeLucaTest, AMirroredSceneMirrorsTheMotion) {
  Bench method({});
  const Eigen::Vector2d q(0.4, 0.7), wish(0.5, -0.2);
  const Proximity tip = Near(kTip, {0.7, 0.5, 0}, 0.12, Eigen::Vector3d(-0.6, -0.8, 0));
  const Proximity elbow = Near(kElbow, {0.4, 0.2, 0}, 0.1, Eigen::Vector3d(0, -1, 0));
  const Eigen::VectorXd u = method.Answer(q, wish, {{tip, elbow}});
  const Eigen::VectorXd mirrored = method.Answer(-q, -wish, {{Mirrored(tip), Mirrored(elbow)}});
  EXPECT_NEAR((u + mirrored).norm(), 0.0, 1e-12);
  EXPECT_GT((u - wish).norm(), 1e-2);
}

TEST(FlaccoDeLucaTest, ChangesByABoundedAmountAsAnObstacleComesNear) {
  // rad/s within 0.1 mm: which joint is held first changes at once, as in the published algorithm.
  EXPECT_LT(SteepestChange<FlaccoDeLuca>({}) * 1e-4, 0.3);
}

TEST(FlaccoDeLucaTest, AnObstacleThatEntersHasLittleSay) {
  const ProximitySet set{{Above(kTip, 0.9, 0.2)}};
  ProximitySet more = set;
  more.proximities.push_back(Mirrored(Above(kTip, 0.9, 0.4 - 1e-9)));
  EXPECT_NEAR((Answer({}, {0.1, 0}, set) - Answer({}, {0.1, 0}, more)).norm(), 0.0, 5e-3);
}

TEST(FlaccoDeLucaTest, RefusesWhatItCannotUse) {
  const auto make = [](auto&& change) {
    FlaccoDeLuca::Params params;
    change(params);
    FlaccoDeLuca{params, TestModels("planar2")};
  };
  EXPECT_NO_THROW(make([](auto& p) { p.repulsion_speed = 0.0; }));
  EXPECT_THROW(make([](auto& p) { p.repulsion_speed = -0.1; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.tip = "nose"; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.influence_distance = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.alpha = std::nan(""); }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.max_joint_velocity = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.most_damping = 0.0; }), ConfigError);
  EXPECT_THROW(Answer({}, {0, 0}, {{Above("lwr4_link_3", 0.5, 0.1)}}), SimulationError);
}

TEST(FlaccoDeLucaTest, TicksWithoutTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  Bench method(All(), "lwr4");
  const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -0.5, 0.7);
  const ProximitySet set = AroundBentArm(method.model(), 0.12);
  method.Answer(BentArm(), wish, set);
  auto& bench = method.bench();
  bench->proximities.Fix(bench.context(), set);
  const std::int64_t before = AllocationCount();
  bench->velocity.Eval(bench.context());
  EXPECT_EQ(AllocationCount(), before);
}

}  // namespace flacco_de_luca_test
}  // namespace oca::systems
