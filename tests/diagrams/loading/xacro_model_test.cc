// SPDX-License-Identifier: BSD-3-Clause
// `models.NAME.xacro` of diagram files.
#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "oca/diagrams/loading/blueprint.h"
#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/robot_model.h"
#include "tests/temporary_folder.h"

namespace oca::loading {
namespace xacro_model_test {

using files::Override;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

const std::string kArms = OCA_SOURCE_DIR "/tests/models/robot/xacro_arms";

struct Arm {
  const char* name;
  const char* package;
  const char* model;     // of models.arm
  const char* position;  // within its limits
};

class XacroArm : public testing::TestWithParam<Arm> {};
INSTANTIATE_TEST_SUITE_P(
    XacroModelTest, XacroArm,
    testing::Values(
        Arm{"cobot", "cobot_description",
            "{xacro: package://cobot_description/urdf/cobot.urdf.xacro, arguments: {type: c5}}",
            "[0, 0.5, 0.8, 0.3, 0, 0]"},
        Arm{"seven", "seven_description",
            "{xacro: package://seven_description/robots/s7/s7.urdf.xacro}",
            "[0, -0.5, 0, -2, 0, 1.6, 0]"},
        Arm{"xseries", "xseries_description",
            "{xacro: package://xseries_description/urdf/device.urdf.xacro, arguments: {dof: 5, "
            "limited: true}}",
            "[0, 0.5, 0.8, 0, 0.3]"},
        Arm{"gen", "gen_description",
            "{xacro: package://gen_description/robots/gen.urdf.xacro, arguments: {vision: true, "
            "gripper: ''}}",
            "[0, 0.5, 0.8, 0, 0.3, 0]"}),
    [](const auto& tested) { return std::string(tested.param.name); });

std::string DiagramOf(const Arm& arm) {
  const std::string position = arm.position;
  return "name: xacro_arm\n"
         "include: [" OCA_SOURCE_DIR
         "/diagrams/parts/avoidance.yaml]\n"
         "parameters: {relaxation_time: 0.4, max_distance: 0.2}\n"
         "simulator: {duration: 1, seed: 1}\n"
         "packages: {" +
         std::string(arm.package) + ": " + kArms + "/" + arm.package +
         "}\n"
         "models: {arm: " +
         arm.model +
         "}\n"
         "systems:\n"
         "  obstacles: {type: ObstacleSource, obstacles: [{id: box, shape: {type: box, size: [0.2, "
         "0.2, 0.2]}, pose: {xyz: [0.6, 0.6, 0.4]}}]}\n"
         "  spline: {type: SplineGenerator, period: \"${1 / rate}\", key_points: [{time: 0.1, "
         "position: " +
         position + "}, {time: 1, position: " + position +
         "}]}\n"
         "  plant: {initial_position: " +
         position + "}\n";
}

TEST_P(XacroArm, RunsInADiagram) {
  const oca::test::TemporaryFolder folder;
  const LoadedDiagram loaded = LoadDiagram(folder.Write("arm.yaml", DiagramOf(GetParam())));
  const runs::RunResult result = runs::Run(loaded, {.duration = 0.5});
  EXPECT_FALSE(result.failure.has_value());
}

class XacroModelTest : public testing::Test {
 protected:
  /// A robot of `n` prismatic joints of length `length`, in two files.
  void SetUp() override {
    folder.Write("joint.xacro",
                 "<robot xmlns:xacro='x'><xacro:macro name='joint' params='i'>\n"
                 "<link name='l${i}'/><joint name='j${i}' type='prismatic'>\n"
                 "<parent link='l${i - 1}'/><child link='l${i}'/><axis xyz='1 0 0'/>\n"
                 "<limit lower='0' upper='$(arg length)' effort='1' velocity='1'/></joint>\n"
                 "<xacro:if value='${i &lt; $(arg n)}'><xacro:joint i='${i + 1}'/></xacro:if>\n"
                 "</xacro:macro></robot>\n");
    folder.Write("arm.urdf.xacro",
                 "<robot name='$(arg file)' xmlns:xacro='x'><xacro:arg name='n' default='1'/>\n"
                 "<xacro:arg name='file' default='arm'/><xacro:arg name='length' default='1'/>\n"
                 "<xacro:include filename='joint.xacro'/>\n"
                 "<link name='l0'/><xacro:joint i='1'/></robot>\n");
  }
  std::string Write(const std::string& model) {
    return folder
        .Write("d.yaml", "parameters: {joints: 2}\nmodels: {arm: " + model +
                             "}\nsystems: {k: {type: RobotKinematics, model: arm}}\n"
                             "connections: [inputs.q -> k.position]\n")
        .string();
  }
  std::string Refusal(const std::string& model) {
    try {
      LoadDiagram(Write(model));
      return "";
    } catch (const ConfigError& error) {
      return error.what();
    }
  }
  static int Joints(const LoadedDiagram& loaded) {
    return loaded.models.Get("arm")->num_positions();
  }

