// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/run_recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "oca/diagrams/record/run_metadata.h"
#include "oca/diagrams/record/series.h"
#include "oca/diagrams/runs/blind_spots.h"
#include "oca/diagrams/runs/result_json.h"
#include "tests/allocation_count.h"
#include "tests/diagrams/record/record_runs.h"
#include "tests/temporary_folder.h"

namespace oca::record {
namespace run_recorder_test {

using nlohmann::json;
using test::kEpoch;
using test::Load;
using test::Recorded;
using test::RunRecorded;
using testing::ElementsAre;
using testing::HasSubstr;

/// The static test once, for all tests of what its record holds.
const Recorded& StaticTest() {
  static const Recorded recorded = RunRecorded(Load("static_test.yaml"), {.duration = 2.0});
  return recorded;
}

std::vector<json> MessagesOf(const McapFile& file, const std::string& topic) {
  std::vector<json> messages;
  for (const McapMessage* message : file.MessagesOf(topic)) {
    messages.push_back(json::parse(message->data));
  }
  return messages;
}

TEST(RunRecorderTest, KeepsASignalAtItsRateFromTheBeginningToTheEnd) {
  const auto messages = StaticTest().file.MessagesOf("/plant/position");
  ASSERT_EQ(messages.size(), 201u);
  EXPECT_EQ(messages.front()->log_time, kEpoch);
  EXPECT_EQ(messages[1]->log_time, kEpoch + 10'000'000);
  EXPECT_EQ(messages.back()->log_time, kEpoch + 2'000'000'000);
}

TEST(RunRecorderTest, SaysWhichSystemsLimitAndKeepsWhatShowsIt) {
  const Recorded recorded = RunRecorded(Load("safety_filter_static.yaml"), {.duration = 0.5});
  const json limits = json::parse(recorded.file.FindMetadata("oca.plots")->at("limits"));
  std::map<std::string, std::string> kinds;
  for (const json& limit : limits) {
    const std::string signal = limit["signal"];
    kinds[limit["type"]] = limit["kind"];
    EXPECT_EQ(recorded.file.MessagesOf(signal).size(), 51u) << signal;
  }
  EXPECT_EQ(kinds, (std::map<std::string, std::string>{{"SafetyFilter", "bounds"},
                                                       {"MotionLimiter", "clips"}}));
  const json of_report = json::parse(StaticTest().file.FindMetadata("oca.plots")->at("limits"));
  ASSERT_EQ(of_report.size(), 2u);  // its MotionLimiter is off
  EXPECT_EQ(of_report[0]["type"], "RepulsiveField");
  EXPECT_EQ(of_report[0]["bound"], 0.3);
  EXPECT_EQ(of_report[1]["type"], "DeltaLimiter");
  EXPECT_EQ(of_report[1]["signal"], "/overlay/applied_delta");
  EXPECT_EQ(of_report[1]["bound"], 0.6);
}

TEST(RunRecorderTest, NamesJointsAndUnits) {
  const McapFile& file = StaticTest().file;
  const json first = json::parse(file.MessagesOf("/plant/position").front()->data);
  EXPECT_EQ(first.size(), 7u);
  EXPECT_DOUBLE_EQ(first["lwr4_joint_2"].get<double>(), 85 * M_PI / 180);
  const auto schema = [&](const char* topic) {
    return json::parse(file.FindSchema(file.FindChannel(topic)->schema)->data);
  };
  EXPECT_EQ(schema("/plant/position")["properties"]["lwr4_joint_2"]["x-unit"], "rad");
  EXPECT_EQ(schema("/plant/velocity")["properties"]["lwr4_joint_2"]["x-unit"], "rad/s");
  EXPECT_EQ(schema("/overlay/applied_delta")["properties"]["lwr4_joint_1"]["x-unit"], "rad");
}

TEST(RunRecorderTest, ShowsEveryLinkAndObstacleAsAFrame) {
  const auto messages = MessagesOf(StaticTest().file, "/tf");
  ASSERT_GT(messages.size(), 100u);  // 60 Hz, sampled at control ticks
  ASSERT_LT(messages.size(), 125u);
  std::vector<std::string> frames;
  for (const json& transform : messages.back()["transforms"]) {
    EXPECT_EQ(transform["parent_frame_id"], "world");
    frames.push_back(transform["child_frame_id"]);
  }
  EXPECT_THAT(frames, testing::Contains("arm/lwr4_link_4"));
  EXPECT_THAT(frames, testing::Contains("obstacle/box"));
}

TEST(RunRecorderTest, DrawsRobotsAndStandingObstaclesOnce) {
  EXPECT_EQ(MessagesOf(StaticTest().file, "/scene/robots").size(), 1u);
  const auto obstacles = MessagesOf(StaticTest().file, "/scene/obstacles");
  ASSERT_EQ(obstacles.size(), 1u);
  const json& box = obstacles[0]["entities"][0];
  EXPECT_EQ(box["id"], "obstacle/box");
  EXPECT_NEAR(box["cubes"][0]["size"]["x"].get<double>(), 0.2, 1e-7);
}

TEST(RunRecorderTest, DrawsALineForEachProximity) {
  const auto forces = MessagesOf(StaticTest().file, "/scene/forces");
  const json& entities = forces.back()["entities"];
  ASSERT_EQ(entities.size(), 3u);
  EXPECT_EQ(entities[0]["id"], "distances");
  const auto last = MessagesOf(StaticTest().file, "/distance/proximities").back();
  EXPECT_EQ(entities[0]["lines"][0]["points"].size(), 2 * last["proximities"].size());
  EXPECT_EQ(entities[0]["lines"][0]["type"], 2);
}

TEST(RunRecorderTest, SaysOfALineWhetherItIsADistanceOrADepth) {
  const Recorded recorded =
      RunRecorded(Load("static_test.yaml", {{"parameters.avoid", "false"}}), {.duration = 6.0});
  const json metrics = json::parse(runs::MetricsJson(recorded.result.metrics));
  ASSERT_LT(metrics["min_distance"].get<double>(), -0.12);
  double least = 1.0;
  for (const json& message : MessagesOf(recorded.file, "/scene/forces")) {
    const json& entity = message["entities"][0];
    ASSERT_EQ(entity["metadata"][0]["key"], "distances");
    const json signed_distances = json::parse(entity["metadata"][0]["value"].get<std::string>());
    const json& points = entity["lines"][0]["points"];
    ASSERT_EQ(2 * signed_distances.size(), points.size());
    for (std::size_t i = 0; i < signed_distances.size(); ++i) {
      const json &a = points[2 * i], &b = points[2 * i + 1];
      const double length = std::hypot(a["x"].get<double>() - b["x"].get<double>(),
                                       a["y"].get<double>() - b["y"].get<double>(),
                                       a["z"].get<double>() - b["z"].get<double>());
      EXPECT_NEAR(std::abs(signed_distances[i].get<double>()), length, 2e-6);
      least = std::min(least, signed_distances[i].get<double>());
    }
  }
  EXPECT_NEAR(least, metrics["min_distance"].get<double>(), 0.003);  // at 60 Hz
}

TEST(RunRecorderTest, TellsWhatWasNotLookedAt) {
  const std::string not_seen = StaticTest().file.FindMetadata("oca")->at("not_seen");
  EXPECT_EQ(json::parse(not_seen), json(runs::BlindSpots(Load("static_test.yaml"))));
  EXPECT_THAT(not_seen, HasSubstr("own links"));
}

TEST(RunRecorderTest, TellsWhatTheDiagramIsWarnedOf) {
  loading::LoadedDiagram loaded = Load("static_test.yaml");
  EXPECT_EQ(
      RunRecorded(loaded, {.duration = 0.1}).file.FindMetadata("oca.warnings")->at("warnings"),
      "[]");
  loaded.warnings = {"a.yaml:1:2: warning: one", "b.yaml:3:4: warning: two"};
  const Recorded recorded = RunRecorded(loaded, {.duration = 0.1});
  EXPECT_THAT(WarningsOf(recorded.file),
              ElementsAre("a.yaml:1:2: warning: one", "b.yaml:3:4: warning: two"));
  EXPECT_EQ(WarningTexts({"\xff \x1b"}).at("warnings"), "[\"\xef\xbf\xbd \\u001b\"]");
  const auto log = MessagesOf(recorded.file, "/log");
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[1]["level"], 3);
  EXPECT_EQ(log[1]["message"], "b.yaml:3:4: warning: two");
}

TEST(RunRecorderTest, AddsWhatPlotsNeedAndNobodyRecords) {
  const json plots = json::parse(StaticTest().file.FindMetadata("oca.plots")->at("plots"));
  std::vector<std::string> ids;
  for (const json& plot : plots) {
    ids.push_back(plot["id"]);
    for (const json& topic : plot["topics"]) {
      EXPECT_FALSE(StaticTest().file.MessagesOf(topic.get<std::string>()).empty()) << topic;
    }
  }
  EXPECT_THAT(ids, ElementsAre("requested", "delta", "final", "distance", "speed"));
  EXPECT_EQ(plots[3]["limit"], 0.3);
}

TEST(RunRecorderTest, NamesSignalsOfUsedFilesByTheirWholePath) {
  const Recorded recorded = RunRecorded(Load("dual_arm.yaml"), {.duration = 0.05});
  EXPECT_FALSE(recorded.file.MessagesOf("/left/plant/position").empty());
  for (const json& plot : json::parse(recorded.file.FindMetadata("oca.plots")->at("plots"))) {
    for (const json& topic : plot["topics"]) {
      EXPECT_FALSE(recorded.file.MessagesOf(topic.get<std::string>()).empty()) << topic;
    }
  }
  EXPECT_EQ(ReadSeries(recorded.file, "left.plant.position").at(0).signal, "left.plant.position");
}

TEST(RunRecorderTest, EndsWithTheMetricsOfTheRun) {
  const auto metrics = StaticTest().file.MessagesOf("/metrics");
  ASSERT_EQ(metrics.size(), 1u);
  EXPECT_EQ(metrics[0]->data, runs::MetricsJson(StaticTest().result.metrics));
  EXPECT_EQ(StaticTest().file.FindMetadata("oca")->at("outcome"), "done");
  EXPECT_EQ(StaticTest().file.FindMetadata("oca")->at("dropped_messages"), "0");
}

TEST(RunRecorderTest, ChangesNoBitOfARun) {
  // The spring of the servo's verification is integrated: an extra stop would show.
  for (const char* const name : {"static_test.yaml", "attractive_goal.yaml"}) {
    const auto loaded = Load(name);
    const runs::RunOptions options{.duration = 3.0};
    EXPECT_EQ(runs::Run(loaded, options).metrics, RunRecorded(loaded, options).result.metrics)
        << name;
  }
}

TEST(RunRecorderTest, DeletesAnObstacleThatGoes) {
  const oca::test::TemporaryFolder folder;
  const auto file = folder.Write("passing.yaml", R"(
simulator: {duration: 3}
systems:
  obstacles:
    type: ObstacleSource
    obstacles:
      - {id: ball, shape: {type: sphere, radius: 0.1}, pose: {xyz: [1, 0, 0]}, appear: 1, disappear: 2}
  ramp: {type: RampSource, slope: 1}
record: {signals: {"ramp.value": 10}, scene: 10}
)");
  const Recorded recorded = RunRecorded(loading::LoadDiagram(file));
  const auto messages = recorded.file.MessagesOf("/scene/obstacles");
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0]->log_time, kEpoch + 1'000'000'000);
  EXPECT_EQ(json::parse(messages[0]->data)["entities"][0]["id"], "obstacle/ball");
  EXPECT_EQ(messages[1]->log_time, kEpoch + 2'000'000'000);
  EXPECT_EQ(json::parse(messages[1]->data)["deletions"][0]["id"], "obstacle/ball");
}

TEST(RunRecorderTest, SeesTheSceneAtItsOwnTicksAndNotOneEventLater) {
  const oca::test::TemporaryFolder folder;
  const auto file = folder.Write("passing.yaml", R"(
simulator: {duration: 1}
systems:
  obstacles:
    type: ObstacleSource
    obstacles:
      - {id: ball, shape: {type: sphere, radius: 0.1}, pose: {xyz: [1, 0, 0]}, appear: 0.3, disappear: 0.7}
  ramp: {type: RampSource, slope: 1}
record: {signals: {"ramp.value": 100}, scene: 10}
)");
  const Recorded recorded = RunRecorded(loading::LoadDiagram(file));
  const auto messages = recorded.file.MessagesOf("/scene/obstacles");
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages[0]->log_time, kEpoch + 300'000'000);  // 3 * 0.1 > 0.3 in doubles
  EXPECT_EQ(messages[1]->log_time, kEpoch + 700'000'000);
}

/// 1e308 t overflows after t = 1.797...
TEST(RunRecorderTest, IsCompleteUpToAFailure) {
  const oca::test::TemporaryFolder folder;
  const auto file = folder.Write("overflow.yaml", R"(
simulator: {duration: 3}
systems:
  ramp: {type: RampSource, slope: 1}
  gain: {type: Gain, gain: 1.0e308}
connections: [ramp.value -> gain.in]
record: {signals: {"ramp.value": 100, "gain.out": 100}}
)");
  const Recorded recorded = RunRecorded(loading::LoadDiagram(file));
  ASSERT_TRUE(recorded.result.failure);
  EXPECT_EQ(recorded.result.failure->system, "gain");
  EXPECT_EQ(recorded.result.failure->port, "out");
  EXPECT_NEAR(recorded.result.failure->time, 1.8, 0.01);
  EXPECT_THAT(recorded.result.failure->message, HasSubstr("gain"));
  EXPECT_TRUE(recorded.file.complete()) << recorded.file.problem();
  const auto values = ReadSeries(recorded.file, "gain.out");
  ASSERT_EQ(values.size(), 1u);
  EXPECT_EQ(values[0].times.back(), 1.79);
  EXPECT_THAT(recorded.file.FindMetadata("oca")->at("outcome"), HasSubstr("failed: "));
  const auto log = MessagesOf(recorded.file, "/log");
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(log[0]["level"], 4);
}

/// Listens to everything.
class Listener final : public Log {
 public:
  bool enabled(LogLevel /*level*/) const override { return true; }
  void Write(LogLevel /*level*/, double /*time*/, std::string_view /*text*/) override { ++lines; }
  int lines{0};
};

TEST(RunRecorderTest, KeepsTheLogAndPassesItOn) {
  Listener listener;
  const Recorded recorded = RunRecorded(
      Load("static_test.yaml", {{"parameters.print_infos", "true"}}), {.duration = 0.1}, &listener);
  const auto log = MessagesOf(recorded.file, "/log");
  EXPECT_GE(listener.lines, 10);
  EXPECT_EQ(log.size(), static_cast<std::size_t>(listener.lines));
  EXPECT_EQ(log.back()["level"], 1);
}

/// Counts what the thread of the run takes from the heap between two instants.
class HeapWatch final : public runs::RunOutput {
 public:
  void Begin(const runs::RunStart& run) override {
    run.simulator.AddMonitor([this](const Context& context) {
      if (context.time() < 0.05) before = AllocationCount();
      after = AllocationCount();
      return true;
    });
  }
  void End(const runs::RunResult& /*result*/) override {}
  std::int64_t before{0}, after{0};
};

TEST(RunRecorderTest, TakesNothingFromTheHeapInATick) {
  if (!kCountsAllocations) GTEST_SKIP() << "allocations are not counted here";
  HeapWatch watch;
  RunRecorded(Load("static_test.yaml"), {.duration = 5.0, .outputs = {&watch}});
  EXPECT_EQ(watch.after - watch.before, 0);
}

}  // namespace run_recorder_test
}  // namespace oca::record
