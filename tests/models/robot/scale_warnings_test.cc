// SPDX-License-Identifier: BSD-3-Clause
// Lengths that were meant as millimetres are told, and no arm that is as large as arms are.
#include "oca/models/robot/scale_warnings.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "oca/models/robot/urdf.h"

namespace oca::robot::test {
namespace scale_warnings_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two links of `length`, a box of `size` on the outer one.
std::vector<std::string> WarningsOf(double length, double size, const char* type = "revolute") {
  return ScaleWarnings(ParseUrdf(
      fmt::format(
          "<robot name='r'><link name='a'/><link name='b'/><link name='c'><collision>"
          "<geometry><box size='{1} {1} {1}'/></geometry></collision></link>"
          "<joint name='i' type='{2}'><origin xyz='{0} 0 0'/><parent link='a'/><child link='b'/>"
          "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>"
          "<joint name='j' type='fixed'><origin xyz='0 {0} 0'/><parent link='b'/><child link='c'/>"
          "</joint></robot>",
          length, size, type),
      "r.urdf"));
}

TEST(ScaleWarningsTest, ARobotInMillimetresIsTold) {
  EXPECT_THAT(WarningsOf(400.0, 80.0), ElementsAre(HasSubstr("the robot is 400 m long")));
  EXPECT_THAT(WarningsOf(1.75, 0.1), IsEmpty());             // the longest of arms
  EXPECT_THAT(WarningsOf(20.0, 1.0), IsEmpty());             // a crane
  EXPECT_THAT(WarningsOf(400.0, 80.0, "fixed"), IsEmpty());  // a world
}

TEST(ScaleWarningsTest, AShapeInMillimetresIsTold) {
  EXPECT_THAT(WarningsOf(0.4, 80.0),
              ElementsAre(testing::AllOf(HasSubstr("r.urdf:1: link 'c' collision reaches 69 m"),
                                         HasSubstr("0.4 m long"))));
  EXPECT_THAT(WarningsOf(0.4, 2.0), IsEmpty());  // a gripper that holds a wardrobe
  EXPECT_THAT(WarningsOf(0.4, 500.0, "fixed"), IsEmpty());
}

}  // namespace scale_warnings_test
}  // namespace oca::robot::test
