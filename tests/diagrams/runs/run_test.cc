// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/run.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "oca/diagrams/runs/csv.h"
#include "oca/diagrams/runs/in_memory.h"
#include "oca/diagrams/runs/result_json.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "tests/temporary_folder.h"

namespace oca::runs {
namespace run_test {

namespace fs = std::filesystem;
using loading::LoadDiagram;
using loading::LoadedDiagram;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// x' = slope, twice judged: against goals that it reaches and misses.
constexpr char kRamp[] = R"(
name: ramp
parameters: {slope: 1.0}
simulator: {duration: 2}
systems:
  rate: {type: Constant, value: ["${slope}"]}
  x: {type: Integrator, initial: [0.0]}
  near: {type: Constant, value: 2}
  far: {type: Constant, value: 5}
  first: {type: MotionMetrics, period: 0.1}
  second: {type: MotionMetrics, period: 0.1}
connections:
  - rate.value -> x.in
  - x.out -> first.position
  - near.value -> first.goal
  - x.out -> second.position
  - far.value -> second.goal
record: {signals: {"rate.value": 2, "first.metrics": 1}}
expect: {final_error: {at_most: 1}}
)";

/// 1e308 t overflows after t = 1.797...
constexpr char kOverflow[] = R"(
simulator: {duration: 3}
systems:
  ramp: {type: RampSource, slope: 1}
  gain: {type: Gain, gain: 1.0e308}
connections: [ramp.value -> gain.in]
record: {signals: {"gain.out": 100}}
)";

class RunTest : public testing::Test {
 protected:
  LoadedDiagram Load(const char* text, const std::vector<files::Override>& overrides = {}) const {
    return LoadDiagram(folder_.Write("d.yaml", text), overrides);
  }
  static std::string Text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  const test::TemporaryFolder folder_;
};

TEST_F(RunTest, TellsWhatEachJudgeSaysAndTheWorstOfAll) {
  const RunResult result = runs::Run(Load(kRamp), {});
  ASSERT_EQ(result.judgements.size(), 2u);
  EXPECT_EQ(result.judgements[0].judge, "first");
  EXPECT_NEAR(*result.judgements[0].metrics.final_error, 0.0, 1e-9);
  EXPECT_NEAR(*result.judgements[1].metrics.final_error, 3.0, 1e-9);
  ASSERT_TRUE(result.metrics);
  EXPECT_EQ(result.metrics->final_error, result.judgements[1].metrics.final_error);
  EXPECT_EQ(result.metrics->time_to_goal, std::nullopt);
  ASSERT_EQ(result.expectations.size(), 1u);
  EXPECT_EQ(result.expectations[0].value, result.metrics->final_error);
  EXPECT_FALSE(result.ExpectationsMet());
  EXPECT_EQ(runs::Run(Load(kRamp), {.judge = false}).expectations.size(), 0u);
}

TEST_F(RunTest, SaysWhereAndWhenItFailed) {
  const LoadedDiagram loaded = Load(kOverflow);
  EXPECT_FALSE(runs::Run(loaded, {}).failure);  // nobody looked
  Csv csv(folder_.path() / "csv");
  const RunResult result = runs::Run(loaded, {.outputs = {&csv}});
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(result.failure->system, "gain");
  EXPECT_EQ(result.failure->port, "out");
  EXPECT_NEAR(result.failure->time, 1.8, 0.011);
  EXPECT_THAT(result.failure->message, HasSubstr("not finite"));
  EXPECT_EQ(result.metrics, std::nullopt);
  EXPECT_TRUE(result.judgements.empty());
}

TEST_F(RunTest, WritesTablesOfWhatTheFileRecords) {
  const fs::path folder = folder_.path() / "csv";
  Csv csv(folder);
  runs::Run(Load(kRamp), {.outputs = {&csv}});
  EXPECT_EQ(Text(folder / "rate.value.csv"), "time,value[0]\n0,1\n0.5,1\n1,1\n1.5,1\n2,1\n");
  EXPECT_THAT(Text(folder / "first.metrics.jsonl"), HasSubstr("{\"time\":1,\"value\":{"));
}

