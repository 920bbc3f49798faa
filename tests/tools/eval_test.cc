// SPDX-License-Identifier: BSD-3-Clause
// One system from the shell: a JSON line of inputs in, a JSON line of outputs out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/program.h"

namespace oca::tools {
namespace eval_test {

using nlohmann::json;
using testing::HasSubstr;

class EvalTest : public testing::Test {
 protected:
  std::vector<json> Eval(const std::string& arguments, const std::string& lines) {
    const Ran ran = run("$S eval " + arguments, lines);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.err, "");
    std::vector<json> answers;
    std::istringstream stream(ran.out);
    for (std::string line; std::getline(stream, line);) answers.push_back(json::parse(line));
    return answers;
  }
  static std::string Proximity(double distance) {
    return R"({"link":"a","obstacle":"b","distance":)" + std::to_string(distance) +
           R"(,"point_on_link":[0,0,0],"point_on_obstacle":[0,0,-1],"normal":[0,0,1]})";
  }
  Program run;
};

TEST_F(EvalTest, ADiagramIsNoSystemToEvaluate) {
  const Ran ran = run("$S eval Diagram");
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("eval: type; got Diagram, which is a file"));
  EXPECT_EQ(ran.err.find("did you mean"), std::string::npos);
}

TEST_F(EvalTest, AnInputThatCannotBeReadIsNoEndOfIt) {
  for (const char* from : {"< /", "<&-"}) {
    const Ran ran =
        run("$S eval RepulsiveField --params '{\"force_gain\":1,\"max_distance\":0.3}' " +
            std::string(from));
    EXPECT_EQ(ran.status, 2) << from;
    EXPECT_THAT(ran.err, HasSubstr("standard input: cannot be read")) << from;
  }
}

TEST_F(EvalTest, RepulsiveFieldGivesTheGoldenForces) {
  const auto answers =
      Eval("RepulsiveField --params '{\"force_gain\":1,\"max_distance\":0.3}'",
           "{\"proximities\":[" + Proximity(0.2) + "," + Proximity(0.3) + "]}\n{\"proximities\":[" +
               Proximity(0.1) + "]}\n{\"proximities\":[" + Proximity(0.01) + "]}\n");
  ASSERT_EQ(answers.size(), 3u);
  EXPECT_NEAR(answers[0]["forces"][0]["force"][2].get<double>(), 41.6667, 1e-4);
  EXPECT_EQ(answers[0]["forces"][1]["force"][2].get<double>(), 0.0);
  EXPECT_NEAR(answers[1]["forces"][0]["force"][2].get<double>(), 666.667, 1e-3);
  EXPECT_NEAR(answers[2]["forces"][0]["force"][2].get<double>(), 966666.67, 1e-2);
}

TEST_F(EvalTest, EachLineIsAPeriodOfTheDeltaLimiter) {
  std::string lines = R"({"delta":[1,-1,0.003,-0.003,0.006,0.0061,0]})"
                      "\n";
  for (int i = 0; i < 3; ++i)
    lines += R"({"delta":[1,0,0,0,0,0,0]})"
             "\n";
  const auto answers =
      Eval("DeltaLimiter --params '{\"max_joint_velocity\":0.6,\"period\":0.01}'", lines);
  ASSERT_EQ(answers.size(), 4u);
  const std::vector<double> golden{0.006, -0.006, 0.003, -0.003, 0.006, 0.006, 0};
  for (std::size_t i = 0; i < golden.size(); ++i) {
    EXPECT_NEAR(answers[0]["limited_delta"][i].get<double>(), golden[i], 1e-15) << i;
  }
  EXPECT_NEAR(answers[3]["limited_delta"][0].get<double>(), 0.024, 1e-15);
  EXPECT_EQ(answers[3]["limited_delta"][1].get<double>(), 0.0);
}

TEST_F(EvalTest, EveryLineIsOneTickHoweverManyCameBefore) {
  for (const char* period : {"0.1", "0.01", "0.3", "0.016666666666666666"}) {
    std::string lines;
    for (int i = 0; i < 500; ++i) lines += "{\"in\":[" + std::to_string(i) + "]}\n";
    const auto answers =
        Eval("ZeroOrderHold --params '{\"period\":" + std::string(period) + "}'", lines);
    ASSERT_EQ(answers.size(), 500u);
    for (int i = 0; i < 500; ++i) ASSERT_EQ(answers[i]["out"][0], i) << period;
  }
}

