// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/delta_overlay.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace delta_overlay_test {

Eigen::VectorXd One(double value) { return Eigen::VectorXd::Constant(1, value); }

/// An overlay whose optional velocity is connected too.
struct OverlayBench {
  explicit OverlayBench(const DeltaOverlay::Params& params) {
    DiagramBuilder builder;
    overlay = &builder.Add<DeltaOverlay>("overlay", params);
    builder.ExportInput("request", overlay->request);
    builder.ExportInput("request_velocity", overlay->request_velocity);
    builder.ExportInput("delta", overlay->delta);
    diagram = builder.Build();
    simulator = std::make_unique<Simulator>(*diagram);
    Fix("request", 1.0);
    Fix("request_velocity", 2.0);
    Fix("delta", 0.0);
  }
  void Fix(const char* name, double value) {
    diagram->GetInput<Vector>(name).Fix(simulator->context(), One(value));
  }
  double position() { return overlay->position.Eval(simulator->context())[0]; }
  double velocity() { return overlay->velocity.Eval(simulator->context())[0]; }

  const DeltaOverlay* overlay;
  std::unique_ptr<Diagram> diagram;
  std::unique_ptr<Simulator> simulator;
};

TEST(DeltaOverlayTest, AddsTheDeltaToThePosition) {
  OverlayBench bench({.period = Period(1, 100)});
  bench.Fix("delta", 0.25);
  EXPECT_EQ(bench.position(), 1.25);
}

TEST(DeltaOverlayTest, AddsTheRateOverTheLastPeriodToTheVelocity) {
  OverlayBench bench({.period = Period(1, 100)});
  bench.Fix("delta", 0.1);
  bench.simulator->AdvanceTo(0.01);  // the tick at 0 saw 0.1
  EXPECT_DOUBLE_EQ(bench.velocity(), 2.0);
  bench.Fix("delta", 0.103);
  EXPECT_DOUBLE_EQ(bench.velocity(), 2.0 + 0.003 / 0.01);
  bench.simulator->AdvanceTo(0.02);
  EXPECT_DOUBLE_EQ(bench.velocity(), 2.0);
}

TEST(DeltaOverlayTest, LeavesTheRateOutWithoutAPeriod) {
  OverlayBench bench({.period = Period()});
  bench.Fix("delta", 0.1);
  EXPECT_EQ(bench.velocity(), 2.0);
  EXPECT_EQ(bench.position(), 1.1);
}

TEST(DeltaOverlayTest, PassesTheRequestWhenDisabled) {
  OverlayBench bench({.period = Period(1, 100), .enabled = false});
  bench.Fix("delta", 0.25);
  EXPECT_EQ(bench.position(), 1.0);
  EXPECT_EQ(bench.velocity(), 2.0);
}

TEST(DeltaOverlayTest, CountsAnAbsentVelocityAsZero) {
  SystemBench<DeltaOverlay> bench(DeltaOverlay::Params{.period = Period(1, 100)});
  bench->request.Fix(bench.context(), One(1.0));
  bench->delta.Fix(bench.context(), One(0.02));
  EXPECT_DOUBLE_EQ(bench->velocity.Eval(bench.context())[0], 2.0);
}

TEST(DeltaOverlayTest, ShowsTheDeltaItAppliesAndNoneWhenDisabled) {
  for (const bool enabled : {true, false}) {
    OverlayBench bench({.period = Period(1, 100), .enabled = enabled});
    bench.Fix("delta", 0.5);
    EXPECT_EQ(bench.overlay->applied_delta.Eval(bench.simulator->context())[0],
              enabled ? 0.5 : 0.0);
  }
}

TEST(DeltaOverlayTest, RefusesANegativePeriod) {
  EXPECT_THROW(DeltaOverlay({.period = Period(-1, 100)}), ConfigError);
}

}  // namespace delta_overlay_test
}  // namespace oca::systems
