// SPDX-License-Identifier: BSD-3-Clause
// The safety filter in the report's two tests, with real distances: boxes, whose faces are flat.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/result_json.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"
#include "oca/systems/plants/motion_limiter.h"
#include "oca/systems/signals/filter_activity.h"
#include "tests/allocation_count.h"

namespace oca::runs {
namespace safety_filter_diagram_test {

std::string FileOf(const std::string& name) { return OCA_SOURCE_DIR "/diagrams/" + name + ".yaml"; }

nlohmann::json MetricsOf(const std::string& name, const std::vector<files::Override>& overrides) {
  const RunResult result = runs::Run(loading::LoadDiagram(FileOf(name), overrides), {});
  EXPECT_FALSE(result.failure) << result.failure->message;
  return nlohmann::json::parse(MetricsJson(result.metrics));
}

const files::Override kFilter{"parameters.avoidance", "safety_filter"};

TEST(SafetyFilterDiagramTest, OneParameterPutsItInThePlaceOfTheReportsChain) {
  for (const char* form : {"linear", "braking"}) {
    const auto metrics =
        MetricsOf("static_test", {kFilter, files::Override{"parameters.approach_form", form}});
    EXPECT_NEAR(metrics.at("min_distance").get<double>(), 0.05, 0.002) << form;
    EXPECT_LT(metrics.at("final_error").get<double>(), 1e-9) << form;
    EXPECT_LT(metrics.at("delta_sign_changes_per_second").get<double>(), 0.5) << form;
    EXPECT_LT(metrics.at("total_variation_ratio").get<double>(), 1.5) << form;
    EXPECT_LE(metrics.at("max_joint_acceleration").get<double>(), 10.0 + 1e-6) << form;
  }
}

TEST(SafetyFilterDiagramTest, WithoutAvoidanceTheArmGoesThroughTheBoxWithinItsLimits) {
  const auto metrics =
      MetricsOf("static_test", {kFilter, files::Override{"parameters.avoid", "false"}});
  EXPECT_LT(metrics.at("min_distance").get<double>(), -0.1);
  EXPECT_LE(metrics.at("max_joint_acceleration").get<double>(), 10.0 + 1e-6);
}

TEST(SafetyFilterDiagramTest, KeepsTheDistanceThatItIsAskedFor) {
  for (const char* distance : {"0.02", "0.1"}) {
    const auto metrics =
        MetricsOf("static_test", {kFilter, files::Override{"parameters.safe_distance", distance}});
    EXPECT_NEAR(metrics.at("min_distance").get<double>(), std::stod(distance), 0.002);
  }
}

TEST(SafetyFilterDiagramTest, SurvivesACubeThatComesHeadOn) {
  for (const char* speed : {"0.5", "1.0", "1.6"}) {
    const files::Override fast{"parameters.obstacle_speed", speed};
    const auto metrics = MetricsOf("dynamic_test", {kFilter, fast});
    EXPECT_EQ(metrics.at("contact_time").get<double>(), 0.0) << speed;
    EXPECT_GT(metrics.at("min_distance").get<double>(), 0.02) << speed;
    EXPECT_LT(metrics.at("final_error").get<double>(), 1e-6) << speed;
    EXPECT_LE(metrics.at("max_joint_acceleration").get<double>(), 10.0 + 1e-6) << speed;
    // What the report's loop does not.
    EXPECT_GT(MetricsOf("dynamic_test", {fast}).at("contact_time").get<double>(), 0.0) << speed;
  }
}

/// Runs tick by tick; look(activity, clips) at each.
template <class Look>
void Watch(const std::string& name, const Look& look) {
  const loading::LoadedDiagram loaded = loading::LoadDiagram(FileOf(name));
  Simulator simulator(*loaded.diagram, loaded.simulator.integration);
  const auto activity = loaded.diagram->FindSystem("filter")->FindOutput("activity");
  const auto clips = loaded.diagram->FindSystem("motion_limiter")->FindOutput("clips");
  for (int k = 0; k < 1400; ++k) {
    simulator.AdvanceTo((k + 0.5) * 0.01);
    look(Typed<systems::FilterActivity>(activity).Eval(simulator.context()),
         Typed<systems::MotionClips>(clips).Eval(simulator.context()));
  }
}

TEST(SafetyFilterDiagramTest, EveryAnswerIsProvedAndNothingIsLeftToClip) {
  for (const char* name : {"safety_filter_static", "safety_filter_head_on"}) {
    int held_back = 0;
    Watch(name, [&](const systems::FilterActivity& activity, const systems::MotionClips& clips) {
      ASSERT_EQ(activity.status, qp::QpStatus::kOptimal);
      ASSERT_LT(activity.kkt_residual, 1e-9);
      ASSERT_EQ(activity.yields, 0);
      ASSERT_EQ(activity.dropped, 0);
      for (const auto& clip : clips.clips) ASSERT_LT(std::fabs(clip.amount), 1e-9);
      held_back += activity.num_bounds > 0 ? 1 : 0;
    });
    EXPECT_GT(held_back, 50) << name;
  }
}

TEST(SafetyFilterDiagramTest, InTheStaticTestNoRowTakesSlackAndTheBoxIsNamed) {
  bool named = false;
  Watch("safety_filter_static", [&](const systems::FilterActivity& activity, const auto&) {
    ASSERT_EQ(activity.slack, 0.0);
    for (int b = 0; b < activity.num_bounds; ++b) {
      named |= activity.bounds[b].kind == systems::FilterBound::Kind::kDistance &&
               activity.bounds[b].obstacle.text() == "box";
    }
  });
  EXPECT_TRUE(named);
}

TEST(SafetyFilterDiagramTest, TakesNoMoreFromTheHeapThanTheReportsChain) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const auto taken = [](const std::string& name) {
    const loading::LoadedDiagram loaded = loading::LoadDiagram(FileOf(name));
    Simulator simulator(*loaded.diagram, loaded.simulator.integration);
    simulator.Initialize();
    const std::int64_t before = AllocationCount();
    simulator.AdvanceTo(loaded.simulator.duration);
    return AllocationCount() - before;
  };
  EXPECT_LE(taken("safety_filter_static"), taken("static_test"));
  EXPECT_LE(taken("safety_filter_head_on"), taken("dynamic_test"));
}

TEST(SafetyFilterDiagramTest, TwoRunsGiveTheSameBits) {
  EXPECT_EQ(MetricsOf("safety_filter_static", {}), MetricsOf("safety_filter_static", {}));
}

}  // namespace safety_filter_diagram_test
}  // namespace oca::runs
