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

/// In full from 0.5 m on, so that numbers are easy.
TaskPriority::Params Wide() { return {.activation_distance = 1.0}; }

Eigen::VectorXd Answer(const TaskPriority::Params& params, const Eigen::Vector2d& wish,
                       const ProximitySet& set) {
  return Bench(params).Answer(Eigen::Vector2d::Zero(), wish, set);
}

TEST(TaskPriorityTest, PutsOutTheAnswerOfItsLawByHand) {
  // The tip (0.9, 0.4) may not move in y; the elbow, at 0.3 m, has to leave with 0.5 m/s.
  Bench method(Wide());
  const Eigen::VectorXd rest = Eigen::Vector2d::Zero();
  const Eigen::VectorXd far = method.Answer(rest, rest, {{Above(kElbow, 0.5, 0.3, 1.0)}});
  EXPECT_NEAR((far - Eigen::Vector2d(-1.0, 2.25)).norm(), 0.0, 1e-12);
  EXPECT_EQ(method.share(), 0.0);
  const Eigen::VectorXd close = method.Answer(rest, rest, {{Above(kElbow, 0.5, 0.1, 1.0)}});
  EXPECT_NEAR((close - Eigen::Vector2d(-1.8, 0.0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(method.share(), 1.0);
  EXPECT_EQ(method.rows(), 1);
  EXPECT_EQ(method.Answer(rest, Eigen::Vector2d(0.5, -0.25), {}), Eigen::Vector2d(0.5, -0.25));
  EXPECT_EQ(method.rows(), 0);
}

TEST(TaskPriorityTest, EveryParameterReachesItsLaw) {
  const TaskPriority::Params params{
      "", "planar2_link_1", TaskPriorityMethod::TipTask::kPose, 1, 2, 3, 4, 6, 5, 7, 8};
  const auto model = LoadTestModel("planar2");
  const robot::TaskPriorityLaw law =
      TaskPriorityMethod::LawOf(TaskPriorityMethod::Checked(params), *model);
  EXPECT_EQ(law.tip, model->FindLink("planar2_link_1"));
  EXPECT_TRUE(law.keeps_orientation);
  EXPECT_EQ(law.safe_distance, 1);
  EXPECT_EQ(law.approach_gain, 2);
  EXPECT_EQ(law.retreat_speed, 3);
  EXPECT_EQ(law.activation_distance, 4);
  EXPECT_EQ(law.swap_distance, 6);
  EXPECT_EQ(law.contact_distance, 5);
  EXPECT_EQ(law.damping.most, 7);
  EXPECT_EQ(law.damping.threshold, 8);
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