TEST_F(EvalTest, TheTicksMayBeGivenAsTimesAndBeAddedUp) {
  std::string exact, summed;
  double sum = 0.0;
  for (int i = 0; i < 200; ++i) {
    exact += json{{"time", i / 10.0}, {"delta", {99}}}.dump() + "\n";
    summed += json{{"time", sum}, {"delta", {99}}}.dump() + "\n";
    sum += 0.1;
  }
  for (const std::string& lines : {exact, summed}) {
    const auto answers =
        Eval("DeltaLimiter --params '{\"max_joint_velocity\":1,\"period\":0.1}'", lines);
    ASSERT_EQ(answers.size(), 200u);
    for (int i = 0; i < 200; ++i) {
      ASSERT_NEAR(answers[i]["limited_delta"][0].get<double>(), 0.1 * (i + 1), 1e-12);
    }
  }
}

TEST_F(EvalTest, ALineThatIsRefusedIsNoTick) {
  const auto answers =
      Eval("DeltaLimiter --params '{\"max_joint_velocity\":1,\"period\":0.1}'",
           "{\"delta\":[9]}\n{\"time\":0.05,\"delta\":[9]}\n{\"delta\":[1,2]}\n"
           "{\"time\":0.55,\"delta\":[9]}\n{\"delta\":[9]}\n{\"time\":1e15,\"delta\":[9]}\n");
  ASSERT_EQ(answers.size(), 6u);
  EXPECT_THAT(answers[5]["error"].get<std::string>(), HasSubstr("1e7 periods on"));
  EXPECT_NEAR(answers[0]["limited_delta"][0].get<double>(), 0.1, 1e-15);
  EXPECT_TRUE(answers[1].contains("error"));  // the first line ended at 0.1 s
  EXPECT_TRUE(answers[2].contains("error"));
  // The ticks at 0.1 to 0.5 s, then one a line.
  EXPECT_NEAR(answers[3]["limited_delta"][0].get<double>(), 0.7, 1e-12);
  EXPECT_NEAR(answers[4]["limited_delta"][0].get<double>(), 0.8, 1e-12);
}

TEST_F(EvalTest, JointsFarBeyondTheirLimitsAreRefusedByName) {
  const auto answers = Eval(
      "RobotKinematics --model arm=models/robots/lwr4/lwr4.urdf --params '{\"model\":\"arm\"}'",
      "{\"position\":[0,0,1e6,0,0,0,0]}\n{\"position\":[0,0,3,0,0,0,0]}\n");
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_THAT(answers[0]["error"].get<std::string>(),
              HasSubstr("position: vector: joint 'lwr4_joint_3'; got 1e+06"));
  EXPECT_TRUE(answers[1].contains("links"));
}

TEST_F(EvalTest, ABadLineIsAnsweredAndTheNextServed) {
  const auto answers = Eval("DeltaLimiter --params '{\"max_joint_velocity\":1,\"period\":0.01}'",
                            "nonsense\n[]\n{\"dleta\":[1]}\n{}\n{\"delta\":[\"x\"]}\n"
                            "{\"delta\":[1,1]}\n{\"delta\":[1]}\n{\"delta\":[1e400,0]}\n"
                            "{\"delta\":[1,1]}\n");
  ASSERT_EQ(answers.size(), 9u);
  for (const int i : {0, 1, 2, 3, 4, 6, 7}) EXPECT_TRUE(answers[i].contains("error")) << i;
  EXPECT_THAT(answers[2]["error"].get<std::string>(), HasSubstr("did you mean 'delta'?"));
  EXPECT_THAT(answers[3]["error"].get<std::string>(), HasSubstr("input 'delta': missing"));
  EXPECT_NEAR(answers[5]["limited_delta"][0].get<double>(), 0.01, 1e-15);
  EXPECT_NEAR(answers[8]["limited_delta"][0].get<double>(), 0.02, 1e-15);
}

