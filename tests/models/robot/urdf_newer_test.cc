// SPDX-License-Identifier: BSD-3-Clause
// URDF 1.1: capsules and quaternions.
#include <gmock/gmock.h>

#include <cmath>

#include "oca/models/error.h"
#include "oca/models/robot/urdf.h"

namespace oca::robot::test {
namespace urdf_newer_test {

using testing::HasSubstr;

RobotModel Load(const std::string& content) {
  return ParseUrdf("<robot name='r' version='1.1'>\n" + content + "\n</robot>", "r.urdf");
}

std::string RefusalOf(const std::string& content) {
  try {
    Load(content);
  } catch (const models::ModelError& error) {
    return error.what();
  }
  return "accepted";
}

std::string Solid(const std::string& kind, const std::string& shape,
                  const std::string& origin = "") {
  return "<" + kind + ">" + origin + "<geometry>" + shape + "</geometry></" + kind + ">";
}

TEST(UrdfNewerTest, ACapsuleIsAShape) {
  const RobotModel robot =
      Load("<link name='a'>" + Solid("visual", "<box size='0 1 1'/>") +
           Solid("visual", "<capsule radius='0.2' length='0.5'/>") +
           Solid("collision", "<cylinder radius='0.1' length='0.3'/>") +
           Solid("collision", "<capsule radius='0.05' length='0.4'/>", "<origin xyz='1 2 3'/>") +
           Solid("collision", "<capsule radius='0.07' length='0'/>") + "</link>");
  const auto& solids = robot.links()[0].collisions;
  ASSERT_EQ(solids.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<geometry::Cylinder>(solids[0].shape));
  const auto& capsule = std::get<geometry::Capsule>(solids[1].shape);
  EXPECT_EQ(capsule.radius, 0.05);
  EXPECT_EQ(capsule.length, 0.4);
  EXPECT_EQ(solids[1].X_LC.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(std::get<geometry::Sphere>(solids[2].shape).radius, 0.07);
  // The box without a size is not drawn, and the capsule is the next.
  ASSERT_EQ(robot.links()[0].visuals.size(), 1u);
  EXPECT_EQ(std::get<geometry::Capsule>(*robot.links()[0].visuals[0].shape).length, 0.5);
}

TEST(UrdfNewerTest, CapsulesOfNoSizeAreRefused) {
  const auto refusal = [](const std::string& sizes) {
    return RefusalOf("<link name='a'>" + Solid("collision", "<capsule " + sizes + "/>") +
                     "</link>");
  };
  EXPECT_THAT(refusal("radius='0' length='1'"), HasSubstr("r.urdf:2: link 'a' <capsule>: radius"));
  EXPECT_THAT(refusal("radius='1' length='-1'"), HasSubstr("<capsule>: length; got -1"));
  EXPECT_THAT(refusal("radius='1'"), HasSubstr("<capsule>: length; got nothing"));
  EXPECT_THAT(refusal("radius='nan' length='1'"), HasSubstr("<capsule>: radius; got 'nan'"));
}

TEST(UrdfNewerTest, AllThatIsWrongIsToldAtOnce) {
  const std::string refusal = RefusalOf(
      "<link name='a'>\n" + Solid("collision", "<capsule radius='0' length='1'/>") + "\n" +
      Solid("collision", "<capsule radius='1'/>", "<origin quat_xyzw='0 0 0 0'/>") + "\n</link>" +
      "<link name='b'><collision><geometry><sphere radius='none'/></geometry></collision></link>");
  EXPECT_THAT(refusal, testing::AllOf(HasSubstr("r.urdf:3: link 'a' <capsule>: radius"),
                                      HasSubstr("r.urdf:4: link 'a' <capsule>: length"),
                                      HasSubstr("r.urdf:4: link 'a' <origin>: quat_xyzw"),
                                      HasSubstr("link 'b' <sphere>: radius")));
}

TEST(UrdfNewerTest, QuaternionsTurnFrames) {
  // Turns by 60 degrees about (1, 1, 1), by a quarter turn about y, where roll and yaw are one, by
  // nearly that, and by a number that has been rounded.
  const double near = 0.5 * (0.5 * M_PI - 1e-7);
  for (const Eigen::Quaterniond& q :
       {Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 3, Eigen::Vector3d::Ones().normalized())),
        Eigen::Quaterniond(std::sqrt(0.5), 0.0, std::sqrt(0.5), 0.0),
        Eigen::Quaterniond(std::cos(near), 1e-8, std::sin(near), 0.0),
        Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), Eigen::Quaterniond(0.707, 0.0, 0.0, -0.707)}) {
    char text[200];
    std::snprintf(text, sizeof text, "<origin xyz='1 2 3' quat_xyzw='%.17g %.17g %.17g %.17g'/>",
                  q.x(), q.y(), q.z(), q.w());
    const RobotModel robot =
        Load("<link name='a'/><link name='b'>" + Solid("collision", "<sphere radius='1'/>", text) +
             "</link><joint name='j' type='fixed'><parent link='a'/><child link='b'/>" + text +
             "</joint>");
    const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
    EXPECT_LT((robot.joints()[0].X_PJ.linear() - R).norm(), 1e-14) << text;
    EXPECT_LT((robot.links()[1].collisions[0].X_LC.linear() - R).norm(), 1e-14) << text;
    EXPECT_EQ(robot.joints()[0].X_PJ.translation(), Eigen::Vector3d(1.0, 2.0, 3.0));
  }
}

TEST(UrdfNewerTest, QuaternionsThatAreNoneAreRefused) {
  const auto refusal = [](const std::string& origin) {
    return RefusalOf("<link name='a'>\n" +
                     Solid("collision", "<sphere radius='1'/>", "<origin " + origin + "/>") +
                     "</link>");
  };
  EXPECT_THAT(refusal("quat_xyzw='0 0 0 1' rpy='0 0 0'"),
              HasSubstr("r.urdf:3: link 'a' <origin>: quat_xyzw; got rpy beside it"));
  EXPECT_THAT(refusal("quat_xyzw='0 0 0 0'"),
              HasSubstr("r.urdf:3: link 'a' <origin>: quat_xyzw: length"));
  EXPECT_THAT(refusal("quat_xyzw='0 0 1'"), HasSubstr("quat_xyzw; got '0 0 1'; expected 4"));
  EXPECT_THAT(refusal("quat_xyzw='0 0 nan 1'"), HasSubstr("expected 4 finite numbers"));
}

}  // namespace urdf_newer_test
}  // namespace oca::robot::test
