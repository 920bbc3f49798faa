// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/urdf_meshes.h"

#include <gmock/gmock.h>

#include <vector>

namespace oca::robot::test {
namespace urdf_meshes_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kRobot = R"(<robot name="r">
<!-- <link><visual><geometry><mesh filename="gone.stl"/></geometry></visual></link> -->
<link name="l"><visual><geometry><mesh filename="a&amp;b.stl"/></geometry></visual>
  <collision><geometry><mesh filename='c.stl' scale="1 1 1"/></geometry></collision></link>
<gazebo reference="l"><visual><geometry><mesh filename="model://x.dae"/></geometry></visual></gazebo>
</robot>)";

TEST(UrdfMeshesTest, AsksForTheMeshesOfLinksAloneByTheNamesThatTheRobotHas) {
  std::vector<std::string> asked;
  const std::string same = RenameMeshes(kRobot, "r", [&](const std::string& name) {
    asked.push_back(name);
    return name;
  });
  EXPECT_THAT(asked, ElementsAre("a&b.stl", "c.stl"));
  EXPECT_EQ(same, kRobot) << "to the bit";
}

TEST(UrdfMeshesTest, PutsNewNamesInTheirPlace) {
  const std::string renamed = RenameMeshes(kRobot, "r", [](const std::string& name) {
    return name == "c.stl" ? std::string("<d>.stl") : name;
  });
  EXPECT_THAT(renamed, HasSubstr("&lt;d&gt;.stl"));
  EXPECT_THAT(renamed, HasSubstr("a&amp;b.stl"));
  EXPECT_THAT(renamed, Not(HasSubstr("c.stl")));
  EXPECT_THAT(renamed, HasSubstr("gone.stl"));
}

}  // namespace urdf_meshes_test
}  // namespace oca::robot::test
