// SPDX-License-Identifier: BSD-3-Clause
// `simulator sweep` and `simulator merge`, as a user meets them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/diagrams/sweep/tiny_campaign.h"
#include "tests/tools/program.h"

namespace oca::tools {
namespace sweep_command_test {

using nlohmann::json;
using testing::HasSubstr;

class SweepCommandTest : public testing::Test {
 protected:
  SweepCommandTest() { run.folder().Write("tiny.yaml", sweep::kTinyDiagram); }
  Program run;
  const std::string place_{run.folder().path().string()};
  const std::string file_{place_ + "/tiny.yaml"};
  const std::string sweep_{"$S sweep " + file_ + " --samples 6 --seed 10 -j 2 --vary " +
                           "'parameters.slope=uniform(0.4, 0.6, step=0.1)' -o " + place_ +
                           "/campaign "};
};

TEST_F(SweepCommandTest, SumsUpTheSamplesAndTellsHowToRunAFailureAlone) {
  const Ran ran = run(sweep_ + "--json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const json result = json::parse(ran.out);
  EXPECT_EQ(result["runs"], 6);
  EXPECT_EQ(result["campaign"]["seed"], 10);
  const json& arrived = result["combinations"][0]["arrived"];
  EXPECT_EQ(arrived["of"], 6);
  ASSERT_EQ(result["failures"].size(), 6u - arrived["count"].get<std::size_t>());
  ASSERT_GT(result["failures"].size(), 0u);
  for (const json& failure : result["failures"]) {
    // The same run, alone.
    const Ran alone = run("$S" + failure["command"].get<std::string>().substr(9) + " --json");
    ASSERT_EQ(alone.status, 0) << alone.err;
    const json metrics = json::parse(alone.out)["metrics"];
    EXPECT_GT(metrics["final_error"].get<double>(), 0.01);
    std::istringstream lines(run.Read("campaign/results.jsonl"));
    bool found = false;
    for (std::string line; std::getline(lines, line);) {
      const json row = json::parse(line);
      if (row.contains("campaign") || row["sample"] != failure["sample"]) continue;
      EXPECT_EQ(row["metrics"], metrics);
      found = true;
    }
    EXPECT_TRUE(found);
  }
  EXPECT_TRUE(std::filesystem::exists(place_ + "/campaign/results.db"));
}

TEST_F(SweepCommandTest, PrintsATableAndTheSameOneFromShards) {
  const Ran whole = run(sweep_);
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_THAT(whole.out, HasSubstr("tiny: 6 samples, seed 10"));
  EXPECT_THAT(whole.out, HasSubstr("arrived"));
  EXPECT_THAT(whole.out, HasSubstr(" %"));
  EXPECT_THAT(whole.err, HasSubstr("a second, on 2 threads"));
  const std::string shards = "$S sweep " + file_ + " --samples 6 --seed 10 --vary " +
                             "'parameters.slope=uniform(0.4, 0.6, step=0.1)' -o " + place_ +
                             "/parts";
  EXPECT_EQ(run("SLURM_ARRAY_TASK_ID=4 SLURM_ARRAY_TASK_MIN=4 SLURM_ARRAY_TASK_COUNT=3; export "
                "SLURM_ARRAY_TASK_ID SLURM_ARRAY_TASK_MIN SLURM_ARRAY_TASK_COUNT; " +
                shards)
                .status,
            0);
  EXPECT_EQ(run("OMPI_COMM_WORLD_RANK=1 OMPI_COMM_WORLD_SIZE=3; export OMPI_COMM_WORLD_RANK "
                "OMPI_COMM_WORLD_SIZE; " +
                shards)
                .status,
            0);
  const Ran early = run("$S merge " + place_ + "/parts");
  EXPECT_EQ(early.status, 2);
  EXPECT_THAT(early.err, HasSubstr("shard 2 of 3 is missing"));
  EXPECT_EQ(run(shards + " --shard 2/3").status, 0);
  const Ran merged = run("$S merge " + place_ + "/parts -o " + place_ + "/all.db --jsonl " +
                         place_ + "/all.jsonl");
  EXPECT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(run.Read("all.jsonl"), run.Read("campaign/results.jsonl"));
  EXPECT_TRUE(std::filesystem::exists(place_ + "/all.db"));
  const auto without_times = [](std::string table) {
    const std::size_t line = table.find("  step p50");
    return table.erase(line, table.find('\n', line) + 1 - line);
  };
  EXPECT_EQ(without_times(merged.out), without_times(whole.out));
}

TEST_F(SweepCommandTest, ComparesCombinationsAsMarkdownAndAsAFigure) {
  const std::string methods = place_ + "/methods";
  EXPECT_EQ(run("$S sweep " + file_ + " --samples 3 --vary parameters.slope=0.1,0.5 -o " + methods)
                .status,
            0);
  const Ran table = run("$S merge " + methods + " --markdown");
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_EQ(std::count(table.out.begin(), table.out.end(), '\n'), 4);
  EXPECT_THAT(table.out, HasSubstr("| arrived |"));
  EXPECT_THAT(table.out, HasSubstr("| slope=0.1 | 0 % "));
  EXPECT_THAT(table.out, HasSubstr("| slope=0.5 | 100 % "));
  const Ran plot =
      run("$S plot --figure method-comparison " + methods + " -o " + place_ + "/m.svg");
  EXPECT_EQ(plot.status, 0) << plot.err;
  const std::string figure = run.Read("m.svg");
  EXPECT_THAT(figure, HasSubstr("tiny: at the goal after"));
  EXPECT_THAT(figure, HasSubstr("slope=0.5"));
  // No run with 0.1 arrives, so it has no curve; no run has a distance, so there is no such panel.
  EXPECT_EQ(figure.find("slope=0.1"), std::string::npos);
  EXPECT_EQ(figure.find("came no nearer"), std::string::npos);
  EXPECT_EQ(run("$S plot --figure method-comparison -o " + place_ + "/n.svg").status, 2);
  const Ran missing =
      run("$S plot --figure method-comparison " + place_ + "/none -o " + place_ + "/n.svg");
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, HasSubstr("none"));
}

TEST_F(SweepCommandTest, TellsTheStatusOfItsRuns) {
  EXPECT_EQ(run(sweep_ + "-s parameters.gain=word").status, 2);
  EXPECT_FALSE(std::filesystem::exists(place_ + "/campaign"));
  run.folder().Write("strict.yaml", std::string(sweep::kTinyDiagram) +
                                        "expect:\n  final_error: {at_most: 0.01}\n");
  const std::string strict = "$S sweep " + place_ + "/strict.yaml --samples 3 -o " + place_;
  EXPECT_EQ(run(strict + "/a").status, 3);
  EXPECT_EQ(run(strict + "/b -s parameters.slope=0.5").status, 0);
  const Ran lost = run(strict + "/c -s parameters.slope=1e308");
  EXPECT_EQ(lost.status, 1);
  EXPECT_THAT(lost.out, HasSubstr("failed: "));
}

TEST_F(SweepCommandTest, RefusesWhatItCannotDo) {
  EXPECT_EQ(run("$S sweep " + file_ + " -o " + place_ + "/o").status, 64) << "no --samples";
  EXPECT_EQ(run("$S sweep " + file_ + " --samples 3").status, 64) << "no folder";
  const Ran vary = run(sweep_ + "--vary 'parameters.gain=unifrom(1,2)'");
  EXPECT_EQ(vary.status, 2);
  EXPECT_THAT(vary.err, HasSubstr("did you mean 'uniform'?"));
  EXPECT_EQ(run(sweep_ + "--vary 'parameters.gain=uniform(1)'").status, 2);
  EXPECT_EQ(run(sweep_ + "--shard 3/3").status, 2);
  EXPECT_EQ(run("$S sweep " + file_ + " --samples 3 -j 0 -o " + place_ + "/o").status, 2);
  EXPECT_EQ(run("$S sweep missing.yaml --samples 3 -o " + place_ + "/o").status, 2);
  const Ran misspelt = run("$S sweep " + file_ + " --sample 3 -o x --vray a=1");
  EXPECT_EQ(misspelt.status, 64);
  EXPECT_THAT(misspelt.err, HasSubstr("did you mean '--samples'?"));
  EXPECT_EQ(run(sweep_ + "-o /nowhere/at/all").status, 64) << "-o twice";
}

}  // namespace sweep_command_test
}  // namespace oca::tools
