// SPDX-License-Identifier: BSD-3-Clause
// The program as a user meets it: words, exit statuses and streams.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/small_diagram.h"

namespace oca::tools {
namespace command_line_test {

using nlohmann::json;
using testing::HasSubstr;

TEST_F(CommandLineTest, ARunThatMeetsItsExpectationsEndsWithZero) {
  const Ran ran = run("$S run diagrams/static_test.yaml -s parameters.relaxation_time=0.4");
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "");
  for (const char* part : {"static_test", "clear", "reached", "met", "times real time"}) {
    EXPECT_THAT(ran.out, HasSubstr(part));
  }
}

TEST_F(CommandLineTest, AMethodIsJudgedByWhatItKeeps) {
  const Ran filter = run("$S run diagrams/static_test.yaml -s parameters.avoidance=safety_filter");
  EXPECT_EQ(filter.status, 0);
  EXPECT_EQ(filter.err, "");
  EXPECT_THAT(filter.out, HasSubstr("met min_distance >= 0.0446 "));  // 0.05 less its margin
  const Ran wider =
      run("$S run diagrams/static_test.yaml -s parameters.avoidance=safety_filter "
          "-s parameters.safe_distance=0.1");
  EXPECT_EQ(wider.status, 0);
  EXPECT_THAT(wider.out, HasSubstr("met min_distance >= 0.0946 "));
}

TEST_F(CommandLineTest, ARunSaysWhetherTheArmKeptItsLimits) {
  const std::string command =
      "$S run diagrams/static_test.yaml -t 6 -s parameters.avoidance=report "
      "-s models.arm.acceleration_limits=";
  EXPECT_THAT(run(command + "0.5").out, HasSubstr("limits       NOT KEPT"));
  EXPECT_THAT(run(command + "1000").out,
              testing::AllOf(HasSubstr("joint speed up to"), testing::Not(HasSubstr("NOT KEPT"))));
}

TEST_F(CommandLineTest, ARateOfZeroIsOneError) {
  const Ran ran = run("$S run diagrams/static_test.yaml -s parameters.rate=0");
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("${1 / rate}: the result is not finite; rate is 0 (-s "));
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
}

TEST_F(CommandLineTest, AReportWithoutItsPageLeavesNoFile) {
  const std::string file = (run.folder().path() / "r.html").string();
  std::filesystem::create_directory(run.folder().path() / "bin");  // with no page beside it
  const Ran ran = run("cp $S " + (run.folder().path() / "bin").string() + " && " +
                      (run.folder().path() / "bin/simulator").string() +
                      " run diagrams/static_test.yaml -t 0.1 --report " + file);
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("viewer page: file; got none of"));
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST_F(CommandLineTest, WarnsOfALoopThatMustChatterInOneLineAndRuns) {
  const Ran ran = run("$S run diagrams/static_test.yaml -t 0.1 --json");
  EXPECT_THAT(ran.err, HasSubstr("warning: systems.relaxation: the loop must chatter: g = 9.7"));
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1);
  EXPECT_TRUE(json::accept(ran.out));
}

TEST_F(CommandLineTest, SaysWhatIsNoOrigin) {
  for (const char* origin : {"'*'", "null", "https://a.example/path"}) {
    const Ran ran =
        run(std::string("$S run diagrams/static_test.yaml --live=0 --live-origin ") + origin);
    EXPECT_EQ(ran.status, 2);
    EXPECT_THAT(ran.err, HasSubstr("live: origin; got "));
  }
}

TEST_F(CommandLineTest, AnExpectationThatIsNotMetEndsWithThreeAndTheFullResult) {
  const Ran ran = run("$S run diagrams/static_test.yaml -s parameters.avoid=false");
  EXPECT_EQ(ran.status, 3);
  EXPECT_THAT(ran.out, HasSubstr("CONTACT"));
  EXPECT_THAT(ran.out, HasSubstr("NOT MET min_distance >= 0.2"));
  const Ran json_run = run("$S run diagrams/static_test.yaml -s parameters.avoid=false --json");
  EXPECT_EQ(json_run.status, 3);
  EXPECT_LT(json::parse(json_run.out)["metrics"]["min_distance"].get<double>(), -0.1);
}