TEST_F(RunTest, RefusesTablesOfADiagramThatRecordsNothing) {
  const fs::path folder = folder_.path() / "csv";
  Csv csv(folder);
  const LoadedDiagram loaded = Load("systems: {c: {type: Constant, value: [1]}}\n");
  EXPECT_THAT([&] { runs::Run(loaded, {.duration = 1.0, .outputs = {&csv}}); },
              ThrowsMessage<ConfigError>(HasSubstr("csv: section `record`; got no signals")));
  EXPECT_FALSE(fs::exists(folder));
}

TEST_F(RunTest, RefusesOutputsThatWouldReplaceWhatItReadsOrOneAnotherBeforeAnythingIsWritten) {
  const LoadedDiagram loaded = Load(kRamp);
  const std::string before = Text(loaded.file);
  fs::create_hard_link(loaded.file, folder_.path() / "rate.value.csv");
  Csv over_the_file(folder_.path());
  EXPECT_THAT(
      [&] { runs::Run(loaded, {.outputs = {&over_the_file}}); },
      ThrowsMessage<ConfigError>(HasSubstr("rate.value.csv is what is run; expected another")));
  EXPECT_EQ(Text(loaded.file), before);
  EXPECT_FALSE(fs::exists(folder_.path() / "first.metrics.jsonl"));
  Csv one(folder_.path() / "new"), other(folder_.path() / "." / "new");
  EXPECT_THAT(
      [&] {
        runs::Run(loaded, {.outputs = {&one, &other}});
      },
      ThrowsMessage<ConfigError>(HasSubstr("is what csv writes")));
  EXPECT_FALSE(fs::exists(folder_.path() / "new"));
  const fs::path source = folder_.Write("source.mcap", "");
  Csv over_the_source(source);
  EXPECT_THROW(
      runs::Run(loaded, {.outputs = {&over_the_source}, .inputs = {{source, "what is run"}}}),
      ConfigError);
}

TEST_F(RunTest, WritesNothingIfOneOfItsOutputsCannotBeMade) {
  const LoadedDiagram loaded = Load(kRamp);
  const fs::path folder = folder_.path() / "kept";
  Csv csv(folder);
  InMemory unknown({"rate.valu"}, Period(1, 2));
  EXPECT_THAT(
      [&] {
        runs::Run(loaded, {.outputs = {&csv, &unknown}});
      },
      ThrowsMessage<ConfigError>(HasSubstr("series: rate.valu")));
  EXPECT_FALSE(fs::exists(folder));
  Csv nowhere(folder_.Write("file", "") / "csv");
  EXPECT_THAT(
      [&] {
        runs::Run(loaded, {.outputs = {&csv, &nowhere}});
      },
      ThrowsMessage<ConfigError>(HasSubstr("cannot be written: Not a directory")));
  EXPECT_FALSE(fs::exists(folder));
  runs::Run(loaded, {.outputs = {&csv}});
  EXPECT_TRUE(fs::exists(folder / "rate.value.csv"));
}

TEST_F(RunTest, RefusesNoOutputAndOneThatIsThereTwice) {
  const LoadedDiagram loaded = Load(kRamp);
  EXPECT_THAT([&] { runs::Run(loaded, {.outputs = {nullptr}}); },
              ThrowsMessage<ConfigError>(HasSubstr("outputs[0]: got none")));
  InMemory series({"rate.value"}, Period(1, 2));
  EXPECT_THAT(
      [&] {
        runs::Run(loaded, {.outputs = {&series, &series}});
      },
      ThrowsMessage<ConfigError>(HasSubstr("outputs[1]: got the same as outputs[0]")));
}

/// Notes what a run calls.
class Noting final : public RunOutput {
 public:
  void Prepare(const RunStart& run) override {
    notes += "prepares;";
    EXPECT_FALSE(run.continued);
  }
  void Begin(const RunStart& run) override {
    notes += run.continued ? "goes on;" : "begins;";
    EXPECT_EQ(run.simulator.context().time(), run.continued ? 1.0 : 0.0);
  }
  void Pause() override { notes += "pauses;"; }
  void SetWarnings(const std::vector<std::string>& warnings) override {
    notes += warnings.at(0) + ";";
  }
  void End(const RunResult& result) override {
    notes += "ends;";
    if (result.duration < 1.0) throw ConfigError("the disk is full");
  }
  std::string notes;
};

