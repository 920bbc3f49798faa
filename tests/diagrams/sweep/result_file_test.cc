// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/result_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "oca/diagrams/sweep/merge.h"
#include "oca/framework/dataflow/error.h"
#include "tests/diagrams/sweep/tiny_campaign.h"

namespace oca::sweep {
namespace result_file_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

class SweepTest : public testing::Test {
 protected:
  fs::path Folder(const char* name) const { return place_.path() / name; }
  std::string MergeError(const char* name) const {
    try {
      MergeShards(Folder(name));
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  }
  /// Three shards in a folder.
  void RunShards(const char* name) const {
    for (int i = 0; i < 3; ++i) RunShard(campaign_, Folder(name), {i, 3});
  }

  test::TemporaryFolder place_;
  Campaign campaign_{TinyCampaign(place_)};
};

TEST_F(SweepTest, GivesTheSameBytesSeriallyInThreadsAndMergedFromShards) {
  const std::string serial = RunShard(campaign_, Folder("serial"));
  EXPECT_EQ(std::count(serial.begin(), serial.end(), '\n'), 1 + 12 * 2);
  EXPECT_EQ(RunShard(campaign_, Folder("threads"), {}, {.jobs = 4}), serial);
  RunShards("shards");
  const Results merged = MergeShards(Folder("shards"));
  WriteResults(Folder("merged.jsonl"), merged.campaign, merged.rows);
  EXPECT_EQ(Text(Folder("merged.jsonl")), serial);
  EXPECT_EQ(merged.timings.size(), 24u);
}

TEST_F(SweepTest, GivesEachCombinationTheSameScenario) {
  RunShard(campaign_, Folder("out"));
  const Results results = ReadResults(Folder("out") / "results.jsonl");
  ASSERT_EQ(results.rows.size(), 24u);
  for (std::size_t i = 0; i < 24; i += 2) {
    EXPECT_EQ(results.rows[i].seed, results.rows[i + 1].seed);
    EXPECT_EQ(results.rows[i].set[0], std::pair(std::string("parameters.goal"), std::string("5")));
    EXPECT_EQ(results.rows[i + 1].set[0].second, "7");
    EXPECT_EQ(results.rows[i].set[1], results.rows[i + 1].set[1]);
  }
}

TEST_F(SweepTest, GoesOnAfterALineThatWasCutOff) {
  const std::string whole = RunShard(campaign_, Folder("out"));
  const fs::path file = Folder("out") / "results.jsonl";
  fs::rename(file, file.string() + ".part");
  for (const std::uintmax_t cut : {whole.size() - 1, whole.size() - 20, whole.size() / 2,
                                   std::size_t{40}, std::size_t{1}, std::size_t{0}}) {
    std::ofstream(file.string() + ".part", std::ios::binary) << whole.substr(0, cut);
    fs::remove(file);
    EXPECT_EQ(RunShard(campaign_, Folder("out")), whole) << cut;
    EXPECT_FALSE(fs::exists(file.string() + ".part"));
  }
  // A machine that lost its power may leave zeros.
  std::ofstream(file.string() + ".part", std::ios::binary)
      << whole.substr(0, whole.size() / 2) << std::string(50, '\0') << '\n';
  fs::remove(file);
  EXPECT_EQ(RunShard(campaign_, Folder("out")), whole);
}

TEST_F(SweepTest, ARowThatIsThereTwiceCountsOnceUnlessTheySayDifferentThings) {
  const std::string whole = RunShard(campaign_, Folder("out"));
  const fs::path file = Folder("out") / "results.jsonl";
  const std::size_t first = whole.find('\n') + 1;
  const std::string row = whole.substr(first, whole.find('\n', first) + 1 - first);
  fs::remove(file);
  std::ofstream(file.string() + ".part", std::ios::binary) << whole << row;
  EXPECT_EQ(RunShard(campaign_, Folder("out")), whole);
  std::string other = row;
  char& digit = other[other.find_first_not_of("0123456789", other.find("\"seed\":") + 7) - 1];
  digit = digit == '1' ? '2' : '1';
  ASSERT_NE(other, row);
  std::ofstream(file, std::ios::binary) << whole << other << row;
  EXPECT_THAT([&] { ReadResults(file); },
              testing::ThrowsMessage<ConfigError>(HasSubstr("got two results of it")));
}

TEST_F(SweepTest, DoesNotRunAgainWhatIsThere) {
  std::atomic<int> steps{0};
  SweepOptions options;
  options.interrupted = [&steps] { return ++steps > 100; };
  EXPECT_EQ(RunShard(campaign_, Folder("out"), {}, options), "") << "interrupted";
  const std::size_t kept = ReadResults(Folder("out") / "results.jsonl.part").rows.size();
  EXPECT_GT(kept, 2u);
  EXPECT_LT(kept, 20u);
  options.interrupted = {};
  std::int64_t least = 100;
  options.progress = [&least](std::int64_t done, std::int64_t) { least = std::min(least, done); };
  EXPECT_EQ(RunShard(campaign_, Folder("out"), {}, options), RunShard(campaign_, Folder("fresh")));
  EXPECT_GE(least, static_cast<std::int64_t>(kept));
}

TEST_F(SweepTest, RefusesTheFolderOfAnotherCampaignAndADamagedFile) {
  RunShard(campaign_, Folder("out"));
  Campaign other = campaign_;
  other.seed = 4;
  EXPECT_THAT([&] { RunShard(other, Folder("out")); },
              testing::ThrowsMessage<ConfigError>(HasSubstr("seed: 4 against 3")));
  place_.Write("tiny.yaml", std::string(kTinyDiagram) + "record: {}\n");
  EXPECT_THAT([&] { RunShard(campaign_, Folder("out")); },
              testing::ThrowsMessage<ConfigError>(HasSubstr("file_hash: ")));
  place_.Write("bad/results.jsonl.part", "{}\n{}\n");
  EXPECT_THAT([&] { RunShard(campaign_, Folder("bad")); },
              testing::ThrowsMessage<ConfigError>(HasSubstr("results.jsonl.part:1: got '{}'")));
}

TEST_F(SweepTest, RefusesToWriteWhereAnotherProcessDoes) {
  Campaign inspected = campaign_;
  Inspect(inspected, loading::Blueprint(campaign_.file));
  const ResultFile first(Folder("out"), inspected, {});
  EXPECT_THAT([&] { ResultFile(Folder("out"), inspected, {}); },
              testing::ThrowsMessage<ConfigError>(HasSubstr("another process writes it")));
}

TEST_F(SweepTest, KeepsARowForARunThatFailsAndGoesOn) {
  campaign_.variations = {Variation::Parse("parameters.slope=choice(0.5, 1e308)"),
                          Variation::Parse("parameters.gain=choice(10, 10, 10, word)")};
  campaign_.samples = 40;
  RunShard(campaign_, Folder("out"), {}, {.jobs = 2});
  const Results results = ReadResults(Folder("out") / "results.jsonl");
  ASSERT_EQ(results.rows.size(), 40u);
  int finished = 0, failed = 0, not_loaded = 0;
  for (const SampleRow& row : results.rows) {
    const bool word = row.set[1].second == "word";
    const bool huge = row.set[0].second == "1e308";
    EXPECT_EQ(row.outcome, word   ? Outcome::kNotLoaded
                           : huge ? Outcome::kFailed
                                  : Outcome::kFinished);
    finished += row.outcome == Outcome::kFinished ? 1 : 0;
    if (row.outcome == Outcome::kFailed) {
      ++failed;
      EXPECT_THAT(row.error, HasSubstr("got a NaN or an infinity"));
    }
    if (row.outcome == Outcome::kNotLoaded) {
      ++not_loaded;
      EXPECT_THAT(row.error, HasSubstr("tiny.yaml:"));
    }
  }
  EXPECT_GT(finished, 0);
  EXPECT_GT(failed, 0);
  EXPECT_GT(not_loaded, 0);
}

TEST_F(SweepTest, EndsARunThatTakesTooLong) {
  RunShard(campaign_, Folder("out"), {}, {.timeout = 1e-9});
  const Results results = ReadResults(Folder("out") / "results.jsonl");
  ASSERT_EQ(results.rows.size(), 24u);
  for (const SampleRow& row : results.rows) EXPECT_EQ(row.outcome, Outcome::kTimedOut);
}

TEST_F(SweepTest, RefusesAFileThatIsWrongForEverySample) {
  campaign_.overrides = {"parameters.gian=3"};
  EXPECT_THROW(RunShard(campaign_, Folder("out")), ConfigError);
  EXPECT_FALSE(fs::exists(Folder("out")));
}

TEST_F(SweepTest, MergesOnlyWhatIsWholeAndOfOneCampaign) {
  EXPECT_THAT(MergeError("nowhere"), HasSubstr("expected a folder with the results of a sweep"));
  fs::create_directories(Folder("empty"));
  EXPECT_THAT(MergeError("empty"), HasSubstr("got no results"));

  RunShards("out");
  const fs::path first = Folder("out") / "shard-0-of-3.jsonl";
  const fs::path second = Folder("out") / "shard-1-of-3.jsonl";
  EXPECT_EQ(MergeError("out"), "");
  fs::rename(first, first.string() + ".part");
  fs::rename(second, Folder("second"));
  EXPECT_THAT(MergeError("out"), HasSubstr("shard 0 of 3 is not finished"));
  EXPECT_THAT(MergeError("out"), HasSubstr("shard 1 of 3 is missing"));
  fs::rename(first.string() + ".part", first);

  const std::string text = Text(Folder("second"));
  const auto write = [&](const std::string& changed) {
    std::ofstream(second, std::ios::binary) << changed;
  };
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1;
  write(text.substr(0, last));
  EXPECT_THAT(MergeError("out"), HasSubstr("1 runs (sample.combination) are missing: 10.1"));
  write(text + text.substr(last));
  EXPECT_EQ(MergeError("out"), "");
  write(text + Text(first).substr(Text(first).find('\n') + 1));
  EXPECT_THAT(MergeError("out"), HasSubstr("shard-1-of-3.jsonl holds sample 0"));
  std::string other = text;
  other.replace(other.find("\"seed\":3"), 8, "\"seed\":4");
  write(other);
  EXPECT_THAT(MergeError("out"), HasSubstr("seed: 3 against 4"));
  write(text);
  EXPECT_EQ(MergeError("out"), "");
  fs::copy(second, Folder("out") / "shard-1-of-2.jsonl");
  EXPECT_THAT(MergeError("out"), HasSubstr("got shards of divisions by 2, 3"));
}

}  // namespace result_file_test
}  // namespace oca::sweep
