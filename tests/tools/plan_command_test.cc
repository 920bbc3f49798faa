// SPDX-License-Identifier: BSD-3-Clause
// `simulator plan`: whether somebody who knows the whole script gets through.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace oca::tools {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class PlanCommandTest : public testing::Test {
 protected:
  json Plan(const std::string& arguments) {
    const Ran ran = run("$S plan " + arguments);
    EXPECT_EQ(ran.status, 0) << ran.err;
    json plan = json::parse(ran.out);
    plan.erase("seconds");
    return plan;
  }
  Program run;
};

TEST_F(PlanCommandTest, ClearsACubeThatComesHeadOnWithinTheLimitsTwiceTheSameWay) {
  const json plan = Plan("diagrams/scenarios/head_on.yaml");
  EXPECT_TRUE(plan.at("clear").get<bool>());
  EXPECT_GT(plan.at("min_distance").get<double>(), 0.0);
  EXPECT_GT(plan.at("speed").get<double>(), 0.0);
  EXPECT_LE(plan.at("speed").get<double>(), 1.0);
  EXPECT_EQ(plan, Plan("diagrams/scenarios/head_on.yaml"));
}

TEST_F(PlanCommandTest, SaysThatABoxInTheArmFromTheBeginningIsNotCleared) {
  const json plan = Plan(
      "diagrams/scenarios/head_on.yaml --starts 2 -t 2 "
      "-s parameters.obstacle_x=0 -s parameters.obstacle_y=0 -s parameters.obstacle_speed=0");
  EXPECT_FALSE(plan.at("clear").get<bool>());
  EXPECT_LT(plan.at("min_distance").get<double>(), 0.0);
}

TEST_F(PlanCommandTest, NeedsARequestAndObstacles) {
  const Ran ran = run("$S plan diagrams/dual_arm.yaml");
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("spline: no system of that name"));
}

}  // namespace
}  // namespace oca::tools