TEST_F(EvalTest, DeepAndLongLinesDoNotEndTheProgram) {
  const auto answers = Eval("Gain --params '{\"gain\":2}'",
                            "{\"in\":" + std::string(200000, '[') + std::string(200000, ']') +
                                "}\n" + std::string(1000000, 'x') + "\n\n{\"in\":[1,2]}");
  ASSERT_EQ(answers.size(), 3u);
  EXPECT_THAT(answers[0]["error"].get<std::string>(), HasSubstr("nested too deep"));
  EXPECT_TRUE(answers[1].contains("error"));
  EXPECT_EQ(answers[2]["out"][1].get<double>(), 4.0);
}

TEST_F(EvalTest, RobotKinematicsPutsTheFlangeOfTheLwr4WhereItIs) {
  const auto answers = Eval(
      "RobotKinematics --model arm=models/robots/lwr4/lwr4.urdf --params '{\"model\":\"arm\"}'",
      R"({"position":[0,0,0,0,0,0,0]})"
      "\n"
      R"({"position":[0,0]})"
      "\n");
  ASSERT_EQ(answers.size(), 2u);
  const json flange = answers[0]["links"].back();
  EXPECT_NEAR(flange["pose"]["xyz"][2].get<double>(), 1.1785, 1e-9);
  EXPECT_NEAR(flange["pose"]["xyz"][0].get<double>(), 0.0, 1e-12);
  EXPECT_TRUE(answers[1].contains("error"));
}

TEST_F(EvalTest, DistanceFieldWrenchAndMappingWorkOneByOne) {
  const std::string arm = " --model arm=package://lwr4/lwr4.urdf";
  const json links = Eval("RobotKinematics" + arm + " --params '{\"model\":\"arm\"}'",
                          R"({"position":[0,0,0,0,0,0,0]})"
                          "\n")[0]["links"];
  const json obstacle = {{"id", "ball"},
                         {"shape", {{"type", "sphere"}, {"radius", 0.1}}},
                         {"pose", {{"xyz", {0.3, 0.0, 1.0}}, {"rpy", {0, 0, 0}}}}};
  const json distance =
      Eval("BulletDistance" + arm + " --params '{\"model\":\"arm\",\"max_distance\":10}'",
           json{{"links", links}, {"obstacles", {obstacle}}}.dump() + "\n")[0];
  ASSERT_TRUE(distance.contains("proximities")) << distance;
  ASSERT_FALSE(distance["proximities"].empty());
  double nearest = 10.0;
  for (const json& proximity : distance["proximities"]) {
    EXPECT_EQ(proximity["obstacle"], "ball");
    EXPECT_NE(proximity["link"], links[0]["link"]);  // the base cannot move
    nearest = std::min(nearest, proximity["distance"].get<double>());
    EXPECT_LE(proximity["normal"][0].get<double>(), 0.0);  // from the ball to the arm at x = 0
  }
  EXPECT_GT(nearest, 0.1);   // 0.3 to the axis, less the ball and a housing of at most 0.1
  EXPECT_LT(nearest, 0.16);  // and of at least 0.04
  const json force = {{"link", "lwr4_link_4"},
                      {"obstacle", "ball"},
                      {"force", {-1, 0, 0}},
                      {"point", {0.0, 0.0, 0.9}}};
  const json wrench =
      Eval("WrenchTransform", json{{"forces", {force}}, {"links", links}}.dump() + "\n")[0];
  ASSERT_TRUE(wrench.contains("wrenches")) << wrench;
  const json mapped =
      Eval("JacobianMapping" + arm + " --params '{\"model\":\"arm\",\"method\":\"transpose\"}'",
           json{{"wrenches", wrench["wrenches"]}, {"links", links}}.dump() + "\n")[0];
  // J_p^T F of a point at z 0.9: joint 2 turns about y at z 0.3105, joint 4 about -y at 0.7105.
  EXPECT_NEAR(mapped["delta"][0].get<double>(), 0.0, 1e-12);
  EXPECT_NEAR(mapped["delta"][1].get<double>(), -(0.9 - 0.3105), 1e-9);
  EXPECT_NEAR(mapped["delta"][3].get<double>(), 0.9 - 0.7105, 1e-9);
  EXPECT_NEAR(mapped["delta"][5].get<double>(), 0.0, 1e-12);
}

