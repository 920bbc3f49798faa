// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/model_set.h"

#include <gmock/gmock.h>

#include <string>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace model_set_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::ThrowsMessage;

bool All(const std::string& /*model*/) { return true; }

class ModelSetTest : public testing::Test {
 protected:
  ModelSetTest() {
    outer_.Add("left", arm_);
    outer_.Add("right", arm_);
    outer_.Add("table", LoadTestModel("table_frame"));
  }
  const std::shared_ptr<const robot::RobotModel> arm_ = LoadTestModel("planar2");
  ModelSet outer_;
  ModelSet inner_;
};

TEST_F(ModelSetTest, CallsAModelAsItsFileDoesOrElseTheNearestFileAroundIt) {
  inner_.Add("left", arm_, "right");
  inner_.Add("right", arm_, "left");
  inner_.AddOuter(outer_, All);
  EXPECT_EQ(inner_.FullName("left"), "right");
  EXPECT_EQ(inner_.FullName("table"), "table");
  ModelSet innermost;
  innermost.Add("arm", arm_, inner_.FullName("left"));
  innermost.AddOuter(inner_, All);
  EXPECT_EQ(innermost.FullName("right"), "left");
  EXPECT_EQ(innermost.FullName("nobody"), "nobody");
  EXPECT_THAT(innermost.in_sight(),
              ElementsAre(Pair("left", "right"), Pair("right", "arm"), Pair("table", "table")));
  EXPECT_THROW(innermost.Get("right"), ConfigError) << "has a name for it elsewhere alone";
}

TEST_F(ModelSetTest, HasInSightWhatStandsAndOfWhatMovesThatWhichIsLetIn) {
  inner_.Add("arm", arm_, "inner.arm");
  inner_.AddOuter(outer_, [](const std::string& model) { return model == "right"; });
  EXPECT_THAT(inner_.in_sight(), ElementsAre(Pair("inner.arm", "arm"), Pair("right", "right"),
                                             Pair("table", "table")));
  EXPECT_EQ(inner_.all().size(), 4u);
  EXPECT_EQ(inner_.FullName("left"), "left");
}

TEST_F(ModelSetTest, NamesInputsOfLinksAsTheFileNamesTheModels) {
  inner_.Add("arm", arm_, "right");
  inner_.Add("neighbour", arm_, "left");
  inner_.AddOuter(outer_, All);
  for (const std::string others : {"neighbour", "*"}) {
    const BulletDistance distance({.model = "arm", .others = {others}}, inner_);
    EXPECT_NO_THROW(distance.FindInput("links_neighbour"));
    EXPECT_EQ(distance.links_of_others.size(), 1u);
  }
}

TEST_F(ModelSetTest, RefusesTwoModelsThatComeInByOneName) {
  outer_.Add("neighbour", arm_);
  inner_.Add("arm", arm_, "right");
  inner_.Add("neighbour", arm_, "left");
  inner_.AddOuter(outer_, All);
  EXPECT_THAT([&] { BulletDistance({.model = "arm", .others = {"*"}}, inner_); },
              ThrowsMessage<ConfigError>(HasSubstr(
                  "others: got links_neighbour for both 'left' and 'neighbour'; expected a name "
                  "in this file for either of them")));
  EXPECT_NO_THROW(BulletDistance({.model = "arm", .others = {"neighbour"}}, inner_));
}

TEST_F(ModelSetTest, RefusesNamesWithWhatStandsBetweenNames) {
  for (const std::string name : {"a.b", "a/b"}) {
    EXPECT_THAT([&] { outer_.Add(name, arm_); },
                ThrowsMessage<ConfigError>("name; got '" + name +
                                           "'; expected one without dots and slashes"));
  }
  EXPECT_NO_THROW(outer_.Add("a_b", arm_));
}

}  // namespace model_set_test
}  // namespace oca::systems
