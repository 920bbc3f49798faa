// SPDX-License-Identifier: BSD-3-Clause
#include "models/robot/srdf.h"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "models/error.h"
#include "tests/temporary_folder.h"

namespace oca::models::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;
using testing::ThrowsMessage;

std::vector<std::pair<int, int>> Load(const std::string& content) {
  const oca::test::TemporaryFolder folder;
  return LoadDisabledPairs(folder.Write("pairs.srdf", content).string(), {"base", "arm", "hand"});
}

TEST(SrdfTest, DisabledPairsAreFoundInAnyOrder) {
  EXPECT_THAT(Load(R"(<robot name="r"><group name="g"/>
                        <disable_collisions link1="hand" link2="arm" reason="Adjacent"/>
                        <disable_collisions link1="base" link2="arm"/></robot>)"),
              ElementsAre(Pair(0, 1), Pair(1, 2)));
  EXPECT_THAT(Load("<robot/>"), IsEmpty());
}

TEST(SrdfTest, DefaultsAreOverruledByNamedPairs) {
  EXPECT_THAT(Load(R"(<robot><enable_collisions link1="hand" link2="base"/>
                        <disable_default_collisions link="hand"/></robot>)"),
              ElementsAre(Pair(1, 2)));
}

TEST(SrdfTest, UnknownLinkIsRefusedWithItsLineAndTheNearestName) {
  EXPECT_THAT([] { Load("<robot>\n<disable_collisions link1='base' link2='amr'/></robot>"); },
              ThrowsMessage<ModelError>(
                  AllOf(HasSubstr("srdf:2:"), HasSubstr("'amr'"), HasSubstr("'arm'"))));
  EXPECT_THAT([] { Load("<robot><disable_collisions link1='base'/></robot>"); },
              ThrowsMessage<ModelError>(HasSubstr("link2")));
}

TEST(SrdfTest, OtherFilesAreRefused) {
  EXPECT_THROW(Load(""), ModelError);
  EXPECT_THROW(Load("<urdf/>"), ModelError);
  EXPECT_THROW(LoadDisabledPairs("/nowhere.srdf", {}), ModelError);
}

TEST(SrdfTest, WhatIsWrittenIsRead) {
  const oca::test::TemporaryFolder folder;
  const auto file = folder.path() / "new.srdf";
  SaveDisabledPairs(file, "r", {{"hand", "arm", "Adjacent"}, {"base", "hand", "Never"}});
  EXPECT_THAT(LoadDisabledPairs(file, {"base", "arm", "hand"}),
              ElementsAre(Pair(0, 2), Pair(1, 2)));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "new.srdf.part"));
}

TEST(SrdfTest, WritingReplacesTheComputedPairsOfAFileAndKeepsTheRest) {
  const oca::test::TemporaryFolder folder;
  const auto file = folder.Write("old.srdf", R"(<?xml version="1.0"?>
<!-- hand-made -->
<robot name="r">
  <group name="g"><chain base_link="base" tip_link="hand"/></group>
  <disable_collisions link1="base" link2="hand" reason="Never"/>
  <disable_collisions link1="base" link2="arm" reason="User"/>
</robot>)");
  SaveDisabledPairs(file, "r", {{"hand", "arm", "Adjacent"}, {"arm", "base", "Always"}});
  EXPECT_THAT(LoadDisabledPairs(file, {"base", "arm", "hand"}),
              ElementsAre(Pair(0, 1), Pair(1, 2)));
  std::ifstream in(file);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  EXPECT_THAT(text, AllOf(HasSubstr("hand-made"), HasSubstr("<chain"), HasSubstr("Adjacent"),
                          HasSubstr("User")));
  EXPECT_THAT(text, testing::Not(HasSubstr("Always"))) << "that pair stands there already";
}

TEST(SrdfTest, WritingRefusesAFileOfAnotherRobotAndLeavesItAsItIs) {
  const oca::test::TemporaryFolder folder;
  const auto file = folder.Write("other.srdf", "<robot name='s'/>");
  EXPECT_THAT([&] { SaveDisabledPairs(file, "r", {}); },
              ThrowsMessage<ModelError>(AllOf(HasSubstr("got 's'"), HasSubstr("expected 'r'"))));
  EXPECT_EQ(std::filesystem::file_size(file), 17u);
  EXPECT_THROW(SaveDisabledPairs(folder.Write("urdf", "<urdf/>"), "r", {}), ModelError);
  const auto urdf = folder.Write("r.urdf", "<robot name='r'><link name='l'/></robot>");
  EXPECT_THAT([&] { SaveDisabledPairs(urdf, "r", {}); },
              ThrowsMessage<ModelError>(HasSubstr("got a URDF")));
  EXPECT_THAT([&] { SaveDisabledPairs(folder.path() / "none" / "x.srdf", "r", {}); },
              ThrowsMessage<ModelError>(HasSubstr("x.srdf: SRDF to write")));
}

}  // namespace
}  // namespace oca::models::test
