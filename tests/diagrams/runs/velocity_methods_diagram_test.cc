// SPDX-License-Identifier: BSD-3-Clause
// Task priority and the two baselines in whole loops.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/result_json.h"
#include "oca/diagrams/runs/run.h"

namespace oca::runs {
namespace velocity_methods_diagram_test {

nlohmann::json MetricsOf(const std::string& name, const std::vector<files::Override>& overrides) {
  const RunResult result =
      runs::Run(loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/" + name + ".yaml", overrides), {});
  EXPECT_FALSE(result.failure) << result.failure->message;
  return nlohmann::json::parse(MetricsJson(result.metrics));
}

double Metric(const nlohmann::json& metrics, const char* key) {
  return metrics.at(key).get<double>();
}

files::Override Method(const char* name) { return {"parameters.avoidance", name}; }

TEST(VelocityMethodsDiagramTest, TaskPriorityPassesTheBoxAndArrives) {
  const auto metrics = MetricsOf("static_test", {Method("task_priority")});
  EXPECT_GT(Metric(metrics, "min_distance"), 0.02);
  EXPECT_LT(Metric(metrics, "final_error"), 1e-6);
  EXPECT_LT(Metric(metrics, "delta_sign_changes_per_second"), 1.0);
}

TEST(VelocityMethodsDiagramTest, ServoScalingStopsBeforeTheBoxAndStays) {
  for (const char* approach_only : {"false", "true"}) {
    const auto metrics = MetricsOf(
        "static_test", {Method("servo_scaling"), {"parameters.approach_only", approach_only}});
    EXPECT_GT(Metric(metrics, "min_distance"), 0.02);
    EXPECT_LT(Metric(metrics, "min_distance"), 0.04);
    EXPECT_GT(Metric(metrics, "final_error"), 1.0);
  }
}

TEST(VelocityMethodsDiagramTest, ServoScalingDoesNotEvade) {
  const auto metrics = MetricsOf("dynamic_test", {Method("servo_scaling")});
  EXPECT_GT(Metric(metrics, "contact_time"), 0.5);
  EXPECT_EQ(Metric(metrics, "max_joint_acceleration"), 0.0);
}

TEST(VelocityMethodsDiagramTest, FlaccoAndDeLucaStayClearOfTheBox) {
  EXPECT_GT(Metric(MetricsOf("static_test", {Method("flacco")}), "min_distance"), 0.0);
}

TEST(VelocityMethodsDiagramTest, AllOfThemKeepTheAccelerationLimits) {
  for (const char* method : {"task_priority", "flacco", "servo_scaling"}) {
    for (const char* name : {"static_test", "dynamic_test"}) {
      const auto metrics = MetricsOf(name, {Method(method)});
      EXPECT_LE(Metric(metrics, "max_joint_acceleration"), 10.0 + 1e-6) << method << ' ' << name;
    }
  }
}

TEST(VelocityMethodsDiagramTest, WithoutAvoidanceTheyLeaveTheRequestAlone) {
  for (const char* method : {"task_priority", "flacco", "servo_scaling"}) {
    const auto metrics = MetricsOf("static_test", {Method(method), {"parameters.avoid", "false"}});
    EXPECT_LT(Metric(metrics, "min_distance"), -0.1) << method;
    EXPECT_LT(Metric(metrics, "final_error"), 1e-6) << method;
  }
}

}  // namespace velocity_methods_diagram_test
}  // namespace oca::runs
