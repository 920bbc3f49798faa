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

FlaccoDeLuca::Params All() { return {.repulsion = FlaccoDeLucaMethod::Repulsion::kAll}; }

TEST(FlaccoDeLucaTest, PutsOutTheAnswerOfItsLawByHand) {
  // Risk 1/2 at half the influence distance: the tip leaves with 0.25 m/s, in -y.
  Bench method({});
  const Eigen::VectorXd rest = Eigen::Vector2d::Zero();
  const Eigen::VectorXd u = method.Answer(rest, rest, {{Above(kTip, 0.9, 0.2)}});
  EXPECT_NEAR((u + 0.25 / 0.97 * Eigen::Vector2d(0.9, 0.4)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(method.share(), 0.5, 1e-15);
  EXPECT_EQ(method.rows(), 1);
  EXPECT_EQ(method.Answer(rest, rest, {{Above(kElbow, 0.5, 0.2)}}), Eigen::Vector2d::Zero());
  EXPECT_NEAR(
      (Answer(All(), {0, 0}, {{Above(kElbow, 0.5, 0.2)}}) - Eigen::Vector2d(-0.5, 0)).norm(), 0.0,
      1e-12);
}

TEST(FlaccoDeLucaTest, EveryParameterReachesItsLaw) {
  const FlaccoDeLuca::Params params{
      "", "planar2_link_1", FlaccoDeLucaMethod::Repulsion::kAll, 1, 2, 3, 4, 5, 6};
  const auto model = LoadTestModel("planar2");
  const robot::FlaccoDeLucaLaw law =
      FlaccoDeLucaMethod::LawOf(FlaccoDeLucaMethod::Checked(params), *model);
  EXPECT_EQ(law.tip, model->FindLink("planar2_link_1"));
  EXPECT_TRUE(law.all_links);
  EXPECT_EQ(law.repulsion_speed, 1);
  EXPECT_EQ(law.influence_distance, 2);
  EXPECT_EQ(law.alpha, 3);
  EXPECT_EQ(law.max_joint_velocity, 4);
  EXPECT_EQ(law.damping.most, 5);
  EXPECT_EQ(law.damping.threshold, 6);
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
