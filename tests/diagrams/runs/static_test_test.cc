// SPDX-License-Identifier: BSD-3-Clause
// The report's two tests, with the figures of an independent implementation (on FCL and KDL): the
// path goes through the box; without limiter the request becomes insignificant; with it the arm
// avoids the box and still arrives; relaxation ends the chatter.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/result_json.h"
#include "oca/diagrams/runs/run.h"
#include "tests/allocation_count.h"

namespace oca::runs {
namespace static_test_test {

constexpr double kJointRange = 2.97;  // rad, of joint 1

struct Outcome {
  explicit Outcome(const std::vector<files::Override>& overrides,
                   const std::string& file = "static_test") {
    const RunResult result = runs::Run(
        loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/" + file + ".yaml", overrides), {});
    EXPECT_FALSE(result.failure) << result.failure->message;
    text = MetricsJson(result.metrics);
    metrics = nlohmann::json::parse(text);
  }
  double operator[](const char* metric) const { return metrics.at(metric).get<double>(); }
  std::string text;
  nlohmann::json metrics;
};

#define EXPECT_IN(value, low, high) \
  do {                              \
    EXPECT_GT(value, low);          \
    EXPECT_LT(value, high);         \
  } while (false)

const std::vector<files::Override> kAsItIs;
const files::Override kNoAvoidance{"parameters.avoid", "false"};
const files::Override kNoLimit{"parameters.limit_deltas", "false"};
const files::Override kTranspose{"parameters.jacobian_transpose_method_classic", "true"};

TEST(StaticTest, WithoutAvoidanceThePathGoesThroughTheBox) {
  const Outcome outcome({kNoAvoidance});
  EXPECT_NEAR(outcome["min_distance"], -0.122, 0.005);
  EXPECT_EQ(outcome.metrics.at("min_distance_pair").at(1), "box");
  EXPECT_IN(outcome["contact_time"], 1.0, 3.0);
  EXPECT_EQ(outcome["max_abs_delta"], 0.0);
  EXPECT_LT(outcome["final_error"], 1e-9);
  EXPECT_NEAR(outcome["total_variation_ratio"], 1.0, 1e-9);
}

TEST(StaticTest, WithListingA1TheArmStaysClearAndArrivesButChatters) {
  const Outcome outcome(kAsItIs);
  EXPECT_NEAR(outcome["min_distance"], 0.268, 0.01);
  EXPECT_NEAR(outcome["max_abs_delta"], 0.66, 0.05);
  EXPECT_LT(outcome["final_error"], 1e-3);
  EXPECT_IN(outcome["delta_sign_changes_per_second"], 15.0, 27.0);
  EXPECT_IN(outcome["total_variation_ratio"], 4.5, 8.5);
  EXPECT_EQ(outcome["contact_time"], 0.0);
}

TEST(StaticTest, WithTheTransposeTheArmStaysClearAndArrives) {
  const Outcome outcome({kTranspose});
  EXPECT_NEAR(outcome["min_distance"], 0.286, 0.01);
  EXPECT_NEAR(outcome["max_abs_delta"], 0.61, 0.05);
  EXPECT_LT(outcome["final_error"], 1e-3);
  EXPECT_IN(outcome["delta_sign_changes_per_second"], 8.0, 18.0);
  EXPECT_IN(outcome["total_variation_ratio"], 2.5, 4.5);
}

TEST(StaticTest, WithoutLimiterTheRequestBecomesInsignificant) {
  const Outcome outcome({kNoLimit});
  EXPECT_LT(outcome["min_distance"], -0.1);
  EXPECT_GT(outcome["max_abs_delta"], 1000.0 * kJointRange);
  EXPECT_IN(outcome["max_abs_delta"], 5e4, 1e6);  // 2.4e5, in a chaotic loop
  EXPECT_LT(outcome["final_error"], 1e-3);
  EXPECT_GT(outcome["total_variation_ratio"], 1e6);
  EXPECT_GT(outcome["delta_sign_changes_per_second"], 20.0);
}

TEST(StaticTest, WithoutLimiterTheTransposeIsWorse) {
  const Outcome outcome({kNoLimit, kTranspose});
  EXPECT_LT(outcome["min_distance"], -0.1);
  EXPECT_IN(outcome["max_abs_delta"], 4e5, 7e6);  // 1.7e6
  EXPECT_GT(outcome["total_variation_ratio"], 1e7);
}

TEST(StaticTest, RelaxationEndsTheChatterAtTheSameClearance) {
  for (const char* time : {"0.3", "0.4", "0.5"}) {
    const Outcome outcome({files::Override{"parameters.relaxation_time", time}});
    EXPECT_NEAR(outcome["min_distance"], 0.267, 0.005) << time;
    EXPECT_LT(outcome["delta_sign_changes_per_second"], 0.5) << time;
    EXPECT_NEAR(outcome["total_variation_ratio"], 2.5, 0.3) << time;
    EXPECT_LT(outcome["final_error"], 1e-3) << time;
  }
}

TEST(StaticTest, RelaxationCalmsTheLoopWithoutAnyLimiter) {
  const Outcome outcome({kNoLimit, files::Override{"parameters.relaxation_time", "0.4"}});
  EXPECT_GT(outcome["min_distance"], 0.2);
  EXPECT_LT(outcome["delta_sign_changes_per_second"], 1.0);
  EXPECT_LT(outcome["max_abs_delta"], kJointRange);
}

TEST(StaticTest, TheDynamicTestStaysClear) {
  const Outcome outcome(kAsItIs, "dynamic_test");
  EXPECT_GT(outcome["min_distance"], 0.05);
  EXPECT_EQ(outcome["contact_time"], 0.0);
  EXPECT_LT(Outcome({kNoAvoidance}, "dynamic_test")["min_distance"], 0.0);
}

TEST(StaticTest, TwoRunsGiveTheSameBits) {
  EXPECT_EQ(Outcome(kAsItIs).text, Outcome(kAsItIs).text);
  EXPECT_EQ(Outcome({kNoLimit, kTranspose}).text, Outcome({kNoLimit, kTranspose}).text);
  EXPECT_NE(Outcome(kAsItIs).text, Outcome({kTranspose}).text);
}

// The housings fill about what the capsules fill. Depth is that in one solid, and the fork of the
// forearm is slimmer than the capsule: 0.098 m instead of 0.122 m.
TEST(StaticTest, TheArmOfMeshesGoesThroughTheBoxAndEvadesItAlike) {
  const files::Override meshes{"parameters.arm_meshes", "true"};
  const Outcome through({meshes, kNoAvoidance});
  EXPECT_NEAR(through["min_distance"], -0.098, 0.005);
  const Outcome clear({meshes});
  EXPECT_NEAR(clear["min_distance"], 0.268, 0.01);
  EXPECT_LT(clear["final_error"], 1e-3);
}

// Listing A.1's switch: the frame of the static test pushes, and within its reach of 0.3 m for
// ever.
TEST(StaticTest, LinkForcesOfTheFrameAreFeltWhereTheyAreSwitchedOn) {
  const files::Override link_forces{"parameters.calculate_link_forces", "true"};
  const Outcome outcome({link_forces});
  EXPECT_EQ(outcome.metrics.at("min_distance_pair").at(1), "frame/table");
  EXPECT_IN(outcome["final_error"], 0.1, 0.25);
}

// Without the box in its gripper the requested motion is clear; with it, only if the arm evades.
TEST(GraspedBoxTest, TheBoxCollidesWhereTheArmAloneWouldNotAndEvadesWithIt) {
  const files::Override empty_hand{"models.arm.attached", "[]"};
  EXPECT_IN(Outcome({kNoAvoidance, empty_hand}, "grasped_box")["min_distance"], 0.005, 0.03);
  const Outcome carried({kNoAvoidance}, "grasped_box");
  EXPECT_NEAR(carried["min_distance"], -0.048, 0.005);
  EXPECT_EQ(carried.metrics.at("min_distance_pair").at(0), "grasped_box");
  EXPECT_EQ(Outcome(kAsItIs, "grasped_box")["contact_time"], 0.0);
}

TEST(StaticTest, RunsWithoutTheHeapFromInitializeToTheGoal) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const std::int64_t made = AllocationCount();
  ::operator delete(::operator new(64));
  ASSERT_EQ(AllocationCount(), made + 1);
  for (const char* file :
       {"static_test", "dynamic_test", "link_forces_test", "dual_arm", "grasped_box"}) {
    const loading::LoadedDiagram loaded =
        loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/" + std::string(file) + ".yaml");
    Simulator simulator(*loaded.diagram, loaded.simulator.integration);
    simulator.Initialize();
    const std::int64_t before = AllocationCount();
    simulator.AdvanceTo(loaded.simulator.duration);
    EXPECT_EQ(AllocationCount(), before) << file;
  }
}

}  // namespace static_test_test
}  // namespace oca::runs
