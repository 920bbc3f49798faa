// SPDX-License-Identifier: BSD-3-Clause
// Descriptions of robots, and of scenes that they stand in.
#include "oca/models/robot/joint_limits_file.h"
#include "oca/models/robot/srdf.h"
#include "oca/models/robot/urdf.h"
#include "oca/models/robot/xacro.h"
#include "oca/models/scenes/motion_request.h"
#include "oca/models/scenes/planning_scene.h"
#include "tests/fuzz/foreign_bytes.h"

namespace oca::test {
namespace {

bool ReadUrdf(std::string_view bytes) {
  return Accepts([&] { robot::ParseUrdf(std::string(bytes), "fuzz.urdf"); });
}

bool ReadXacro(std::string_view bytes) {
  return Accepts([&] { robot::ExpandXacro(FileOf("fuzz.xacro", bytes)); });
}

/// What xacro.load_yaml reads.
bool ReadXacroYaml(std::string_view bytes) {
  return Accepts([&] {
    FileOf("fuzz_values.yaml", bytes);
    robot::ExpandXacro(
        FileOf("reader.xacro", "<robot name=\"${xacro.load_yaml('fuzz_values.yaml')}\"/>"));
  });
}

bool ReadSrdf(std::string_view bytes) {
  static const robot::SrdfRobot robot{
      "planar2",
      {"planar2_base_link", "planar2_link_1", "planar2_link_2", "planar2_tip"},
      {"planar2_joint_1", "planar2_joint_2", "planar2_tip_joint"}};
  return Accepts([&] {
    const auto file = FileOf("fuzz.srdf", bytes);
    robot::LoadSrdf(file, robot);
    robot::SaveDisabledPairs(file, "planar2", {{"planar2_link_1", "planar2_link_2", "Never"}});
  });
}

bool ReadJointLimits(std::string_view bytes) {
  return Accepts([&] { robot::JointLimitsFile limits(FileOf("fuzz_limits.yaml", bytes)); });
}

bool ReadPlanningScene(std::string_view bytes) {
  return Accepts([&] { scenes::ReadPlanningScene(FileOf("fuzz_scene.yaml", bytes)); });
}

bool ReadSceneText(std::string_view bytes) {
  return Accepts([&] { scenes::ReadPlanningScene(FileOf("fuzz.scene", bytes)); });
}

bool ReadMotionRequest(std::string_view bytes) {
  return Accepts([&] { scenes::ReadMotionRequest(FileOf("fuzz_request.yaml", bytes)); });
}

}  // namespace

std::vector<Reader> RobotReaders() {
  using enum Reader::Kind;
  return {{"joint_limits", kText, ReadJointLimits},
          {"motion_request", kText, ReadMotionRequest},
          {"planning_scene", kText, ReadPlanningScene},
          {"scene_text", kText, ReadSceneText},
          {"srdf", kText, ReadSrdf},
          {"urdf", kText, ReadUrdf},
          {"xacro", kText, ReadXacro},
          {"xacro_yaml", kText, ReadXacroYaml}};
}

}  // namespace oca::test
