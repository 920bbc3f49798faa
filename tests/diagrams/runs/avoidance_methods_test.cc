// SPDX-License-Identifier: BSD-3-Clause
// What every method of avoidance has to keep in the report's two tests, one parameter away.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "oca/diagrams/runs/result_json.h"
#include "oca/diagrams/runs/run.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/plants/motion_limiter.h"
#include "tests/allocation_count.h"
#include "tests/diagrams/runs/method_run.h"

namespace oca::runs {
namespace avoidance_methods_test {

struct Case {
  std::string method;
  std::string file;
  const char* speed;  ///< of the cube, m/s; nullptr: as the file says
  const char* jerk;   ///< of each joint, rad/s^3; nullptr: not limited
};

std::vector<files::Override> OverridesOf(const Case& of) {
  std::vector<files::Override> overrides{{"parameters.limit_motion", "true"},
                                         {"models.arm.acceleration_limits", "10"}};
  if (of.speed != nullptr) overrides.push_back({"parameters.obstacle_speed", of.speed});
  if (of.jerk != nullptr) overrides.push_back({"models.arm.jerk_limits", of.jerk});
  return overrides;
}

class LimitsTest : public testing::TestWithParam<Case> {};

// Judged by the differences of the positions of the plant, tick by tick.
TEST_P(LimitsTest, NoTickViolatesOneAndWhatWasClippedIsSaid) {
  MethodRun run(GetParam().file, GetParam().method, OverridesOf(GetParam()));
  const auto model = run.loaded().models.Get("arm");
  const double dt = 0.01;
  Eigen::VectorXd q = run.Vector("plant", "position");
  Eigen::VectorXd u = Eigen::VectorXd::Zero(q.size());
  Eigen::VectorXd a = u;
  const auto within = [](const Eigen::VectorXd& x, const Eigen::VectorXd& limit) {
    return (x.cwiseAbs().array() <= limit.array() * (1 + 1e-6) + 1e-6).all();
  };
  const int ticks = static_cast<int>(run.loaded().simulator.duration / dt);
  for (int k = 1; k <= ticks; ++k) {
    run.AdvanceTo((k - 0.5) * dt);
    const auto& told = run.Eval<systems::MotionClips>("motion_limiter", "clips").clips;
    const Eigen::VectorXd cut =
        run.Vector("motion_limiter", "position") - run.Vector("overlay", "position");
    ASSERT_EQ(told.size(), (cut.array().abs() > 1e-12).count()) << k;
    for (const auto& clip : told) {
      ASSERT_NEAR(clip.amount, cut[clip.joint], 1e-15) << k;
      ASSERT_EQ(clip.yields, motion::MotionLimit::kNone) << k;
    }
    run.AdvanceTo(k * dt);
    const Eigen::VectorXd next = run.Vector("plant", "position");
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

/// Those that evade and arrive in both of the report's tests; without jerk limits, with which a
/// method may come later or nearer.
class WholeMotionTest : public testing::TestWithParam<Case> {};

TEST_P(WholeMotionTest, EvadesArrivesAndTakesNothingFromTheHeap) {
  MethodRun run(GetParam().file, GetParam().method, OverridesOf(GetParam()));
  const auto metrics = nlohmann::json::parse(MetricsJson(runs::Run(run.loaded(), {}).metrics));
  EXPECT_EQ(metrics.at("contact_time").get<double>(), 0.0);
  EXPECT_LT(metrics.at("final_error").get<double>(), 1e-3);
  if (GetParam().method != "report") {
    EXPECT_LT(metrics.at("delta_sign_changes_per_second").get<double>(), 0.5);
  }
  if (!kCountsAllocations) return;
  run.Initialize();
  const std::int64_t before = AllocationCount();
  run.AdvanceTo(run.loaded().simulator.duration);
  EXPECT_EQ(AllocationCount(), before);
}

std::vector<Case> Evasions(const std::vector<std::string>& methods) {
  std::vector<Case> cases;
  for (const std::string& method : methods) {
    cases.push_back({method, "static_test", nullptr, nullptr});
    cases.push_back({method, "dynamic_test", nullptr, nullptr});
  }
  return cases;
}

std::vector<Case> LimitCases() {
  std::vector<Case> cases = Evasions(Methods());
  for (const std::string& method : Methods()) {
    cases.push_back({method, "static_test", nullptr, "300"});
    cases.push_back({method, "dynamic_test", "1.0", nullptr});
    cases.push_back({method, "dynamic_test", "1.0", "300"});
  }
  return cases;
}

std::string NameOf(const testing::TestParamInfo<Case>& of) {
  return of.param.method + "_" + of.param.file + (of.param.speed == nullptr ? "" : "_fast") +
         (of.param.jerk == nullptr ? "" : "_jerk");
}

INSTANTIATE_TEST_SUITE_P(Methods, LimitsTest, testing::ValuesIn(LimitCases()), NameOf);
INSTANTIATE_TEST_SUITE_P(Methods, WholeMotionTest,
                         testing::ValuesIn(Evasions({"report", "relaxed", "velocity_aware",
                                                     "vortex", "safety_filter"})),
                         NameOf);

}  // namespace avoidance_methods_test
}  // namespace oca::runs
