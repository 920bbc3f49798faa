// SPDX-License-Identifier: BSD-3-Clause
// A mesh that counts as its convex hull says so where the user looks: at the diagram file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "oca/diagrams/loading/loader.h"
#include "tests/models/geometry/mesh_files.h"
#include "tests/temporary_folder.h"

namespace oca::loading {
namespace hull_warning_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

class HullWarningTest : public testing::Test {
 protected:
  HullWarningTest() {
    EXPECT_EQ(::setenv("XDG_CACHE_HOME", (folder.path() / "cache").c_str(), 1), 0);
    folder.Write("angle.obj", geometry::AngleObj());
    folder.Write("pyramid.obj", geometry::TextObj());
  }
  LoadedDiagram Load(const std::string& text) { return LoadDiagram(folder.Write("d.yaml", text)); }
  std::vector<std::string> WarningsOfRobot(const std::string& mesh, const std::string& more = "") {
    folder.Write("arm.urdf",
                 "<robot name=\"arm\"><link name=\"elbow\"><collision><geometry><mesh "
                 "filename=\"" +
                     mesh + "\"/></geometry></collision></link></robot>");
    return Load("models: {arm: {urdf: arm.urdf" + more +
                "}}\nsystems: {one: {type: Constant, value: 1}}\n")
        .warnings;
  }
  LoadedDiagram WithObstacle(const std::string& shape) {
    return Load("systems:\n  world: {type: ObstacleSource, obstacles: [{id: part, shape: " + shape +
                ", pose: {}}]}\n");
  }
  test::TemporaryFolder folder;
};

TEST_F(HullWarningTest, NamesLinkFileAndVolumeOfARobotsMesh) {
  EXPECT_THAT(
      WarningsOfRobot("angle.obj"),
      ElementsAre(AllOf(HasSubstr("d.yaml:1:22: warning: models.arm: link 'elbow': collision "
                                  "mesh 'angle.obj' counts as its convex hull, which adds "
                                  "0.5 m^3 (16.7 %)"),
                        EndsWith("collision: decomposition splits it"))));
}

TEST_F(HullWarningTest, IsOneLineHoweverManyMeshesWhichNamesTheirLinks) {
  std::string arm = "<robot name='arm'>", before;
  const auto mesh = [](const char* file) {
    return std::string("<collision><geometry><mesh filename='") + file +
           "'/></geometry></collision>";
  };
  for (const char* link : {"a", "b", "c", "d"}) {
    const bool twice = link == std::string("b"), convex = link == std::string("c");
    arm += std::string("<link name='") + link + "'>" + mesh(convex ? "pyramid.obj" : "angle.obj") +
           (twice ? mesh("angle.obj") : "") + "</link>";
    if (!before.empty()) {
      arm += std::string("<joint name='to_") + link + "' type='fixed'><parent link='" + before +
             "'/><child link='" + link + "'/></joint>";
    }
    before = link;
  }
  folder.Write("arm.urdf", arm + "</robot>");
  EXPECT_THAT(Load("models: {arm: {urdf: arm.urdf}}\nsystems: {one: {type: Constant, value: 1}}\n")
                  .warnings,
              ElementsAre(AllOf(HasSubstr("models.arm: link 'a': collision mesh 'angle.obj'"),
                                EndsWith("splits it; and 3 more, of links 'b', 'd'"))));
}

TEST_F(HullWarningTest, IsSilentForConvexMeshesAndDecompositions) {
  EXPECT_THAT(WarningsOfRobot("pyramid.obj"), IsEmpty());
  EXPECT_THAT(WarningsOfRobot("angle.obj", ", collision: decomposition"), IsEmpty());
  EXPECT_THAT(WithObstacle("{type: mesh, file: pyramid.obj}").warnings, IsEmpty());
}

TEST_F(HullWarningTest, SaysThatTheVolumeOfAnOpenMeshIsNotKnown) {
  std::string open = geometry::AngleObj();
  open.erase(open.rfind("f "));
  folder.Write("open.obj", open);
  EXPECT_THAT(WarningsOfRobot("open.obj"), ElementsAre(HasSubstr("not closed")));
}

TEST_F(HullWarningTest, NamesObstacleFileAndVolume) {
  EXPECT_THAT(
      WithObstacle("{type: mesh, file: angle.obj}").warnings,
      ElementsAre(AllOf(HasSubstr("d.yaml:2:3: warning: systems.world: obstacle 'part'"),
                        HasSubstr("angle.obj' counts as its convex hull, which adds 0.5"))));
}

TEST_F(HullWarningTest, AnObstacleMayBeDecomposed) {
  const auto loaded = WithObstacle("{type: mesh, file: angle.obj, collision: decomposition}");
  EXPECT_THAT(loaded.warnings, IsEmpty());
}

}  // namespace hull_warning_test
}  // namespace oca::loading
