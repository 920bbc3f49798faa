// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/live_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>

#include "oca/framework/dataflow/error.h"
#include "tests/temporary_folder.h"

namespace oca::live {
namespace live_run_test {

using loading::LoadDiagram;
using loading::LoadedDiagram;
using testing::ElementsAre;
using testing::HasSubstr;

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

class LiveRunTest : public testing::Test {
 protected:
  std::filesystem::path Write(const std::string& text) {
    const auto path = folder_.path() / "diagram.yaml";
    std::ofstream(path) << text;
    return path;
  }
  static LiveOptions AnyPort() {
    LiveOptions options;
    options.port = 0;
    return options;
  }
  test::TemporaryFolder folder_;
};

TEST_F(LiveRunTest, OffersNumbersSwitchesAndObstaclesThatStand) {
  const LoadedDiagram loaded =
      LoadDiagram(std::filesystem::path(OCA_SOURCE_DIR) / "diagrams/static_test.yaml");
  const auto parameters = LiveParametersOf(loaded);
  const auto find = [&](const std::string& name) {
    return std::find_if(parameters.begin(), parameters.end(),
                        [&](const LiveParameter& one) { return one.name == name; });
  };
  ASSERT_NE(find("max_distance"), parameters.end());
  EXPECT_EQ(std::get<double>(find("max_distance")->value), 0.3);  // "${0.3 * scale}"
  ASSERT_NE(find("avoid"), parameters.end());
  EXPECT_EQ(std::get<bool>(find("avoid")->value), true);
  ASSERT_NE(find("obstacles.box.position"), parameters.end());
  EXPECT_THAT(std::get<std::vector<double>>(find("obstacles.box.position")->value),
              ElementsAre(0.0, 0.6, 1.0));
}

TEST_F(LiveRunTest, NamesObstaclesThatStandByTheirPaths) {
  folder_.Write("used.yaml",
                "systems: {o: {type: ObstacleSource, obstacles: [{id: box, shape: {type: sphere, "
                "radius: 0.1}, pose: {xyz: [0, 0, 1]}}]}}\n");
  const LoadedDiagram loaded =
      LoadDiagram(folder_.Write("both.yaml",
                                "systems:\n"
                                "  left: {type: Diagram, file: used.yaml}\n"
                                "  right: {type: Diagram, file: used.yaml}\n"));
  std::vector<std::string> names;
  for (const LiveParameter& one : LiveParametersOf(loaded)) names.push_back(one.name);
  EXPECT_THAT(names, ElementsAre("left.o.box.position", "right.o.box.position"));
  const std::vector<double> moved{0.0, 0.5, 1.25};
  EXPECT_EQ(OverrideOf(loaded, {names[0], moved}).path, "left.systems.o.obstacles.0.pose.xyz");
  EXPECT_EQ(OverrideOf(loaded, {names[1], moved}).path, "right.systems.o.obstacles.0.pose.xyz");
}

TEST_F(LiveRunTest, KnowsHowFarTheFieldsBehindAParameterGo) {
  const auto ranges =
      RangesOf(LoadDiagram(std::filesystem::path(OCA_SOURCE_DIR) / "diagrams/static_test.yaml"));
  EXPECT_EQ(ranges.at("force_gain"), "[0.0,null]");
  EXPECT_EQ(ranges.at("relaxation_time"), "[0.0,null]");
  EXPECT_EQ(ranges.count("test_joint_factor"), 0u);  // it stands in arithmetic
}

TEST_F(LiveRunTest, KnowsTheOverrideThatAChangeMeans) {
  const LoadedDiagram loaded =
      LoadDiagram(std::filesystem::path(OCA_SOURCE_DIR) / "diagrams/static_test.yaml");
  EXPECT_EQ(OverrideOf(loaded, {"alpha", 0.5}).path, "parameters.alpha");
  EXPECT_EQ(OverrideOf(loaded, {"alpha", 0.5}).value, "0.5");
  EXPECT_EQ(OverrideOf(loaded, {"avoid", false}).value, "false");
  const auto moved =
      OverrideOf(loaded, {"obstacles.box.position", std::vector<double>{0.0, 0.5, 1.25}});
  EXPECT_EQ(moved.path, "systems.obstacles.obstacles.0.pose.xyz");
  EXPECT_EQ(moved.value, "[0, 0.5, 1.25]");
  EXPECT_THROW(OverrideOf(loaded, {"beta", 1.0}), ConfigError);
}

TEST_F(LiveRunTest, RunsInStepWithTheClockForAsLongAsItIsTold) {
  LiveServer server(AnyPort());
  LiveRunOptions options;
  options.file = Write(kRamp);
  options.duration = 0.2;
  const auto start = std::chrono::steady_clock::now();
  const LiveRunResult result = RunLive(options, server);
  EXPECT_EQ(result.run.duration, 0.2);
  EXPECT_EQ(result.changes, 0);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(190));
}

TEST_F(LiveRunTest, EndsWhenItIsInterrupted) {
  LiveServer server(AnyPort());
  LiveRunOptions options;
  options.file = Write(kRamp);
  int steps = 0;
  options.interrupted = [&steps] { return ++steps == 5; };
  EXPECT_LT(RunLive(options, server).run.duration, 0.06);
}

TEST_F(LiveRunTest, RefusesAFileThatCannotBeLoaded) {
  LiveServer server(AnyPort());
  LiveRunOptions options;
  options.file = Write("name: broken\nsystems: {a: {type: Nothing}}\n");
  EXPECT_THROW(RunLive(options, server), ConfigError);
}

}  // namespace live_run_test
}  // namespace oca::live