/// At 1 s, goes on with another diagram.
class Switch final : public RunHook {
 public:
  explicit Switch(LoadedDiagram next)
      : next_(std::make_shared<const LoadedDiagram>(std::move(next))) {}
  void Prepare(const LoadedDiagram& /*loaded*/, Context& /*context*/) override { ++prepared; }
  bool WantsChange() override { return ++steps == 2; }  // of half a second
  void Change(RunControl& run) override {
    EXPECT_EQ(run.context().time(), 1.0);
    run.SetWarnings({"careful"});
    try {
      run.Replace(next_);
    } catch (const ConfigError& error) {
      refusal = error.what();
    }
  }
  int steps{0}, prepared{0};
  std::string refusal;

 private:
  std::shared_ptr<const LoadedDiagram> next_;
};

constexpr char kHalves[] = R"(
parameters: {slope: 1.0}
simulator: {duration: 2}
systems:
  rate: {type: Constant, value: ["${slope}"]}
  x: {type: Integrator, initial: [0.0]}
connections: [rate.value -> x.in]
record: {signals: {"x.out": 2}}
)";

TEST_F(RunTest, GoesOnWithAnotherDiagramFromTheStatesItHas) {
  const LoadedDiagram loaded = Load(kHalves);
  Switch hook(Load(kHalves, {{"parameters.slope", "10"}}));
  Noting noting;
  InMemory series({"x.out"}, Period(1, 2));
  Csv csv(folder_.path() / "csv");
  const RunResult result = runs::Run(loaded, {.outputs = {&noting, &series, &csv}, .hook = &hook});
  EXPECT_EQ(hook.refusal, "");
  EXPECT_EQ(hook.prepared, 2);
  EXPECT_EQ(result.duration, 2.0);
  EXPECT_EQ(noting.notes, "prepares;begins;careful;pauses;goes on;ends;");
  const Eigen::MatrixXd x = series.Matrix();
  EXPECT_NEAR(x(0, 0), 0.0, 1e-12);
  EXPECT_EQ(series.times(), (Eigen::VectorXd(5) << 0.0, 0.5, 1.0, 1.5, 2.0).finished());
  EXPECT_NEAR(x(x.rows() - 1, 0), 1.0 * 1.0 + 10.0 * 1.0, 1e-9);
  EXPECT_THAT(
      Text(folder_.path() / "csv/x.out.csv"),
      testing::MatchesRegex("time,out.*\n0,.*\n0.5,[^\n]*\n1,[^\n]*\n1.5,[^\n]*\n2,[^\n]*\n"));
}

TEST_F(RunTest, StaysAsItIsIfAnotherDiagramCannotGoOn) {
  const LoadedDiagram loaded = Load(kHalves);
  Switch hook(Load(kHalves, {{"systems.x.initial", "[0, 0]"}, {"systems.rate.value", "[1, 1]"}}));
  Noting noting;
  const RunResult result = runs::Run(loaded, {.outputs = {&noting}, .hook = &hook});
  EXPECT_THAT(hook.refusal, HasSubstr("got other systems or states than before"));
  EXPECT_EQ(noting.notes, "prepares;begins;careful;ends;");
  EXPECT_EQ(result.duration, 2.0);
}

TEST_F(RunTest, CallsItAFailureIfAnOutputCannotBeWrittenToTheEnd) {
  Noting full;
  const RunResult result = runs::Run(Load(kHalves), {.duration = 0.5, .outputs = {&full}});
  ASSERT_TRUE(result.failure);
  EXPECT_EQ(result.failure->system, "");
  EXPECT_EQ(result.failure->message, "the disk is full");
  EXPECT_EQ(result.duration, 0.5);
}

TEST(ResultJsonTest, HasEveryMetricWithNullWhereThereIsNone) {
  EXPECT_EQ(MetricsJson({}), "{}");
  systems::MotionMetricsValue metrics;
  metrics.min_distance = 0.25;
  metrics.min_distance_link = models::Name("hand");
  metrics.min_distance_obstacle = models::Name("box");
  std::string written;
  Signal<systems::MotionMetricsValue>::WriteJson(metrics, written);
  EXPECT_EQ(MetricsJson(metrics), written);
  EXPECT_THAT(written, HasSubstr(R"({"min_distance":0.25,"min_distance_pair":["hand","box"],)"));
  RunResult result;
  result.expectations = {{"final_error", std::nullopt, "<= 1", 2.0, false}};
  EXPECT_EQ(ExpectationsJson(result),
            R"([{"name":"final_error","value":null,"bound":"<= 1","at":2.0,"ok":false}])");
}

}  // namespace run_test
}  // namespace oca::runs
