// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/position_unit.h"

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"

namespace oca::runs {
namespace position_unit_test {

/// Of a diagram with robots `slider` and `turner`, and MotionMetrics that judge what is listed.
std::string UnitWhere(const std::vector<std::string>& judged) {
  const test::TemporaryFolder folder;
  for (const std::string type : {"prismatic", "revolute"}) {
    folder.Write(type + ".urdf", "<robot name='" + type +
                                     "'><link name='a'/><link name='b'/><joint name='j' type='" +
                                     type +
                                     "'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/>"
                                     "<limit lower='0' upper='1' velocity='1' effort='1'/></joint>"
                                     "</robot>");
  }
  std::string text =
      "models: {slider: {urdf: prismatic.urdf}, turner: {urdf: revolute.urdf}}\n"
      "systems:\n"
      "  one: {type: Constant, value: [0]}\n";
  std::string connections = "connections:\n";
  for (const std::string& model : judged) {
    text += "  m_" + model + ": {type: MotionMetrics, period: 0.01" +
            (model.empty() ? "" : ", model: " + model) + "}\n";
    connections += "  - one.value -> m_" + model + ".position\n";
  }
  return PositionUnit(loading::LoadDiagram(folder.Write("d.yaml", text + connections)));
}

TEST(PositionUnitTest, IsThatOfTheRobotsThatAreJudged) {
  EXPECT_EQ(UnitWhere({"slider"}), "m");
  EXPECT_EQ(UnitWhere({"turner"}), "rad");
  EXPECT_EQ(UnitWhere({"slider", "turner"}), "rad or m");
}

TEST(PositionUnitTest, IsThatOfAllWhereAJudgeNamesNone) {
  EXPECT_EQ(UnitWhere({""}), "rad or m");
  EXPECT_EQ(UnitWhere({"slider", ""}), "rad or m");
}

TEST(PositionUnitTest, HasAPowerOfTimeBelowEachOfTwo) {
  EXPECT_EQ(UnitOverTime("m", "s"), "m/s");
  EXPECT_EQ(UnitOverTime("rad or m", "s^2"), "rad/s^2 or m/s^2");
}

}  // namespace position_unit_test
}  // namespace oca::runs
