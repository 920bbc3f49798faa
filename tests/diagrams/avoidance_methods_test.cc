// SPDX-License-Identifier: BSD-3-Clause
// What every method of avoidance has to keep in the report's two tests, one parameter away.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "diagrams/loader.h"
#include "diagrams/run.h"
#include "framework/dynamic_port.h"
#include "framework/port_access.h"
#include "framework/simulator.h"
#include "models/robot/robot_model.h"
#include "systems/motion_limiter.h"
#include "tests/allocation_count.h"

namespace oca::diagrams {
namespace {

struct Case {
  const char* method;
  const char* file;
  const char* jerk;  ///< of each joint, rad/s^3; nullptr: not limited
};

class AvoidanceMethodsTest : public testing::TestWithParam<Case> {
 protected:
  static LoadedDiagram Load(const Case& of) {
    std::vector<Override> overrides{{"parameters.avoidance", of.method},
                                    {"parameters.limit_motion", "true"},
                                    {"models.arm.acceleration_limits", "10"}};
    if (of.jerk != nullptr) overrides.push_back({"models.arm.jerk_limits", of.jerk});
    return LoadDiagram(OCA_SOURCE_DIR "/diagrams/" + std::string(of.file) + ".yaml", overrides);
  }
};

// Judged by the differences of the positions of the plant, tick by tick.
TEST_P(AvoidanceMethodsTest, NoTickViolatesALimitAndWhatWasClippedIsSaid) {
  const LoadedDiagram loaded = Load(GetParam());
  const auto model = loaded.models.Get("arm");
  Simulator simulator(*loaded.diagram, loaded.integrator);
  const OutputHandle position = loaded.diagram->FindSystem("plant")->FindOutput("position");
  const OutputHandle asked = loaded.diagram->FindSystem("overlay")->FindOutput("position");
  const OutputHandle sent = loaded.diagram->FindSystem("motion_limiter")->FindOutput("position");
  const Output<systems::MotionClips> clips{
      loaded.diagram->FindSystem("motion_limiter")->FindOutput("clips")};
  const auto at = [&](const OutputHandle& output) -> Eigen::VectorXd {
    const auto numbers = EvalVector(output, simulator.context());
    return Eigen::Map<const Eigen::VectorXd>(numbers.data(), std::ssize(numbers));
  };
  const double dt = 0.01;
  Eigen::VectorXd q = at(position);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(q.size());
  Eigen::VectorXd a = u;
  const auto within = [](const Eigen::VectorXd& x, const Eigen::VectorXd& limit) {
    return (x.cwiseAbs().array() <= limit.array() * (1 + 1e-6) + 1e-6).all();
  };
  const int ticks = static_cast<int>(loaded.simulator.duration / dt);
  for (int k = 1; k <= ticks; ++k) {
    simulator.AdvanceTo((k - 0.5) * dt);
    const auto& told = clips.Eval(simulator.context()).clips;
    const Eigen::VectorXd cut = at(sent) - at(asked);
    ASSERT_EQ(told.size(), (cut.array().abs() > 1e-12).count()) << k;
    for (const auto& clip : told) {
      ASSERT_NEAR(clip.amount, cut[clip.joint], 1e-15) << k;
      ASSERT_EQ(clip.yields, models::MotionLimit::kNone) << k;
    }
    simulator.AdvanceTo(k * dt);
    const Eigen::VectorXd next = at(position);
    const Eigen::VectorXd rate = (next - q) / dt;
    const Eigen::VectorXd change = (rate - u) / dt;
    ASSERT_TRUE((next.array() <= model->upper_limits().array() + 1e-9).all()) << k;
    ASSERT_TRUE((next.array() >= model->lower_limits().array() - 1e-9).all()) << k;
    ASSERT_TRUE(within(rate, model->velocity_limits())) << k;
    ASSERT_TRUE(within(change, model->acceleration_limits())) << k << " " << change.transpose();
    ASSERT_TRUE(within((change - a) / dt, model->jerk_limits())) << k;
    q = next;
    u = rate;
    a = change;
  }
}

/// Without jerk limits: with them a method may come later or nearer.
class WholeMotionTest : public AvoidanceMethodsTest {};

TEST_P(WholeMotionTest, EvadesArrivesAndTakesNothingFromTheHeap) {
  const LoadedDiagram loaded = Load(GetParam());
  const auto metrics = nlohmann::json::parse(diagrams::Run(loaded, {}).metrics);
  EXPECT_EQ(metrics.at("contact_time").get<double>(), 0.0);
  EXPECT_LT(metrics.at("final_error").get<double>(), 1e-3);
  if (GetParam().method != std::string("report")) {
    EXPECT_LT(metrics.at("delta_sign_changes_per_second").get<double>(), 0.5);
  }
  if (!kCountsAllocations) return;
  Simulator simulator(*loaded.diagram, loaded.integrator);
  simulator.Initialize();
  const std::int64_t before = AllocationCount();
  simulator.AdvanceTo(loaded.simulator.duration);
  EXPECT_EQ(AllocationCount(), before);
}

std::vector<Case> Cases(const std::vector<const char*>& jerks) {
  std::vector<Case> cases;
  for (const char* method : {"report", "relaxed", "velocity_aware", "vortex", "safety_filter"}) {
    for (const char* file : {"static_test", "dynamic_test"}) {
      for (const char* jerk : jerks) cases.push_back({method, file, jerk});
    }
  }
  return cases;
}

std::string NameOf(const testing::TestParamInfo<Case>& of) {
  return std::string(of.param.method) + "_" + of.param.file +
         (of.param.jerk == nullptr ? "" : "_jerk");
}

INSTANTIATE_TEST_SUITE_P(Methods, AvoidanceMethodsTest, testing::ValuesIn(Cases({nullptr, "300"})),
                         NameOf);
INSTANTIATE_TEST_SUITE_P(Methods, WholeMotionTest, testing::ValuesIn(Cases({nullptr})), NameOf);

}  // namespace
}  // namespace oca::diagrams
