// SPDX-License-Identifier: BSD-3-Clause
// What programs in C++ lean on: models by package://, series of a run, and structs that can be
// filled member by member. -Wextra is an error here, so a member without a default fails the build.
#include <gmock/gmock.h>

#include "oca/diagrams/files/load_models.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/function.h"
#include "oca/models/error.h"
#include "oca/models/robot/attach_objects.h"
#include "oca/models/robot/urdf.h"
#include "oca/systems/signals/signals.h"
#include "tests/temporary_folder.h"

namespace oca {
namespace cpp_program_test {

using files::LoadModels;
using testing::ElementsAre;
using testing::HasSubstr;

/// What `load` throws; empty if nothing.
template <class F>
std::string Refusal(F load) {
  try {
    load();
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(LoadModelsTest, FindsRobotsByPackageAndPlacesThem) {
  const auto models = LoadModels({{"arm",
                                   {.urdf = "package://ur5e/ur5e.urdf",
                                    .srdf = "package://ur5e/ur5e.srdf",
                                    .base_pose = {.xyz = {1.0, 2.0, 3.0}}}},
                                  {"table", {.urdf = "package://table_frame/table_frame.urdf"}}});
  const auto arm = models.Get("arm");
  EXPECT_EQ(arm->num_positions(), 6);
  EXPECT_EQ(arm->X_WB().translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_FALSE(arm->disabled_pairs().empty());
  EXPECT_EQ(models.Get("table")->num_positions(), 0);
}

TEST(LoadModelsTest, AttachesObjectsAndSaysWhatIsToBeKnown) {
  std::vector<std::string> lines;
  const auto models = LoadModels(
      {{"arm",
        {.urdf = "package://ur5e/ur5e.urdf",
         .attached = {{.id = "ball",
                       .link = "ur5e_link_6",
                       .shape = {{.type = systems::ShapeType::kSphere, .radius = 0.05}}}}}}},
      [&](const std::string& line) { lines.push_back(line); });
  EXPECT_TRUE(models.Get("arm")->links()[models.Get("arm")->FindLink("ball")].attached);
  for (const std::string& line : lines) EXPECT_THAT(line, HasSubstr("models.arm: "));
}

TEST(LoadModelsTest, RefusesWhatNoFileCouldSay) {
  const files::ModelParams arm{.urdf = "package://ur5e/ur5e.urdf"};
  EXPECT_THROW(LoadModels({{"arm", arm}, {"arm", arm}}), ConfigError);
  EXPECT_THAT(Refusal([] {
                LoadModels({{"arm", {.urdf = "package://nowhere/a.urdf"}}});
              }),
              HasSubstr("nowhere"));
  EXPECT_THROW(LoadModels({{"arm", {.urdf = "missing.urdf"}}}), models::ModelError);
}

TEST(StructsTest, CanBeFilledMemberByMember) {
  const files::Override change{.value = "1"};
  const files::ExpectParams bound{.at_most = 1.0};
  const robot::LoadOptions options{.decompose_meshes = true};
  const robot::AttachedObject object{.id = "ball"};
  const systems::ObstacleBody body{.file = "a.stl"};
  const systems::Obstacle obstacle{.linear = {1.0, 0.0, 0.0}};
  const systems::ObstacleSet set{.obstacles = {obstacle}};
  const systems::Proximity pair{.distance = 1.0};
  const FunctionPorts ports{.output = {.length = 1}};
  const runs::RunOptions run{.duration = 1.0};
  EXPECT_EQ(change.path, "");
  EXPECT_FALSE(bound.at_least);
  EXPECT_EQ(options.srdf, "");
  EXPECT_TRUE(object.touches.empty());
  EXPECT_EQ(body.collider, nullptr);
  EXPECT_EQ(set.obstacles[0].body, nullptr);
  EXPECT_EQ(pair.link.text(), "");
  EXPECT_TRUE(ports.inputs.empty());
  EXPECT_TRUE(run.outputs.empty());
}

}  // namespace cpp_program_test
}  // namespace oca
