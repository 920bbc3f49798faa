// SPDX-License-Identifier: BSD-3-Clause
// The recommended method, an elastic band before a safety filter, in whole loops.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/result_json.h"
#include "oca/diagrams/runs/run.h"

namespace oca::runs {
namespace recommended_diagram_test {

nlohmann::json MetricsOf(const std::string& name, std::vector<files::Override> overrides) {
  overrides.push_back({"parameters.avoidance", "recommended"});
  const RunResult result =
      runs::Run(loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/" + name + ".yaml", overrides), {});
  EXPECT_FALSE(result.failure) << result.failure->message;
  return nlohmann::json::parse(MetricsJson(result.metrics));
}

double Number(const nlohmann::json& metrics, const char* key) {
  return metrics.at(key).get<double>();
}

TEST(RecommendedDiagramTest, PassesTheBoxOfTheStaticTestCalmlyAndArrives) {
  const auto metrics = MetricsOf("static_test", {});
  EXPECT_GT(Number(metrics, "certified_min_distance"), 0.045);
  EXPECT_LT(Number(metrics, "final_error"), 1e-9);
  EXPECT_LT(Number(metrics, "delta_sign_changes_per_second"), 0.5);
  EXPECT_LT(Number(metrics, "total_variation_ratio"), 1.5);
  EXPECT_LE(Number(metrics, "max_joint_acceleration"), 10.0 + 1e-6);
}

TEST(RecommendedDiagramTest, DucksInTimeUnderACubeThatComesHeadOnAndReturns) {
  for (const char* speed : {"0.2", "0.5", "1.0", "1.6"}) {
    const auto metrics = MetricsOf("dynamic_test", {{"parameters.obstacle_speed", speed}});
    EXPECT_GT(Number(metrics, "certified_min_distance"), 0.03) << speed;
    EXPECT_LT(Number(metrics, "final_error"), 1e-6) << speed;
    EXPECT_LT(Number(metrics, "delta_sign_changes_per_second"), 0.5) << speed;
    EXPECT_LE(Number(metrics, "max_joint_acceleration"), 10.0 + 1e-6) << speed;
  }
}

TEST(RecommendedDiagramTest, ClearsScenariosOfEveryFamilyAndArrives) {
  for (const char* family : {"random_static", "random_clutter"}) {
    for (const char* seed : {"25", "34"}) {  // where the filter alone comes near or stays behind
      const auto metrics =
          MetricsOf(std::string("scenarios/") + family, {{"simulator.seed", seed}});
      EXPECT_GT(Number(metrics, "certified_min_distance"), 0.0) << family << " " << seed;
      EXPECT_LT(Number(metrics, "final_error"), 0.01) << family << " " << seed;
    }
  }
}

TEST(RecommendedDiagramTest, IsNotBackTooEarlyForAFeintThatComesAgain) {
  const auto metrics = MetricsOf("scenarios/random_feint", {{"simulator.seed", "16"}});
  EXPECT_GT(Number(metrics, "certified_min_distance"), 0.0);
  EXPECT_LT(Number(metrics, "final_error"), 0.01);
}

TEST(RecommendedDiagramTest, TwoArmsPlanWithEachOther) {
  const auto metrics = MetricsOf("dual_arm", {});
  EXPECT_GT(Number(metrics, "certified_min_distance"), 0.1) << "0.028 by the filter alone";
  EXPECT_LT(Number(metrics, "final_error"), 1e-6);
  EXPECT_LT(Number(metrics, "delta_sign_changes_per_second"), 0.5);
}

TEST(RecommendedDiagramTest, RunsToTheSameBitsTwice) {
  EXPECT_EQ(MetricsOf("dynamic_test", {}), MetricsOf("dynamic_test", {}));
}

class Warnings final : public Log {
 public:
  bool enabled(LogLevel level) const override { return level == LogLevel::kWarning; }
  void Write(LogLevel level, double /*time*/, std::string_view text) override {
    if (level == LogLevel::kWarning) texts.emplace_back(text);
  }
  std::vector<std::string> texts;
};

TEST(RecommendedDiagramTest, TellsOfADistanceThatItKeepsOnlyIfItsDeltaIsApplied) {
  const auto warnings_of = [](const char* avoid) {
    Warnings warnings;
    runs::Run(loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/scenarios/start_near.yaml",
                                   {{"parameters.avoid", avoid}}),
              {.duration = 0.6, .log = &warnings});
    return warnings.texts;
  };
  EXPECT_THAT(warnings_of("true"),
              testing::Contains(testing::HasSubstr("its own distance is kept there")));
  EXPECT_THAT(warnings_of("false"), testing::IsEmpty());
}

}  // namespace recommended_diagram_test
}  // namespace oca::runs
