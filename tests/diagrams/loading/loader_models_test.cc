// SPDX-License-Identifier: BSD-3-Clause
// Models of a file, the files that they are read from, and what is attached to them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>

#include "oca/models/robot/robot_model.h"
#include "tests/diagrams/loading/chain_file.h"

namespace oca::loading {
namespace loader_models_test {

using chain_file::Chain;
using chain_file::kArm;
using testing::AllOf;
using testing::HasSubstr;

class LoaderModelsTest : public chain_file::ChainFile {};

TEST_F(LoaderModelsTest, ModelsThatDoNotExistAreRefused) {
  const std::string kinematics = "systems: {k: {type: RobotKinematics, model: amr}}\n";
  EXPECT_THAT(Refusal(kArm + kinematics),
              AllOf(HasSubstr("d.yaml:2:"), HasSubstr("systems.k"), HasSubstr("amr"),
                    HasSubstr("did you mean 'arm'?")));
  EXPECT_THAT(Refusal("models: {arm: {urdf: missing.urdf}}\n" + kinematics),
              AllOf(HasSubstr("d.yaml:1:22: error: models.arm: "), HasSubstr("missing.urdf")));
  EXPECT_THAT(Refusal("models: {arm: {srdf: x}}\n" + kinematics),
              HasSubstr("models.arm: got neither urdf nor xacro; expected one of"));
  EXPECT_THAT(Refusal("models: {arm: {urdf: ''}}\n" + kinematics), HasSubstr("models.arm"));
  EXPECT_THAT(Refusal("models: {arm: {urdf: package://none/a.urdf}}\n" + kinematics),
              HasSubstr("no package 'none'; looked in packages"));
}

TEST_F(LoaderModelsTest, AModelThatFailsIsReportedOnce) {
  const std::string refusal = Refusal(
      "models: {arm: {urdf: missing.urdf}}\n"
      "systems: {k: {type: RobotKinematics, model: arm}, s: {type: Constant, value: 1}}\n"
      "connections: [s.value -> k.position]\n");
  EXPECT_EQ(std::count(refusal.begin(), refusal.end(), '\n'), 0) << refusal;
}

TEST_F(LoaderModelsTest, BasePosesThatAreNoneAreRefused) {
  const auto with = [&](const std::string& pose) {
    return Refusal("models: {arm: {urdf: package://planar2/planar2.urdf, base_pose: " + pose +
                   "}}\n" + Chain());
  };
  EXPECT_EQ(with("{xyz: [0, 0, 1], rpy: [0, 0, 0]}"), "");
  EXPECT_THAT(with("{xyz: [0, 0]}"), HasSubstr("models.arm.base_pose.xyz"));
  EXPECT_THAT(with("{xyz: [0, 0, a]}"), HasSubstr("models.arm.base_pose.xyz[2]"));
  EXPECT_THAT(with("{xyz: [0, 0, .nan]}"), HasSubstr("models.arm.base_pose.xyz[2]: got '.nan'"));
  EXPECT_THAT(with("{xyz: [0, -1000001, 0]}"), HasSubstr("models.arm.base_pose.xyz"));
  EXPECT_THAT(with("{xyz: [0, 0, 0], rpy: [1e300, 0, 0]}"), HasSubstr("models.arm.base_pose.rpy"));
  EXPECT_THAT(with("{quaternion: [0, 0, 0, 0]}"), HasSubstr("models.arm"));
  EXPECT_THAT(with("{zyx: [0, 0, 0]}"), HasSubstr("did you mean 'xyz'?"));
}

class PackageTest : public chain_file::ChainFile {
 protected:
  void SetUp() override {
    for (const char* place : {"own", "path/lwr4", "second/lwr4"}) {
      folder.Write(std::string(place) + "/lwr4.urdf",
                   "<robot name='" + std::string(place) + "'><link name='base'/></robot>");
    }
  }
  void TearDown() override { unsetenv("OCA_PACKAGE_PATH"); }
  std::string NameOfModel(const std::string& packages) {
    const LoadedDiagram loaded =
        Load(packages + "models: {arm: {urdf: package://lwr4/lwr4.urdf}}\n" + Chain());
    return loaded.models.Get("arm")->name().text();
  }
};

TEST_F(PackageTest, TheFileThenTheEnvironmentThenTheModelsOfOca) {
  EXPECT_EQ(NameOfModel(""), "lwr4");
  const std::string path = (folder.path() / "none").string() + ":" +
                           (folder.path() / "path").string() + ":" +
                           (folder.path() / "second").string();
  setenv("OCA_PACKAGE_PATH", path.c_str(), 1);
  EXPECT_EQ(NameOfModel(""), "path/lwr4");
  EXPECT_EQ(NameOfModel("packages: {lwr4: own}\n"), "own");
  EXPECT_EQ(NameOfModel("packages: {other: own}\n"), "path/lwr4");
}

TEST_F(PackageTest, FoldersThatAreNoTextAreRefused) {
  EXPECT_THAT(Refusal("packages: {lwr4: 3}\n" + Chain()),
              HasSubstr("packages.lwr4: got 3; expected a folder"));
}

TEST_F(LoaderModelsTest, WhatTheRobotMakesWrongIsToldWhereItIsSaid) {
  EXPECT_THAT(
      Refusal("models: {arm: {urdf: package://planar2/planar2.urdf, acceleration_limits: [1, 2, "
              "3]}}\n" +
              Chain()),
      testing::AllOf(HasSubstr("d.yaml:1:75: error: models.arm: "),
                     HasSubstr("planar2.urdf: acceleration_limits: got 3 numbers; expected 1 or "
                               "2")));
}

TEST_F(LoaderModelsTest, FilesAreFoundBesideTheFileThatNamesThem) {
  folder.Write("parts/box.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  folder.Write("parts/part.yaml",
               "systems:\n  obstacles:\n    type: ObstacleSource\n    obstacles: [{id: a, pose: "
               "{xyz: [0, 0, 0]}, shape: {type: "
               "mesh, file: box.obj}}]\n");
  EXPECT_EQ(Refusal("include: [parts/part.yaml]\n"), "");
  folder.Write("parts/part.yaml",
               "systems:\n  obstacles:\n    type: ObstacleSource\n    obstacles: [{id: a, pose: "
               "{xyz: [0, 0, 0]}, shape: {type: "
               "mesh, file: parts/box.obj}}]\n");
  EXPECT_THAT(Refusal("include: [parts/part.yaml]\n"), HasSubstr("parts/parts/box.obj"));
}

TEST_F(LoaderModelsTest, AnAttachedObjectBecomesALinkThatMovesWithItsCarrier) {
  const LoadedDiagram loaded = Load(
      "models:\n"
      "  arm:\n"
      "    urdf: package://planar2/planar2.urdf\n"
      "    attached:\n"
      "      - {id: cup, link: planar2_tip, shape: {type: sphere, radius: 0.05},\n"
      "         pose: {xyz: [0.1, 0, 0]}}\n" +
      Chain());
  const auto arm = loaded.models.Get("arm");
  EXPECT_EQ(arm->num_positions(), 2);
  const robot::Link& cup = arm->links()[arm->FindLink("cup")];
  EXPECT_EQ(cup.collisions.size(), 1u);
  const robot::Joint& joint = arm->joints()[cup.parent_joint];
  EXPECT_EQ(joint.parent_link, arm->FindLink("planar2_tip"));
  EXPECT_EQ(joint.X_PJ.translation(), Eigen::Vector3d(0.1, 0.0, 0.0));
}

TEST_F(LoaderModelsTest, AttachedObjectsThatCannotBeAreRefused) {
  const auto with = [&](const std::string& object) {
    return Refusal("models: {arm: {urdf: package://planar2/planar2.urdf, attached: [" + object +
                   "]}}\n" + Chain());
  };
  const std::string ball = "shape: {type: sphere, radius: 0.05}";
  EXPECT_EQ(with("{id: cup, link: planar2_tip, " + ball + "}"), "");
  EXPECT_THAT(with("{id: cup, link: planar2_tpi, " + ball + "}"),
              AllOf(HasSubstr("models.arm"), HasSubstr("nearest is 'planar2_tip'")));
  EXPECT_THAT(with("{id: planar2_tip, link: planar2_tip, " + ball + "}"), HasSubstr("taken"));
  EXPECT_THAT(with("{id: cup, " + ball + "}"), HasSubstr("models.arm.attached[0].link"));
  EXPECT_THAT(with("{id: cup, link: planar2_tip, shape: {type: sphere, radius: 0}}"),
              HasSubstr("models.arm.attached[0].shape.radius"));
  EXPECT_THAT(with("{id: cup, link: planar2_tip, shape: {type: box}}"),
              HasSubstr("models.arm.attached[0].shape.size"));
  EXPECT_THAT(with("{id: cup, link: planar2_tip, shape: {type: half_space}}"),
              HasSubstr("models.arm.attached[0].shape.type: got a half_space"));
  EXPECT_THAT(with("{id: cup, link: planar2_tip, touchs: [], " + ball + "}"),
              HasSubstr("did you mean 'touches'?"));
}

}  // namespace loader_models_test
}  // namespace oca::loading
