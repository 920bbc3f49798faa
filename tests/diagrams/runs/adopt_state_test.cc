// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/adopt_state.h"

#include <gtest/gtest.h>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/temporary_folder.h"

namespace oca::runs {
namespace adopt_state_test {

using loading::LoadDiagram;
using loading::LoadedDiagram;

/// x' = slope, sampled every 10 ms.
constexpr char kRamp[] = R"(
name: ramp
parameters: {slope: 2.0, fast: false, title: text}
simulator: {duration: 1.0}
systems:
  rate: {type: Constant, value: ["${fast ? 10 * slope : slope}"]}
  x: {type: Integrator, initial: [0.0]}
  hold: {type: ZeroOrderHold, period: 0.01, initial: [0.0]}
connections:
  - rate.value -> x.in
  - x.out -> hold.in
record: {signals: {"x.out": 100}}
)";

class AdoptStateTest : public testing::Test {
 protected:
  const test::TemporaryFolder folder_;
  const std::filesystem::path file_{folder_.Write("ramp.yaml", kRamp)};
};

TEST_F(AdoptStateTest, StatesGoOnInADiagramWithOtherParameters) {
  const LoadedDiagram slow = LoadDiagram(file_);
  const LoadedDiagram fast = LoadDiagram(file_, {{"parameters.slope", "4"}});
  Simulator before(*slow.diagram, slow.simulator.integration);
  before.AdvanceTo(1.0);
  Simulator after(*fast.diagram, fast.simulator.integration);
  after.context().SetTime(1.0);
  AdoptStates(*slow.diagram, before.context(), *fast.diagram, after.context());
  after.AdvanceTo(1.5);
  // 2 * 1 s + 4 * 0.5 s
  EXPECT_NEAR(EvalVector(fast.record[0].output, after.context())[0], 4.0, 1e-9);
}

TEST_F(AdoptStateTest, RefusesToGoOnInADiagramWithOtherStates) {
  const LoadedDiagram one = LoadDiagram(file_);
  const LoadedDiagram two = LoadDiagram(file_, {{"systems.x.initial", "[0, 0]"},
                                                {"systems.rate.value", "[1, 1]"},
                                                {"systems.hold.initial", "[0, 0]"}});
  const Simulator from(*one.diagram);
  Simulator to(*two.diagram);
  EXPECT_THROW(AdoptStates(*one.diagram, from.context(), *two.diagram, to.context()), ConfigError);
}

}  // namespace adopt_state_test
}  // namespace oca::runs
