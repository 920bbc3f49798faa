// SPDX-License-Identifier: BSD-3-Clause
// `simulator plan`: whether somebody who knows the whole script gets through.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/tools/program.h"

namespace oca::tools {
namespace plan_command_test {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two planar arms, 1.5 m apart. `left` should rest, stretched towards `right`, which is asked to
/// swing through it with its tip; a post stands where `left` would go to get out of the way.
constexpr const char* kTwoArms = R"(
name: two_arms
simulator: {duration: 6}
models:
  left: {urdf: package://planar3/planar3.urdf, srdf: package://planar3/planar3.srdf}
  right:
    urdf: package://planar3/planar3.urdf
    srdf: package://planar3/planar3.srdf
    base_pose: {xyz: [1.5, 0, 0]}
  post: {urdf: post.urdf}
systems:
  obstacles: {type: ObstacleSource, period: 0.01, obstacles: []}
  left_spline:
    type: SplineGenerator
    period: 0.01
    key_points: [{time: 0, position: [0, 0, 0]}]
  left_kinematics: {type: RobotKinematics, model: left}
  left_plant: {type: IntegratorPlant, initial_position: [0, 0, 0]}
  left_servo: {type: JointServo, mode: deadbeat, period: 0.01}
  distance: {type: BulletDistance, model: left, max_distance: 1, calculate_link_forces: true, others: [right, post]}
  metrics: {type: MotionMetrics, model: left, period: 0.01}
  right_spline:
    type: SplineGenerator
    period: 0.01
    key_points:
      - {time: 0.5, position: [1.6, 0, 0]}
      - {time: 3, position: [2.8, 0.7, 0]}
      - {time: 5.5, position: [1.6, 0, 0]}
  right_kinematics: {type: RobotKinematics, model: right}
  right_plant: {type: IntegratorPlant, initial_position: [1.6, 0, 0]}
  right_servo: {type: JointServo, mode: deadbeat, period: 0.01}
connections:
  - left_spline.position -> left_servo.position
  - left_plant.position -> left_servo.measured_position
  - left_servo.command -> left_plant.command
  - left_plant.position -> left_kinematics.position
  - left_kinematics.links -> distance.links
  - obstacles.obstacles -> distance.obstacles
  - right_kinematics.links -> distance.links_right
  - right_spline.position -> right_servo.position
  - right_plant.position -> right_servo.measured_position
  - right_servo.command -> right_plant.command
  - right_plant.position -> right_kinematics.position
  - right_plant.velocity -> right_kinematics.velocity
  - left_plant.position -> metrics.position
  - left_spline.position -> metrics.request
  - left_spline.goal -> metrics.goal
  - distance.proximities -> metrics.proximities
)";

constexpr const char* kPost = R"(<robot name="post"><link name="stand">
  <collision><origin xyz="0.5 -0.5 0"/><geometry><box size="0.1 0.1 0.4"/></geometry></collision>
</link></robot>)";

class PlanCommandTest : public testing::Test {
 protected:
  json Plan(const std::string& arguments, int status = 0) {
    const Ran ran = run("$S plan " + arguments);
    EXPECT_EQ(ran.status, status) << ran.err;
    json plan = json::parse(ran.out, nullptr, false);
    if (plan.is_object()) {
      for (const char* took : {"seconds", "search_seconds"}) plan.erase(took);
    }
    return plan;
  }
  double RequestedDistance(const std::string& arguments) {
    const Ran ran = run("$S run --json --no-progress " + arguments);
    return json::parse(ran.out).at("metrics").at("min_distance").get<double>();
  }
  std::string TwoArms() {
    run.folder().Write("post.urdf", kPost);
    return run.folder().Write("two_arms.yaml", kTwoArms).string() + " ";
  }
  Program run;
};

TEST_F(PlanCommandTest, ClearsACubeThatComesHeadOnWithinTheLimitsTwiceTheSameWay) {
  const json plan = Plan("diagrams/scenarios/head_on.yaml");
  EXPECT_TRUE(plan.at("clear").get<bool>());
  EXPECT_GT(plan.at("min_distance").get<double>(), 0.0);
  EXPECT_GT(plan.at("speed").get<double>(), 0.0);
  EXPECT_LE(plan.at("speed").get<double>(), 1.0 + 1e-9);
  EXPECT_EQ(plan, Plan("diagrams/scenarios/head_on.yaml"));
}

TEST_F(PlanCommandTest, ClearsTheBallAtTheElbowWithinAllLimitsWhateverTheSensorShows) {
  const json plan = Plan("diagrams/scenarios/elbow.yaml");
  EXPECT_TRUE(plan.at("clear").get<bool>());
  EXPECT_TRUE(plan.at("arrived").get<bool>());
  for (const char* limit : {"position", "speed", "acceleration"}) {
    EXPECT_LE(plan.at(limit).get<double>(), 1.0 + 1e-9) << limit;
  }
  EXPECT_TRUE(plan.at("acceleration_judged").get<bool>());
  EXPECT_EQ(Plan("diagrams/scenarios/fault_latency.yaml"), plan);  // judged by the ball as it is
}

TEST_F(PlanCommandTest, SaysThatAModelWithoutLimitsOfAccelerationIsNotJudgedByThem) {
  const std::string file = "diagrams/scenarios/task_line.yaml -s parameters.avoidance=";
  EXPECT_FALSE(Plan(file + "report").at("acceleration_judged").get<bool>());
  EXPECT_TRUE(Plan(file + "recommended").at("acceleration_judged").get<bool>());
  EXPECT_FALSE(Plan(file + "recommended").contains("jerk_judged"));
  EXPECT_FALSE(
      Plan(file + "recommended -s models.arm.jerk_limits=100").at("jerk_judged").get<bool>());
}

TEST_F(PlanCommandTest, EndsWithStatus3IfABoxIsInTheArmFromTheBeginning) {
  const json plan = Plan(
      "diagrams/scenarios/head_on.yaml --starts 2 -t 2 "
      "-s parameters.obstacle_x=0 -s parameters.obstacle_y=0 -s parameters.obstacle_speed=0",
      3);
  EXPECT_FALSE(plan.at("clear").get<bool>());
  EXPECT_LT(plan.at("min_distance").get<double>(), 0.0);
  EXPECT_EQ(plan.at("min_distance_pair").at(1), "cube");
  EXPECT_EQ(plan.at("min_distance_time"), 0.0);
}

TEST_F(PlanCommandTest, PrintsALineForEachSample) {
  const Ran ran = run("$S plan diagrams/scenarios/random_static.yaml --seed 1 --samples 2");
  EXPECT_EQ(ran.status, 0) << ran.err;
  ASSERT_EQ(std::count(ran.out.begin(), ran.out.end(), '\n'), 2);
  EXPECT_EQ(json::parse(ran.out.substr(0, ran.out.find('\n'))).at("seed"), 1);
  EXPECT_EQ(json::parse(ran.out.substr(ran.out.find('\n') + 1)).at("seed"), 2);
}

TEST_F(PlanCommandTest, SeesLinksOfAnArmAlongItsRequestAndOfAFrame) {
  const std::string file = TwoArms();
  EXPECT_LT(RequestedDistance(file), 0.0);
  const json plan = Plan(file);
  EXPECT_TRUE(plan.at("clear").get<bool>());
  EXPECT_GT(plan.at("tries").get<int>(), 0);
  EXPECT_THAT(plan.at("sees"),
              ElementsAre("obstacles", "right as requested by right_spline", "post"));
  const json blind = Plan(file + "-s systems.distance.calculate_link_forces=false");
  EXPECT_EQ(blind.at("tries"), 0);
  EXPECT_THAT(blind.at("sees"), ElementsAre("obstacles"));
}

TEST_F(PlanCommandTest, MeasuresARequestThatIsClearAsARunOfItDoes) {
  const std::string file = TwoArms() +
                           "-s systems.right_spline.key_points.1.position=[2.5,0,0] "
                           "-s 'systems.left_spline.key_points.0.position=[-1,0,0]' "
                           "-s 'systems.left_plant.initial_position=[-1,0,0]'";
  const json plan = Plan(file);
  EXPECT_EQ(plan.at("tries"), 0);
  EXPECT_EQ(plan.at("min_distance_pair").at(1), "post/stand");
  EXPECT_LT(plan.at("min_distance").get<double>(), 0.05);
  EXPECT_NEAR(plan.at("min_distance").get<double>(), RequestedDistance(file), 1e-9);
}

TEST_F(PlanCommandTest, ComparesItsWayWithTheShortestThatSearchesFind) {
  const json plan = Plan("diagrams/first.yaml --reference 0.05");
  EXPECT_TRUE(plan.at("arrived").get<bool>());
  // Straight it would be 2.6 rad, through the box.
  const double reference = plan.at("reference_length").get<double>();
  EXPECT_GT(reference, 2.6);
  EXPECT_LT(reference, 8.0);
  EXPECT_GT(plan.at("path_length").get<double>(), 2.6);
  EXPECT_GT(plan.at("time_to_goal").get<double>(), 6.0);
  EXPECT_LE(plan.at("time_to_goal").get<double>(), 10.0);
  EXPECT_FALSE(Plan("diagrams/first.yaml").contains("reference_length"));
  // The cube moves.
  EXPECT_TRUE(
      Plan("diagrams/scenarios/head_on.yaml --reference 0").at("reference_length").is_null());
}

TEST_F(PlanCommandTest, LeavesOutThePairsThatTheDistanceBlockIgnores) {
  const std::string file = TwoArms() +
                           "-s systems.right_spline.key_points.1.position=[2.5,0,0] "
                           "-s 'systems.left_spline.key_points.0.position=[-0.8,0,0]' "
                           "-s 'systems.left_plant.initial_position=[-0.8,0,0]' ";
  EXPECT_FALSE(Plan(file, 3).at("clear").get<bool>());  // within the post
  const json plan = Plan(
      file +
      "-s 'systems.distance.ignore=[[planar3_link_1,post/stand],[planar3_link_2,post/stand]]'");
  EXPECT_TRUE(plan.at("clear").get<bool>());
  EXPECT_EQ(plan.at("tries"), 0);
}

TEST_F(PlanCommandTest, SeesOwnLinksIfTheDistanceBlockDoes) {
  const std::string file =
      "diagrams/scenarios/two_arms_crossing.yaml -s parameters.avoidance=safety_filter ";
  const json plan = Plan(file);
  EXPECT_TRUE(plan.at("clear").get<bool>());
  EXPECT_GT(plan.at("tries").get<int>(), 0);
  EXPECT_THAT(plan.at("sees"), ElementsAre("obstacles", "own links"));
  EXPECT_EQ(Plan(file + "-s parameters.self_collision=false").at("tries"), 0);
}

TEST_F(PlanCommandTest, RefusesByNameWhatNobodyCanKnowBeforehand) {
  const auto refusal = [&](const std::string& arguments) {
    const Ran ran = run("$S plan " + arguments);
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.out, "");
    return ran.err;
  };
  EXPECT_THAT(refusal("diagrams/scenarios/fault_latency.yaml -s parameters.judge=distance"),
              HasSubstr("distance.obstacles: driver; got 'sensor', which depends on the run"));
  EXPECT_THAT(refusal("diagrams/attractive_goal.yaml"),
              HasSubstr("metrics.request: driver; got nothing"));
  EXPECT_THAT(refusal("diagrams/dual_arm.yaml"),
              HasSubstr("'left' by left.metrics, 'right' by right.metrics"));
  EXPECT_THAT(refusal("diagrams/dual_arm.yaml --model middle"),
              HasSubstr("judge; got none; expected one of the model 'middle'"));
  EXPECT_THAT(refusal(TwoArms() + "-t 0"), HasSubstr("duration; got 0 s"));
}

TEST_F(PlanCommandTest, ChoosesTheArmByName) {
  const json plan = Plan("diagrams/dual_arm.yaml --model right");
  EXPECT_TRUE(plan.at("clear").get<bool>());
  EXPECT_EQ(plan.at("model"), "right");
  EXPECT_EQ(plan.at("judge"), "right.metrics");
  EXPECT_THAT(plan.at("sees"), ElementsAre("obstacles", "left as requested by left.spline"));
}

TEST_F(PlanCommandTest, SaysInItsHelpWhatItPrintsAndHowItEnds) {
  const Ran ran = run("$S plan --help");
  EXPECT_EQ(ran.status, 0);
  for (const char* word : {"min_distance", "acceleration_judged", "final_error", "sees", "tries",
                           "reference_length", "Exit status", "3 if"}) {
    EXPECT_THAT(ran.out, HasSubstr(word));
  }
}

}  // namespace plan_command_test
}  // namespace oca::tools