TEST_F(EvalTest, ALineMaySayWhen) {
  const std::string spline =
      "SplineGenerator --params '{\"kind\":\"cubic\",\"key_points\":[{\"time\":0,\"position\":[0]},"
      "{\"time\":1,\"position\":[1]}]}'";
  const auto answers = Eval(spline,
                            "{\"time\":0}\n{\"time\":0.5}\n{\"time\":2}\n{\"time\":0.25}\n"
                            "{\"time\":\"noon\"}\n");
  ASSERT_EQ(answers.size(), 5u);
  EXPECT_EQ(answers[0]["position"][0].get<double>(), 0.0);
  EXPECT_NEAR(answers[1]["position"][0].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(answers[1]["velocity"][0].get<double>(), 1.5, 1e-12);
  EXPECT_NEAR(answers[2]["position"][0].get<double>(), 1.0, 1e-12);
  EXPECT_NEAR(answers[3]["position"][0].get<double>(), 0.15625, 1e-12);  // 3 t^2 - 2 t^3
  EXPECT_TRUE(answers[4].contains("error"));
}

TEST_F(EvalTest, WrongParametersAndModelsEndWithTwo) {
  for (const char* arguments :
       {"Gain", "Gain --params '{'", "Gain --params '{\"gian\":1}'", "Gian",
        "RepulsiveField --params '{\"force_gain\":-1}'", "Gain --params '[1]'",
        "RobotKinematics --params '{\"model\":\"arm\"}'",
        "RobotKinematics --model arm=missing.urdf --params '{\"model\":\"arm\"}'",
        "RobotKinematics --model nonsense --params '{\"model\":\"arm\"}'",
        "RobotKinematics --model arm=package://planar2/planar2.urdf --argument arm.n=1",
        "RobotKinematics --model arm=package://planar2/planar2.urdf --argument leg.n=1",
        "RobotKinematics --model arm=package://planar2/planar2.urdf --argument n=1"}) {
    const Ran ran = run(std::string("$S eval ") + arguments, "{}\n");
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_EQ(ran.out, "") << arguments;
    EXPECT_THAT(ran.err, testing::Not(HasSubstr(": :"))) << arguments;
  }
}

TEST_F(EvalTest, AZeroByteInANameEndsNoMessage) {
  const auto answers = Eval("Gain --params '{\"gain\":2}'", "{\"a\\u0000b\":[1]}\n");
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_THAT(answers[0]["error"].get<std::string>(), HasSubstr("no input port 'a\\x00b'"));
}

TEST_F(EvalTest, TakesRobotsInXacroWithTheirArguments) {
  const std::string arm = run.folder()
                              .Write("arm.xacro", R"(<robot name="arm" xmlns:xacro="x">
<xacro:arg name="length" default="1"/><link name="base"/>
<link name="tip"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<joint name="turn" type="continuous"><parent link="base"/><child link="tip"/>
<origin xyz="$(arg length) 0 0"/><axis xyz="0 0 1"/><limit effort="1" velocity="1"/></joint></robot>)")
                              .string();
  const auto answers = Eval("RobotKinematics --model arm=" + arm +
                                " --argument arm.length=0.25 --params '{\"model\":\"arm\"}'",
                            "{\"position\":[0]}\n");
  ASSERT_EQ(answers.size(), 1u);
  EXPECT_THAT(answers[0].dump(), HasSubstr("0.25"));
}

TEST_F(EvalTest, TakesAnEntryOfModelsAsJson) {
  const auto answers = Eval(
      "RobotKinematics --model 'arm={\"urdf\": \"package://planar2/planar2.urdf\", \"held\": "
      "{\"planar2_joint_2\": 0}, \"base_pose\": {\"xyz\": [0, 0, 0.25]}}' --params '{}'",
      "{\"position\":[0]}\n{\"position\":[0,0]}\n");
  ASSERT_EQ(answers.size(), 2u);
  EXPECT_THAT(answers[0].dump(), HasSubstr("[0.9,0.0,0.25]"));  // the tip, 0.5 m and 0.4 m away
  EXPECT_THAT(answers[1].dump(), HasSubstr("error"));
  const Ran ran =
      run("$S eval RobotKinematics --model 'arm={\"urdf\": \"package://planar2/"
          "planar2.urdf\", \"hold\": {}}'");
  EXPECT_EQ(ran.status, 2);
  EXPECT_THAT(ran.err, HasSubstr("--model arm.hold: unknown key; did you mean 'held'?"));
}

}  // namespace eval_test
}  // namespace oca::tools
