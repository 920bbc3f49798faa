// SPDX-License-Identifier: BSD-3-Clause
// The avoidance of a diagram file in a loop of one's own gives what it gives in a simulation.
#include <gmock/gmock.h>

#include <limits>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/control_loop.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/simulation/simulator.h"
#include "oca/systems/signals/signals.h"
#include "tests/allocation_count.h"
#include "tests/temporary_folder.h"

namespace oca::runs {
namespace embedding_test {

using systems::ObstacleSet;
using testing::HasSubstr;

const char* const kStaticTest = OCA_SOURCE_DIR "/diagrams/static_test.yaml";
const std::vector<std::string> kAvoidance{"kinematics", "distance",   "field",  "wrenches",
                                          "mapping",    "relaxation", "limiter"};
const std::vector<files::Override> kFast{{"parameters.rate", "1000"}};

struct Part {
  explicit Part(const std::vector<files::Override>& overrides)
      : loaded(loading::Blueprint(kStaticTest).Build(overrides, {.part = kAvoidance})),
        q(loaded.diagram->GetInput<Vector>("plant.position")),
        obstacles(loaded.diagram->GetInput<ObstacleSet>("obstacles.obstacles")),
        delta(loaded.diagram->GetOutput<Vector>("limiter.limited_delta")) {}
  loading::LoadedDiagram loaded;
  Input<Vector> q;
  Input<ObstacleSet> obstacles;
  Output<Vector> delta;
};

/// Joints and obstacles of the simulated static test at an instant, and the delta from then on.
struct Sample {
  Eigen::VectorXd q;
  ObstacleSet obstacles;
  Eigen::VectorXd delta;
};

std::vector<Sample> Simulate(int rate, int ticks) {
  const loading::LoadedDiagram whole =
      loading::LoadDiagram(kStaticTest, {{"parameters.rate", std::to_string(rate)}});
  const auto q = whole.diagram->GetOutput<Vector>("plant.position");
  const auto delta = whole.diagram->GetOutput<Vector>("limiter.limited_delta");
  const auto obstacles = whole.diagram->GetOutput<ObstacleSet>("obstacles.obstacles");
  Simulator simulator(*whole.diagram, whole.simulator.integration);
  simulator.Initialize();
  std::vector<Sample> samples;
  for (int k = 0; k < ticks; ++k) {
    const Context& context = simulator.context();
    samples.push_back({q.Eval(context), obstacles.Eval(context), {}});
    simulator.AdvanceTo((k + 1) / static_cast<double>(rate));
    samples.back().delta = delta.Eval(context);
  }
  return samples;
}

TEST(EmbeddingTest, TheDeltasAreThoseOfTheSimulationToTheBit) {
  for (const int rate : {100, 1000}) {
    const std::vector<Sample> samples = Simulate(rate, 14 * rate);
    Part part({{"parameters.rate", std::to_string(rate)}});
    ControlLoop loop(*part.loaded.diagram, Period(1, rate));
    loop.Watch(part.delta);
    ASSERT_TRUE(loop.Set(part.q, samples[0].q).ok());
    ASSERT_TRUE(loop.Set(part.obstacles, samples[0].obstacles).ok());
    loop.Initialize();
    double largest = 0.0;
    for (const Sample& sample : samples) {
      ASSERT_TRUE(loop.Set(part.q, sample.q).ok());
      ASSERT_TRUE(loop.Set(part.obstacles, sample.obstacles).ok());
      ASSERT_TRUE(loop.Tick().ok());
      ASSERT_EQ(loop.Get(part.delta), sample.delta) << loop.time();
      largest = std::max(largest, sample.delta.cwiseAbs().maxCoeff());
    }
    EXPECT_GT(largest, 0.3) << "the arm did evade";
  }
}

TEST(EmbeddingTest, AKilohertzOfTicksTakesNothingFromTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const std::vector<Sample> samples = Simulate(1000, 11000);
  Part part(kFast);
  ControlLoop loop(*part.loaded.diagram, Period(1, 1000));
  loop.Watch(part.delta);
  ASSERT_TRUE(loop.Set(part.q, samples[0].q).ok());
  ASSERT_TRUE(loop.Set(part.obstacles, samples[0].obstacles).ok());
  loop.Initialize();
  int failed = 0;
  const std::int64_t before = AllocationCount();
  for (const Sample& sample : samples) {
    failed += !loop.Set(part.q, sample.q).ok();
    failed += !loop.Set(part.obstacles, sample.obstacles).ok();
    failed += !loop.Tick().ok();
  }
  EXPECT_EQ(AllocationCount() - before, 0);
  EXPECT_EQ(failed, 0);
}

TEST(EmbeddingTest, ABrokenSensorIsRefusedByNameAndTheDeltaStays) {
  const std::vector<Sample> samples = Simulate(100, 600);
  Part part({});
  ControlLoop loop(*part.loaded.diagram, Period(1, 100));
  loop.Watch(part.delta);
  ASSERT_TRUE(loop.Set(part.q, samples.back().q).ok());
  ASSERT_TRUE(loop.Set(part.obstacles, samples.back().obstacles).ok());
  loop.Initialize();
  ASSERT_TRUE(loop.Tick().ok());
  const Eigen::VectorXd delta = loop.Get(part.delta);
  Eigen::VectorXd broken = samples.back().q;
  broken[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_STREQ(loop.Set(part.q, broken).port(), "plant.position");
  ObstacleSet lost = samples.back().obstacles;
  lost.obstacles[0].X_WO.translation().x() = std::numeric_limits<double>::infinity();
  EXPECT_STREQ(loop.Set(part.obstacles, lost).port(), "obstacles.obstacles");
  EXPECT_FALSE(loop.Set(part.q, broken.head(6)).ok());
  EXPECT_EQ(loop.Get(part.delta), delta);
  EXPECT_TRUE(loop.Tick().ok());
}

TEST(BuildPartTest, ExportsWhatCrossesItsBorderAndNothingElse) {
  const Part part({});
  std::vector<std::string> inputs, systems;
  for (const auto& input : part.loaded.diagram->inputs()) inputs.push_back(input.name);
  for (const auto& block : part.loaded.systems) systems.push_back(block.name);
  EXPECT_THAT(inputs, testing::UnorderedElementsAre("plant.position", "obstacles.obstacles"));
  EXPECT_THAT(systems, testing::UnorderedElementsAreArray(kAvoidance));
  EXPECT_NO_THROW(part.loaded.diagram->GetOutput<Vector>("mapping.delta"));
  EXPECT_TRUE(part.loaded.record.empty());
}

std::string ProblemOf(const std::string& text, const std::vector<std::string>& systems) {
  const test::TemporaryFolder folder;
  folder.Write("part.yaml", text);
  try {
    loading::Blueprint(folder.path() / "part.yaml").Build({}, {.part = systems});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

const char* const kChain = R"(
systems:
  a: {type: Constant, value: 1}
  a_b: {type: Constant, value: 1}
  sum: {type: Sum, inputs: 2}
connections: [a.value -> sum.in0, a_b.value -> sum.in1]
)";

TEST(BuildPartTest, RefusesSystemsThatTheFileDoesNotHave) {
  EXPECT_EQ(ProblemOf(kChain, {"sum"}), "");
  EXPECT_THAT(ProblemOf(kChain, {"sun"}), HasSubstr("part: no system 'sun'; did you mean 'sum'"));
  EXPECT_THAT(ProblemOf(kChain, {}), HasSubstr("got no system"));
}

TEST(BuildPartTest, StillChecksWhatIsOutside) {
  EXPECT_THAT(ProblemOf(std::string(kChain) + "nonsense: 1\n", {"sum"}), HasSubstr("unknown key"));
  std::string bad = kChain;
  bad.replace(bad.find("a.value ->"), 10, "a.valeu ->");
  EXPECT_THAT(ProblemOf(bad, {"sum"}), HasSubstr("valeu"));
}

TEST(BuildPartTest, RefusesAConnectionFromOutsideOfAnotherType) {
  EXPECT_THAT(ProblemOf(R"(
systems:
  obstacles: {type: ObstacleSource, period: 0.01}
  gain: {type: Gain, gain: 1}
connections: [obstacles.obstacles -> gain.in]
)",
                        {"gain"}),
              HasSubstr("type; got ObstacleSet; expected Vector"));
}

}  // namespace embedding_test
}  // namespace oca::runs
