// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "oca/diagrams/record/mcap_reader.h"
#include "oca/diagrams/record/run_metadata.h"
#include "tests/tools/program.h"

namespace oca::tools {
namespace record_command_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class RecordCommandTest : public testing::Test {
 protected:
  /// `$D` stands for a folder of this test's own.
  Ran Run(const std::string& line) const {
    return program_("D=" + program_.folder().path().string() + " && " + line);
  }
  record::McapFile Read(const std::string& name) const {
    return record::McapFile::Read(program_.folder().path() / name);
  }
  Program program_;
};

TEST_F(RecordCommandTest, ARecordRunsAgainWithTheSameBits) {
  EXPECT_EQ(Run("$S run diagrams/static_test.yaml --seed 7 --record $D/a.mcap").status, 0);
  EXPECT_EQ(Run("cd / && $S run $D/a.mcap --record $D/b.mcap").status, 0);
  const Ran same = Run("$S compare $D/a.mcap $D/b.mcap");
  EXPECT_EQ(same.status, 0) << same.out << same.err;
  EXPECT_THAT(same.out, StartsWith("no difference in "));
  EXPECT_EQ(Read("b.mcap").FindMetadata("oca")->at("seed"), "7");
}

TEST_F(RecordCommandTest, AnOverrideChangesOneThingOfARecord) {
  EXPECT_EQ(Run("$S run diagrams/static_test.yaml --record $D/a.mcap").status, 0);
  EXPECT_EQ(Run("$S run $D/a.mcap -s parameters.avoid=false --record $D/b.mcap").status, 3);
  const Ran compared = Run("$S compare $D/a.mcap $D/b.mcap");
  EXPECT_EQ(compared.status, 1);
  EXPECT_THAT(compared.out, StartsWith("first difference at "));
  EXPECT_THAT(compared.out, HasSubstr("* min_distance "));
}

TEST_F(RecordCommandTest, ARunOfARecordIsWarnedAsTheFirstOneWas) {
  const Ran first = Run("$S run diagrams/static_test.yaml --record $D/a.mcap");
  EXPECT_THAT(first.err, HasSubstr("avoidance_report.yaml:28:15: warning: systems.relaxation: "
                                   "the loop must chatter"));
  EXPECT_EQ(Run("$S run $D/a.mcap --record $D/b.mcap").err, first.err);
  EXPECT_EQ(Run("$S run $D/b.mcap").err, first.err);
  EXPECT_EQ(record::WarningsOf(Read("b.mcap")).size(), 1u);
  // With something changed, the diagram is another one; its files are in the record.
  const Ran gentle = Run("$S run $D/a.mcap -s parameters.relaxation_time=0.4");
  EXPECT_THAT(gentle.err, Not(HasSubstr("chatter")));
  const Ran changed = Run("$S run $D/a.mcap -s parameters.relaxation_time=0.01");
  EXPECT_THAT(changed.err, HasSubstr("/a.mcap/sources/"));
  EXPECT_THAT(changed.err, HasSubstr("got 0.01 s"));
  EXPECT_THAT(changed.err, Not(HasSubstr("oca_record_")));
}

TEST_F(RecordCommandTest, ExportsWhatCsvOfTheRunItselfHolds) {
  EXPECT_EQ(Run("$S run diagrams/static_test.yaml -t 2 --record $D/a.mcap --csv $D/run").status, 3);
  EXPECT_EQ(Run("$S export $D/a.mcap --csv $D/record").status, 0);
  EXPECT_EQ(std::stoi(Run("ls $D/run/*.csv $D/run/*.jsonl | wc -l").out), 5);
  EXPECT_EQ(std::stoi(Run("wc -l < $D/run/distance.proximities.jsonl").out), 201);
  EXPECT_EQ(Run("for f in $D/run/*; do cmp $f $D/record/${f##*/} || exit 1; done").status, 0);
}

TEST_F(RecordCommandTest, AKilledRunLeavesAReadableFile) {
  Run("$S run diagrams/static_test.yaml --realtime --record $D/a.mcap & pid=$!; sleep 2.5; "
      "kill -9 $pid");
  const record::McapFile file = Read("a.mcap");
  EXPECT_FALSE(file.complete());
  EXPECT_GE(file.MessagesOf("/plant/position").size(), 80u);  // a second at the very least
  EXPECT_EQ(file.FindMetadata("oca")->at("outcome"), "running");
  EXPECT_NE(file.FindAttachment("diagram.yaml"), nullptr);
  EXPECT_THAT(Run("$S export $D/a.mcap --csv $D/out").err, HasSubstr("breaks off at byte"));
}

TEST_F(RecordCommandTest, AnInterruptedRunEndsItsRecord) {
  const Ran ran =
      Run("$S run diagrams/static_test.yaml --realtime --record $D/a.mcap & pid=$!; sleep 1; "
          "kill -TERM $pid; wait $pid");
  EXPECT_EQ(ran.status, 130);
  EXPECT_TRUE(Read("a.mcap").complete());
  EXPECT_EQ(Read("a.mcap").FindMetadata("oca")->at("outcome"), "interrupted");
}

TEST_F(RecordCommandTest, PlotsSignalsOfSeveralRuns) {
  Run("$S run diagrams/static_test.yaml -t 2 --record $D/a.mcap");
  Run("$S run diagrams/static_test.yaml -t 2 -s parameters.avoid=false --record $D/b.mcap");
  const Ran plotted =
      Run("$S plot $D/a.mcap $D/b.mcap --signal 'plant.position.*_1' --signal "
          "distance.proximities -o $D/x.svg");
  EXPECT_EQ(plotted.status, 0) << plotted.err;
  const std::string svg = program_.Read("x.svg");
  EXPECT_THAT(svg, StartsWith("<svg "));
  EXPECT_THAT(svg, HasSubstr("stroke-dasharray"));
  EXPECT_THAT(svg, HasSubstr("[rad]"));
}

TEST_F(RecordCommandTest, DrawsTheFiguresOfTheReport) {
  for (const std::string figure : {"report-3.5", "report-4.1", "report-4.2"}) {
    EXPECT_EQ(Run("$S plot --figure " + figure + " -o $D/f.svg").status, 0) << figure;
    EXPECT_THAT(program_.Read("f.svg"), StartsWith("<svg "));
  }
}

TEST_F(RecordCommandTest, RefusesWhatItCannotDraw) {
  Run("$S run diagrams/static_test.yaml -t 0.1 --record $D/a.mcap");
  EXPECT_EQ(Run("$S plot $D/a.mcap --signal nothing -o $D/x.svg").status, 2);
  EXPECT_EQ(Run("$S plot $D/a.mcap --signal 'plant.*' -o $D/x.jpg").status, 2);
  EXPECT_EQ(Run("$S plot -o $D/x.svg").status, 2);
  EXPECT_EQ(Run("$S plot --figure report-9 -o $D/x.svg").status, 64);
}

TEST_F(RecordCommandTest, RefusesFilesThatAreNoRecordsOrCannotBeWritten) {
  EXPECT_EQ(Run("$S compare README.md README.md").status, 2);
  EXPECT_EQ(Run("$S export /nowhere.mcap --csv $D/x").status, 2);
  EXPECT_EQ(Run("$S run diagrams/static_test.yaml --record /nowhere/x.mcap").status, 2);
  EXPECT_EQ(Run("$S run diagrams/static_test.yaml --record $D/x --record-compression rar").status,
            64);
}

}  // namespace record_command_test
}  // namespace oca::tools
