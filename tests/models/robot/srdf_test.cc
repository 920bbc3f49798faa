// SPDX-License-Identifier: BSD-3-Clause
#include "models/robot/srdf.h"

#include <gmock/gmock.h>

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

}  // namespace
}  // namespace oca::models::test
