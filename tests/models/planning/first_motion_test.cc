// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/first_motion.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "oca/models/file_bytes.h"
#include "oca/models/geometry/collider.h"
#include "oca/models/planning/arm_guess.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/urdf.h"

namespace oca::planning {
namespace first_motion_test {

std::shared_ptr<const robot::RobotModel> Load(const std::string& name) {
  const std::string path = OCA_SOURCE_DIR "/models/robots/" + name + "/" + name;
  robot::LoadOptions options;
  if (name != "planar2") options.srdf = path + ".srdf";
  options.package_directories = {OCA_SOURCE_DIR "/models/robots"};
  return std::make_shared<const robot::RobotModel>(robot::LoadUrdf(path + ".urdf", options));
}

TEST(ReachTest, IsTheLengthBetweenTheJoints) {
  const auto arm = Load("planar2");  // links of 0.5 and 0.4 m
  EXPECT_DOUBLE_EQ(ReachOf(*arm, arm->FindLink("planar2_tip")), 0.9);
}

/// An arm of 0.5 and 0.3 m that stands on slides one after the other, each an axis and a range, m;
/// "turn": a joint that turns stands there.
robot::RobotModel OnSlides(const std::vector<std::pair<std::string, double>>& slides) {
  std::string text = "<robot name='on_slides'><link name='l0'/>";
  int links = 0;
  const auto add = [&](const char* type, const std::string& axis, double offset, double range) {
    text += fmt::format(
        "<link name='l{1}'/><joint name='j{1}' type='{2}'><parent link='l{0}'/><child link='l{1}'/>"
        "<axis xyz='{3}'/><origin xyz='{4} 0 0'/><limit lower='0' upper='{5}' velocity='1' "
        "effort='1'/></joint>",
        links, links + 1, type, axis, offset, range);
    ++links;
  };
  for (const auto& [axis, range] : slides) {
    if (axis == "turn") {
      add("revolute", "0 0 1", 0.0, 2.0);
    } else {
      add("prismatic", axis, 0.0, range);
    }
  }
  add("revolute", "0 0 1", 0.0, 2.0);
  add("revolute", "0 0 1", 0.5, 2.0);
  text += fmt::format(
      "<link name='tip'/><joint name='end' type='fixed'><parent link='l{}'/><child link='tip'/>"
      "<origin xyz='0.3 0 0'/></joint></robot>",
      links);
  return robot::ParseUrdf(text, "on_slides.urdf");
}

double ReachOnSlides(const std::vector<std::pair<std::string, double>>& slides) {
  const robot::RobotModel arm = OnSlides(slides);
  return ReachOf(arm, arm.FindLink("tip"));
}

TEST(ReachTest, CountsASlideNoMoreThanTheLengthsTogether) {
  for (const auto& [rail, reach] : {std::pair(0.2, 1.0), {0.8, 1.6}, {4.0, 1.6}}) {
    EXPECT_DOUBLE_EQ(ReachOnSlides({{"1 0 0", rail}}), reach) << rail;
  }
}

TEST(ReachTest, CountsSlidesAcrossEachOtherAsTheDiagonal) {
  EXPECT_DOUBLE_EQ(ReachOnSlides({{"1 0 0", 0.3}, {"0 1 0", 0.4}}), 0.8 + 0.5);
  EXPECT_DOUBLE_EQ(ReachOnSlides({{"0.8 0.6 0", 0.2}, {"0.6 -0.8 0", 0.2}, {"0 0 -1", 0.1}}),
                   0.8 + 0.3);
  EXPECT_DOUBLE_EQ(ReachOnSlides({{"1 0 0", 0.3}, {"-1 0 0", 0.4}}), 0.8 + 0.7);
  EXPECT_DOUBLE_EQ(ReachOnSlides({{"1 0 0", 0.3}, {"turn", 0.0}, {"0 1 0", 0.4}}), 0.8 + 0.7)
      << "they can come to lie along one line";
}

/// iiwa14 as it hangs from a ceiling: all that it reaches is below its base.
TEST(FirstMotionHangingTest, GoesBelowTheBaseWhereItCannotStayAbove) {
  const std::string folder = OCA_SOURCE_DIR "/models/robots/iiwa14/";
  std::string text = models::ReadFile(folder + "iiwa14.urdf");
  text.insert(text.rfind("</robot>"),
              "<link name='ceiling'><collision><origin xyz='0 0 0.03'/><geometry><box size='3 3 "
              "0.05'/></geometry></collision></link><joint name='hang' type='fixed'><parent "
              "link='ceiling'/><child link='" +
                  Load("iiwa14")->links()[0].name.text() +
                  "'/><origin rpy='3.14159265 0 0'/></joint>");
  robot::LoadOptions options;
  options.package_directories = {OCA_SOURCE_DIR "/models/robots"};
  const auto arm = std::make_shared<const robot::RobotModel>(
      robot::ParseUrdf(text, folder + "iiwa14.urdf", options));
  const auto motions = ProposeMotions(arm, GuessArm(*arm).tip, 3);
  ASSERT_FALSE(motions.empty());
  for (const FirstMotion& motion : motions) EXPECT_LT(motion.ball.z(), 0.0);
}

class FirstMotionTest : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Arms, FirstMotionTest, testing::Values("lwr4", "iiwa14", "ur5e"));

TEST_P(FirstMotionTest, GoesThroughABallFromWhereItIsClearToWhereItIsClear) {
  const auto arm = Load(GetParam());
  const int tip = GuessArm(*arm).tip;
  const double reach = ReachOf(*arm, tip);
  const auto motions = ProposeMotions(arm, tip, 10);
  ASSERT_EQ(motions.size(), 10);
  for (const FirstMotion& motion : motions) {
    EXPECT_TRUE(((motion.from - motion.to).array() != 0.0).count() == 1);
    robot::Clearance clearance(arm, true);
    Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
    X_WO.translation() = motion.ball;
    clearance.SetBodies({{geometry::MakeCollider(geometry::Sphere{motion.radius}, "ball"), X_WO}});
    double way = 0.0;
    double deepest = 1.0;
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    for (int i = 0; i <= 100; ++i) {
      const Eigen::VectorXd q = motion.from + i / 100.0 * (motion.to - motion.from);
      EXPECT_TRUE((q.array() > arm->lower_limits().array()).all());
      EXPECT_TRUE((q.array() < arm->upper_limits().array()).all());
      clearance.MoveTo(q);
      const robot::NearPair nearest = clearance.Nearest();
      deepest = std::min(deepest, nearest.distance);
      if (nearest.distance <= 0.0) {
        EXPECT_EQ(nearest.body, 0) << "own links touch";
      }
      const Eigen::Vector3d now = clearance.X_WL()[static_cast<std::size_t>(tip)].translation();
      way += i == 0 ? 0.0 : (now - last).norm();
      last = now;
      if (i == 0 || i == 100) {
        EXPECT_GT(nearest.distance, 0.0);
      }
    }
    EXPECT_LT(deepest, -0.2 * motion.radius);
    EXPECT_GT(way, 0.45 * reach);
  }
}

TEST(FirstMotionsTest, AreTheSameForTheSameSeed) {
  const auto arm = Load("ur5e");
  const int tip = GuessArm(*arm).tip;
  const auto one = ProposeMotions(arm, tip, 3, 7);
  const auto two = ProposeMotions(arm, tip, 3, 7);
  const auto other = ProposeMotions(arm, tip, 3, 8);
  ASSERT_EQ(one.size(), 3);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].from, two[i].from);
    EXPECT_EQ(one[i].ball, two[i].ball);
    EXPECT_NE(one[i].from, other[i].from);
  }
}

}  // namespace first_motion_test
}  // namespace oca::planning
