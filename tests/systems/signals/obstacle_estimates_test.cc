// SPDX-License-Identifier: BSD-3-Clause
// What a tracker says of obstacles, as text.
#include <gmock/gmock.h>

#include "tests/systems/signals/signal_texts.h"

namespace oca::systems {
namespace obstacle_estimates_test {

using test::kObstacle;
using test::Refusal;
using test::WriteText;
using ::testing::HasSubstr;

/// What a tracker says of a ball: 36 entries of the covariance, of which the first is given.
std::string Tracked(const std::string& id, const std::string& first) {
  std::string text = R"({"id":")" + id + R"(","shape":{"type":"sphere","radius":0.1},)" +
                     R"("pose":{"xyz":[1.0,2.0,3.0],"quaternion":[0.0,0.0,0.0,1.0]},)" +
                     R"("twist":{"linear":[0.1,0.0,0.0],"angular":[0.0,0.0,0.5]},)" +
                     R"("acceleration":[0.0,0.0,-9.81],"covariance":[)" + first;
  for (int i = 1; i < 36; ++i) text += i % 7 == 0 ? ",0.5" : ",0.0";
  return text + R"(],"age":0.05})";
}

TEST(ObstacleEstimatesTest, AnEstimateIsWrittenAsItIsRead) {
  const std::string text = "[" + Tracked("a", "0.25") + "," + Tracked("b", "0.75") + "]";
  const auto set = Signal<ObstacleSet>::ReadJson(text);
  ASSERT_EQ(set.estimates.size(), 2u);
  EXPECT_EQ(set.estimates[0].covariance(0, 0), 0.25);
  EXPECT_EQ(set.estimates[1].covariance(5, 5), 0.5);
  EXPECT_EQ(set.estimates[1].acceleration.z(), -9.81);
  EXPECT_EQ(set.estimates[1].age, 0.05);
  EXPECT_TRUE(Signal<ObstacleSet>::Check(set, Look::kWhole).ok());
  EXPECT_EQ(WriteText(set), text);
}

TEST(ObstacleEstimatesTest, AnObstacleWithoutTwistHasAVelocityThatNobodyKnows) {
  const std::string text = R"([{"id":"a","shape":{"type":"sphere","radius":0.1},)"
                           R"("pose":{"xyz":[1.0,2.0,3.0],"quaternion":[0.0,0.0,0.0,1.0]}}])";
  const auto set = Signal<ObstacleSet>::ReadJson(text);
  EXPECT_FALSE(set.obstacles[0].velocity_known);
  EXPECT_TRUE(Signal<ObstacleSet>::ReadJson(kObstacle).obstacles[0].velocity_known);
  EXPECT_EQ(WriteText(set), text);
}

TEST(ObstacleEstimatesTest, EstimatesAreWholeAndOfAllObstacles) {
  std::string without = Tracked("a", "1.0");
  without.replace(without.find("\"age\""), 5, "\"ags\"");
  EXPECT_THAT(Refusal<ObstacleSet>("[" + without + "]"), HasSubstr("ags"));
  std::string few = Tracked("a", "1.0");
  few.erase(few.find(",0.0", few.find("covariance")), 4);
  EXPECT_THAT(Refusal<ObstacleSet>("[" + few + "]"), HasSubstr("got 35 numbers; expected 36"));
  std::string known = kObstacle;
  known.insert(known.size() - 1, "," + Tracked("a", "1.0"));
  EXPECT_THAT(Refusal<ObstacleSet>(known), HasSubstr("an estimate of some obstacles"));
}

}  // namespace obstacle_estimates_test
}  // namespace oca::systems