  const oca::test::TemporaryFolder folder;
};

TEST_F(XacroModelTest, TakesArgumentsFromTheFileItsParametersAndOverrides) {
  const std::string file = Write("{xacro: arm.urdf.xacro, arguments: {n: \"${joints}\"}}");
  EXPECT_EQ(Joints(LoadDiagram(file)), 2);
  EXPECT_EQ(Joints(LoadDiagram(file, {{"parameters.joints", "3"}})), 3);
  EXPECT_EQ(Joints(LoadDiagram(file, {{"models.arm.arguments.n", "4"}})), 4);
  const LoadedDiagram longer = LoadDiagram(
      file, {{"models.arm.arguments.length", "2.5"}, {"models.arm.arguments.file", "b"}});
  EXPECT_DOUBLE_EQ(longer.models.Get("arm")->upper_limits()[0], 2.5);
  EXPECT_EQ(longer.models.Get("arm")->name().text(), "b");
}

TEST_F(XacroModelTest, ABlueprintTellsArgumentsApartAndNotesAllFiles) {
  Blueprint blueprint(Write("{xacro: arm.urdf.xacro, arguments: {n: 1}}"));
  for (int round = 0; round < 2; ++round) {
    for (int n = 1; n <= 3; ++n) {
      const LoadedDiagram built = blueprint.Build({{"models.arm.arguments.n", std::to_string(n)}});
      EXPECT_EQ(Joints(built), n);
      EXPECT_THAT(built.opened, AllOf(Contains(folder.path() / "arm.urdf.xacro"),
                                      Contains(folder.path() / "joint.xacro")));
    }
  }
}

TEST_F(XacroModelTest, RefusesWhatIsNotOneDescription) {
  EXPECT_THAT(Refusal("{xacro: arm.urdf.xacro, urdf: a.urdf}"),
              HasSubstr("d.yaml:2:45: error: models.arm: got both urdf and xacro; expected one"));
  EXPECT_THAT(Refusal("{arguments: {n: 1}}"), HasSubstr("got neither urdf nor xacro"));
  EXPECT_THAT(Refusal("{urdf: arm.urdf.xacro}"),
              HasSubstr("models.arm: urdf: got 'arm.urdf.xacro'; expected a URDF (key xacro"));
  EXPECT_THAT(Refusal("{xacro: arm.urdf}"), HasSubstr("models.arm: xacro: got 'arm.urdf'"));
  EXPECT_THAT(Refusal("{urdf: a.urdf, arguments: {n: 1}}"),
              HasSubstr("models.arm: arguments: got 'n'; expected none"));
  EXPECT_THAT(Refusal("{xacro: arm.urdf.xacro, arguments: [1]}"),
              HasSubstr("models.arm.arguments: got a list; expected a map of arguments"));
  EXPECT_THAT(Refusal("{xacro: arm.urdf.xacro, arguments: {n: [1]}}"),
              HasSubstr("models.arm.arguments.n: got a list; expected a text, number or boolean"));
  EXPECT_THAT(Refusal("{xacro: arm.urdf.xacro, arguments: {m: 1}}"),
              AllOf(HasSubstr("d.yaml:2:23: error: models.arm: "),
                    HasSubstr("unknown argument; got 'm'; expected one of the file such as 'n'")));
  EXPECT_THAT(Refusal("{xacro: arm.urdf.xacro, arguments: {length: -1}}"),
              AllOf(HasSubstr("joint.xacro:4 (called at "), HasSubstr("arm.urdf.xacro:4)"),
                    HasSubstr("joint 'j1' <limit>: range")));
}

TEST_F(XacroModelTest, FilesThatOthersUseHaveThemToo) {
  folder.Write("inner.yaml",
               "models: {arm: {xacro: arm.urdf.xacro, arguments: {n: 2}}}\n"
               "systems: {k: {type: RobotKinematics, model: arm}, c: {type: Constant, value: [0, "
               "0]}}\nconnections: [c.value -> k.position]\n");
  const std::string outer =
      folder
          .Write("outer.yaml",
                 "models: {given: {xacro: arm.urdf.xacro, arguments: {n: 2, length: 3}}}\n"
                 "systems: {own: {type: Diagram, file: inner.yaml}, other: {type: Diagram, file: "
                 "inner.yaml, models: {arm: given}}}\n")
          .string();
  const LoadedDiagram loaded = LoadDiagram(outer);
  EXPECT_EQ(loaded.diagram->systems().size(), 4u);
}

}  // namespace xacro_model_test
}  // namespace oca::loading