TEST_F(CommandLineTest, ABadFileEndsWithTwoAndNothingOnStandardOutput) {
  for (const std::string& arguments :
       {std::string("run missing.yaml"), std::string("run diagrams"),
        "run " + Small("Constant", "Constnat"), std::string("run diagrams/static_test.yaml -t -1"),
        std::string("run diagrams/static_test.yaml -s parameters.alhpa=1"),
        std::string("run diagrams/static_test.yaml -s systems.limiter.enabeld=false"),
        std::string("run diagrams/static_test.yaml -s nonsense"), std::string("graph missing.yaml"),
        std::string("check missing.yaml"), std::string("describe DeltaLimter"),
        std::string("eval Gian")}) {
    const Ran ran = run("$S " + arguments);
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_EQ(ran.out, "") << arguments;
    EXPECT_NE(ran.err, "") << arguments;
  }
}

TEST_F(CommandLineTest, AProfileShowsWhatEachSystemTook) {
  const Ran ran = run("$S run " + Small() + " --profile");
  EXPECT_EQ(ran.status, 0) << ran.err;
  for (const char* part : {"calls", "source", "lag", "(engine, record)", "share"}) {
    EXPECT_THAT(ran.out, HasSubstr(part));
  }
  const json profile = json::parse(run("$S run " + Small() + " --profile --json").out)["profile"];
  ASSERT_EQ(profile.size(), 2u);
  EXPECT_EQ(profile[0]["system"], "source");
  EXPECT_EQ(profile[0]["calls"], 1) << "a constant is computed once";
  EXPECT_GT(profile[1]["calls"].get<int>(), 1);
  EXPECT_FALSE(json::parse(run("$S run " + Small() + " --json").out).contains("profile"));
}

TEST_F(CommandLineTest, RealTimeIsKeptAndOverrunsAreTold) {
  const Ran ran = run("$S run --realtime=50 " + Small());
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("overruns"));
  const json result = json::parse(run("$S run --realtime=50 --json " + Small()).out);
  EXPECT_GE(result["wall_seconds"].get<double>(), 0.5 / 50.0);
  EXPECT_TRUE(result.contains("overruns"));
  EXPECT_TRUE(result.contains("worst_overrun"));
  const std::string paced = Small("seed: 7", "realtime_factor: 25");
  EXPECT_GE(json::parse(run("$S run --json " + paced).out)["wall_seconds"].get<double>(), 0.02);
  // The command line wins over the file; without a number it is 1.
  EXPECT_FALSE(json::parse(run("$S run --realtime=0 --json " + paced).out).contains("overruns"));
  const json slow = json::parse(run("$S run --realtime --json " + paced).out);
  EXPECT_GE(slow["wall_seconds"].get<double>(), 0.5);
}

TEST_F(CommandLineTest, ANegativeRealTimeFactorIsRefused) {
  EXPECT_EQ(run("$S run --realtime=-1 " + Small()).status, 2);
  EXPECT_EQ(run("$S run " + Small("seed: 7", "realtime_factor: -1")).status, 2);
  EXPECT_EQ(run("$S run --realtime=often " + Small()).status, 64);
}

TEST_F(CommandLineTest, ErrorsInAFileAreToldWithPlaceAndSuggestion) {
  const Ran ran = run("$S check " + Small("type: Constant, value", "type: Constnat, vaule"));
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("small.yaml:4:18: error: "));
  EXPECT_THAT(ran.err, HasSubstr("did you mean 'Constant'?"));
}

TEST_F(CommandLineTest, ARunThatFailsEndsWithOneAndSaysWhere) {
  const std::string file = run.folder().Write(
      "fails.yaml",
      "simulator: {duration: 1000}\n"
      "systems: {a: {type: Integrator, initial: 1}, g: {type: Gain, gain: 1000}}\n"
      "connections: [g.out -> a.in, a.out -> g.in]\n");
  const Ran ran = run("$S run " + file + " --json");
  EXPECT_EQ(ran.status, 1) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("error: "));
  EXPECT_NE(json::parse(ran.out).at("failure"), "");
}

