// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sweep/campaign.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "oca/framework/dataflow/error.h"

namespace oca::sweep {
namespace campaign_test {

using testing::HasSubstr;

Campaign Example() {
  Campaign campaign;
  campaign.file = "dir/it's.yaml";
  campaign.name = "it";
  campaign.file_hash = "0123";
  campaign.overrides = {"parameters.c=[1, 2]"};
  campaign.variations = {Variation::Parse("a=1,2"), Variation::Parse("x=integers(0,9)"),
                         Variation::Parse("b=p,q,r")};
  campaign.seed = 7;
  campaign.samples = 10;
  campaign.duration = 2.5;
  campaign.version = "1";
  return campaign;
}

// Computed with Python's integers from the definition of models::Random::Seed.
TEST(CampaignTest, GivesEachSampleTheSeedThatItAlwaysHad) {
  Campaign campaign;
  EXPECT_EQ(campaign.SeedOf(0), 605077779);
  EXPECT_EQ(campaign.SeedOf(1), 1325445140);
  campaign.seed = 7;
  EXPECT_EQ(campaign.SeedOf(0), 979031526);
  EXPECT_EQ(campaign.SeedOf(999), 523259192);
}

TEST(CampaignTest, HardlyEverGivesASeedTwice) {
  Campaign campaign;
  std::set<int> seeds;
  for (std::int64_t i = 0; i < 1000; ++i) {
    EXPECT_GE(campaign.SeedOf(i), 0);
    seeds.insert(campaign.SeedOf(i));
  }
  campaign.seed = 1;
  for (std::int64_t i = 0; i < 1000; ++i) seeds.insert(campaign.SeedOf(i));
  EXPECT_EQ(seeds.size(), 2000u);
}

TEST(CampaignTest, CombinesListedValuesTheLastOneFastest) {
  const auto combinations = Example().Combinations();
  ASSERT_EQ(combinations.size(), 6u);
  EXPECT_EQ(combinations[0], (Settings{{"a", "1"}, {"b", "p"}}));
  EXPECT_EQ(combinations[1], (Settings{{"a", "1"}, {"b", "q"}}));
  EXPECT_EQ(combinations[3], (Settings{{"a", "2"}, {"b", "p"}}));
  EXPECT_EQ(Campaign().Combinations().size(), 1u);
}

TEST(CampaignTest, WritesTheCommandThatRunsASampleAlone) {
  const Campaign campaign = Example();
  const std::string drawn = campaign.Drawn(42).at(0).second;
  EXPECT_EQ(
      campaign.CommandOf(42, campaign.Combinations()[1]),
      "simulator run 'dir/it'\\''s.yaml' -t 2.5 -s 'parameters.c=[1, 2]' -s a=1 -s b=q -s x=" +
          drawn + " --seed 42");
}

TEST(CampaignTest, ReadsTheHeaderItWrites) {
  const Campaign campaign = Example();
  const Campaign again = Campaign::FromHeader(campaign.Header());
  EXPECT_EQ(again.Header(), campaign.Header());
  EXPECT_EQ(again.DifferenceTo(campaign), "");
  for (const char* line : {"", "{}", "[1]", R"({"campaign":{"file":1}})", "\xff"}) {
    EXPECT_THROW(Campaign::FromHeader(line), ConfigError) << line;
  }
}

TEST(CampaignTest, TellsApartWhatCannotBeCompared) {
  Campaign other = Example();
  other.file = "elsewhere/same.yaml";
  EXPECT_EQ(Example().DifferenceTo(other), "");
  other.seed = 8;
  other.file_hash = "4567";
  EXPECT_EQ(Example().DifferenceTo(other),
            "file_hash: \"0123\" against \"4567\", seed: 7 against 8");
}

TEST(CampaignTest, RefusesWhatIsSetTwiceOrOutOfBounds) {
  const auto refused = [](auto change, const char* why) {
    Campaign campaign = Example();
    change(campaign);
    try {
      campaign.Check();
      ADD_FAILURE() << why;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr(why));
    }
  };
  EXPECT_NO_THROW(Example().Check());
  refused([](Campaign& c) { c.overrides.emplace_back("x=3"); }, "x: set twice");
  refused([](Campaign& c) { c.overrides.emplace_back("simulator.seed=3"); }, "--seed of the sweep");
  refused([](Campaign& c) { c.samples = 0; }, "samples: got 0");
  refused([](Campaign& c) { c.arrival = -1.0; }, "arrival: got -1");
  refused([](Campaign& c) { c.duration = -1.0; }, "duration: got -1");
}

TEST(ShardTest, ReadsIndexAndCount) {
  EXPECT_EQ(Shard::Parse("2/3").index, 2);
  EXPECT_EQ(Shard::Parse("2/3").Stem(), "shard-2-of-3");
  EXPECT_EQ(Shard::Parse("0/1").Stem(), "results");
  for (const char* text : {"", "3", "3/3", "-1/3", "1/", "/3", "a/b", "1/2/3", "1 /3"}) {
    EXPECT_THROW(Shard::Parse(text), ConfigError) << text;
  }
}

}  // namespace campaign_test
}  // namespace oca::sweep