TEST_F(CommandLineTest, MisusedWordsEndWithSixtyFourAndASuggestion) {
  const auto misuse = [&](const std::string& arguments) {
    const Ran ran = run("$S " + arguments);
    EXPECT_EQ(ran.status, 64) << arguments;
    EXPECT_EQ(ran.out, "") << arguments;
    return ran.err;
  };
  EXPECT_THAT(misuse("rnu x.yaml"), HasSubstr("unknown command 'rnu'; did you mean 'run'?"));
  EXPECT_THAT(misuse("descrbe Gain"), HasSubstr("did you mean 'describe'?"));
  EXPECT_THAT(misuse("run x.yaml --jsn"),
              HasSubstr("unknown option '--jsn'; did you mean '--json'?"));
  EXPECT_THAT(misuse("run x.yaml --sede=3"), HasSubstr("did you mean '--seed'?"));
  EXPECT_THAT(misuse(""), HasSubstr("usage: simulator COMMAND"));
  EXPECT_THAT(misuse("run"), HasSubstr("FILE"));
  EXPECT_THAT(misuse("run x.yaml -t soon"), HasSubstr("soon"));
  EXPECT_THAT(misuse("run x.yaml --seed -1"), HasSubstr("seed"));
  EXPECT_THAT(misuse("graph x.yaml --format svgg"), HasSubstr("svgg"));
  EXPECT_THAT(misuse("run a.yaml b.yaml"), HasSubstr("b.yaml"));
  for (const char* file :
       {"run x.yaml --csv", "run x.yaml --record", "run x.yaml --report", "merge x --jsonl",
        "merge x -o", "sweep x.yaml --samples 1 -o", "plot x.mcap -o", "export x.mcap --csv"}) {
    EXPECT_THAT(misuse(std::string(file) + " ''"), HasSubstr("got an empty name")) << file;
  }
}

TEST_F(CommandLineTest, AFileWithoutANameIsRefusedInWords) {
  for (const char* command : {"check", "run"}) {
    const Ran ran = run(std::string("$S ") + command + " ''");
    EXPECT_EQ(ran.status, 2) << command;
    EXPECT_THAT(ran.err, HasSubstr("got an empty file name; expected a path")) << command;
  }
  const std::string file =
      run.folder()
          .Write("e.yaml",
                 "models: {arm: {urdf: ''}}\n"
                 "systems: {o: {type: ObstacleSource, obstacles: [{id: a, shape: {type: mesh, "
                 "file: ''}, pose: {xyz: [0, 0, 0]}}]}}\n")
          .string();
  const Ran ran = run("$S check " + file);
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("e.yaml:1:22: error: models.arm"));
  EXPECT_EQ(ran.err.find("filesystem error"), std::string::npos) << ran.err;
}

TEST_F(CommandLineTest, TheVersionIsANumber) {
  const Ran ran = run("$S --version");
  EXPECT_EQ(ran.status, 0);
  EXPECT_THAT(ran.out, testing::MatchesRegex("simulator \\(OCA\\) [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(CommandLineTest, HelpIsOnStandardOutput) {
  for (const char* arguments : {"--help", "run --help", "eval --help"}) {
    const Ran ran = run(std::string("$S ") + arguments);
    EXPECT_EQ(ran.status, 0) << arguments;
    EXPECT_THAT(ran.out, HasSubstr("--help")) << arguments;
    EXPECT_EQ(ran.err, "");
  }
}

TEST_F(CommandLineTest, JsonIsOneObjectWithTheAgreedKeys) {
  const Ran ran = run(
      "$S run diagrams/static_test.yaml -s parameters.relaxation_time=0.4 --json --seed 5 -t 2");
  EXPECT_EQ(ran.status, 3);  // after 2 s the goal is far
  EXPECT_EQ(ran.err, "");
  const json result = json::parse(ran.out);
  for (const char* key : {"name", "seed", "duration", "steps", "wall_seconds", "realtime_factor",
                          "metrics", "expectations", "blocked"}) {
    EXPECT_TRUE(result.contains(key)) << key;
  }
  EXPECT_EQ(result["name"], "static_test");
  EXPECT_EQ(result["seed"], 5);
  EXPECT_EQ(result["duration"], 2.0);
  EXPECT_EQ(result["steps"], 200);
  for (const char* key :
       {"min_distance", "min_distance_pair", "min_distance_time", "contact_time",
        "first_contact_time", "max_abs_delta", "final_error", "delta_sign_changes_per_second",
        "total_variation_ratio", "max_joint_speed", "max_joint_acceleration"}) {
    EXPECT_TRUE(result["metrics"].contains(key)) << key;
  }
  ASSERT_EQ(result["expectations"].size(), 2u);
  for (const char* key : {"name", "value", "bound", "ok"}) {
    EXPECT_TRUE(result["expectations"][0].contains(key)) << key;
  }
}

TEST_F(CommandLineTest, LogsGoToStandardError) {
  const Ran ran =
      run("$S run diagrams/static_test.yaml -t 0.1 -s parameters.print_infos=true --json");
  EXPECT_THAT(ran.err, HasSubstr("debug t="));
  EXPECT_TRUE(json::accept(ran.out));
  EXPECT_EQ(run("$S run diagrams/static_test.yaml -t 0.1 -s parameters.print_infos=true "
                "-s parameters.relaxation_time=0.4 --log-level info")
                .err,
            "");
}

TEST_F(CommandLineTest, RecordsAreWrittenAsFilesOfSignals) {
  const std::string folder = run.folder().path().string() + "/csv";
  EXPECT_EQ(run("$S run " + Small() + " --csv " + folder).status, 0);
  std::istringstream lines(run.Read("csv/lag.out.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "time,out[0],out[1]");
  std::getline(lines, line);
  EXPECT_EQ(line, "0,0,0");
  int rows = 1;
  for (std::string next; std::getline(lines, next); ++rows) line = next;
  EXPECT_EQ(rows, 6);  // 0, 0.1, ..., 0.5
  EXPECT_EQ(line.substr(0, 4), "0.5,");
  EXPECT_EQ(run("$S run diagrams/static_test.yaml -t 0.1 --csv " + folder).status, 3);
  EXPECT_THAT(run.Read("csv/distance.proximities.jsonl"), HasSubstr("{\"time\":0"));
  EXPECT_EQ(run("$S run " + Small() + " --csv " + folder + "/lag.out.csv").status, 2);
}

TEST_F(CommandLineTest, ARunWritesTheValuesThatItsRecordExports) {
  const std::string place = run.folder().path().string();
  ASSERT_EQ(run("$S run diagrams/static_test.yaml -t 0.1 --csv " + place + "/csv --record " +
                place + "/r.mcap")
                .status,
            3);
  ASSERT_EQ(run("$S export " + place + "/r.mcap --csv " + place + "/export").status, 0);
  std::istringstream ours(run.Read("csv/distance.proximities.jsonl"));
  std::istringstream theirs(run.Read("export/distance.proximities.jsonl"));
  int lines = 0;
  for (std::string one, other; std::getline(ours, one); ++lines) {
    ASSERT_TRUE(std::getline(theirs, other));
    EXPECT_EQ(json::parse(one), json::parse(other));
    EXPECT_TRUE(json::parse(one).at("value").contains("proximities"));
  }
  EXPECT_GT(lines, 1);
}

TEST_F(CommandLineTest, NoEscapeSequencesWithoutATerminal) {
  for (const char* environment : {"", "NO_COLOR=1 ", "TERM=dumb "}) {
    const Ran ran = run(std::string(environment) + "$S run diagrams/static_test.yaml");
    EXPECT_EQ((ran.out + ran.err).find('\033'), std::string::npos) << environment;
  }
}

TEST_F(CommandLineTest, OverridesWinOverTheFile) {
  const json result = json::parse(
      run("$S run " + Small() + " -s systems.source.value=[1,4] -s name=other --json").out);
  EXPECT_EQ(result["name"], "other");
  EXPECT_GT(result["expectations"][0]["value"].get<double>(), 3.5);
  EXPECT_FALSE(result["expectations"][0]["ok"].get<bool>());
}

TEST_F(CommandLineTest, AnObstacleThatFliesPastBetweenTwoSamplesIsNotCalledClear) {
  const Ran ran =
      run("$S run diagrams/dynamic_test.yaml -s parameters.obstacle_speed=400 "
          "-s parameters.obstacle_start=0.502 -s parameters.obstacle_stop=0.508");
  EXPECT_THAT(ran.out, HasSubstr("a contact is not ruled out"));
  EXPECT_THAT(run("$S run diagrams/dynamic_test.yaml").out, HasSubstr("m or more at every time"));
}

TEST_F(CommandLineTest, CheckSaysALineAFile) {
  const Ran ran = run("$S check diagrams/point_cloud.yaml " + Small() + " missing.yaml");
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(std::count(ran.out.begin(), ran.out.end(), '\n'), 2);
  EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1);
  EXPECT_EQ(run("$S check diagrams/*.yaml diagrams/verification/*.yaml").status, 0);
  const Ran other = run("$S check diagrams/static_test.yaml -s parameters.avoidance=safety_filter");
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_THAT(other.out, HasSubstr("filter"));  // and the margin that it keeps
  EXPECT_EQ(run("$S check diagrams/static_test.yaml -s parameters.avoidance=safty_filter").status,
            2);
}

}  // namespace command_line_test
}  // namespace oca::tools
