// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/unseen_links.h"

#include <gmock/gmock.h>

#include "oca/models/error.h"
#include "oca/models/robot/attach_objects.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/geometry/mesh_files.h"
#include "tests/temporary_folder.h"

namespace oca::robot::test {
namespace unseen_links_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;

const char* const kDrawn = R"(<visual><origin xyz="0 0 2"/><geometry><box size="1 2 3"/>
    </geometry></visual>)";
const char* const kSolid = "<collision><geometry><sphere radius='0.5'/></geometry></collision>";

/// A base, an arm of two links and a frame at its tip, which has neither shape.
std::string Arm(const std::string& base, const std::string& upper, const std::string& fore) {
  const auto joint = [](const char* name, const char* parent, const char* child) {
    return std::string("<joint name='") + name + "' type='revolute'><parent link='" + parent +
           "'/><child link='" + child +
           "'/><limit lower='-1' upper='1' velocity='1' effort='1'/></joint>";
  };
  return "<robot name='two'><link name='base'>" + base + "</link><link name='upper'>" + upper +
         "</link><link name='fore'>" + fore + "</link><link name='tip'/>" +
         joint("j1", "base", "upper") + joint("j2", "upper", "fore") +
         "<joint name='end' type='fixed'><parent link='fore'/><child link='tip'/></joint></robot>";
}

RobotModel Load(const std::string& text, VisualAsCollision visuals = VisualAsCollision::kNone) {
  LoadOptions options;
  options.visual_as_collision = visuals;
  return ParseUrdf(text, "two.urdf", options);
}

TEST(UnseenLinksTest, FindsLinksThatAreDrawnOnly) {
  EXPECT_THAT(DrawnOnly(Load(Arm("", std::string(kDrawn) + kSolid, kDrawn))), ElementsAre(2));
  EXPECT_THAT(DrawnOnly(Load(Arm(kDrawn, kSolid, kSolid))), ElementsAre(0));
  EXPECT_THAT(DrawnOnly(Load(Arm(kSolid, kSolid, kSolid))), IsEmpty());
}

TEST(UnseenLinksTest, ASolidBaseAloneIsNothingToSee) {
  EXPECT_TRUE(NothingToSee(Load(Arm(kSolid, kDrawn, kDrawn))));
  EXPECT_FALSE(NothingToSee(Load(Arm("", "", kSolid))));
  EXPECT_TRUE(NothingToSee(Load("<robot name='f'><link name='table'/></robot>")));
  EXPECT_FALSE(NothingToSee(
      Load(std::string("<robot name='f'><link name='table'>") + kSolid + "</link></robot>")));
}

TEST(UnseenLinksTest, WhatItCarriesIsNotOfTheRobot) {
  AttachedObject box;
  box.id = "box";
  box.link = "fore";
  box.shape = geometry::Sphere{0.1};
  EXPECT_TRUE(NothingToSee(AttachObjects(Load(Arm("", kDrawn, kDrawn)), std::array{box})));
}

TEST(UnseenLinksTest, TellsNamesAndRemedy) {
  EXPECT_EQ(DescribeUnseen(Load(Arm(kSolid, kSolid, kSolid)), "it"), "");
  EXPECT_EQ(DescribeUnseen(Load(Arm("", kSolid, kDrawn)), "it"),
            "a link is drawn without a collision shape, so distances do not see it: fore; it takes "
            "what is drawn");
  EXPECT_EQ(DescribeUnseen(Load(Arm("", kDrawn, kDrawn)), "it"),
            "robot 'two' has no collision shape on any movable link, so nothing of it can be seen "
            "by distances; links are drawn without a collision shape, so distances do not see "
            "them: upper, fore; it takes what is drawn");
  EXPECT_THAT(DescribeUnseen(Load(Arm("", "", "")), "it"),
              AllOf(HasSubstr("no collision shape on any movable link"), Not(HasSubstr("drawn"))));
}

TEST(VisualAsCollisionTest, NoneLeavesVisualsAlone) {
  EXPECT_TRUE(Load(Arm("", kDrawn, kDrawn)).links()[2].collisions.empty());
}

TEST(VisualAsCollisionTest, MissingGivesThemToLinksThatHaveNoneOfTheirOwn) {
  const RobotModel model =
      Load(Arm("", std::string(kDrawn) + kSolid, kDrawn), VisualAsCollision::kMissing);
  ASSERT_EQ(model.links()[1].collisions.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<geometry::Sphere>(model.links()[1].collisions[0].shape));
  ASSERT_EQ(model.links()[2].collisions.size(), 1u);
  const CollisionElement& box = model.links()[2].collisions[0];
  EXPECT_EQ(std::get<geometry::Box>(box.shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(box.X_LC.translation(), Eigen::Vector3d(0, 0, 2));
  EXPECT_TRUE(model.links()[3].collisions.empty());
  EXPECT_FALSE(NothingToSee(model));
}

TEST(VisualAsCollisionTest, AllPutsThemInPlaceOfThoseOfEveryLinkThatIsDrawn) {
  const RobotModel model =
      Load(Arm(kSolid, std::string(kDrawn) + kSolid, kDrawn), VisualAsCollision::kAll);
  EXPECT_TRUE(std::holds_alternative<geometry::Sphere>(model.links()[0].collisions[0].shape));
  ASSERT_EQ(model.links()[1].collisions.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<geometry::Box>(model.links()[1].collisions[0].shape));
}

TEST(VisualAsCollisionTest, MeshesBecomeHullsWithTheUsualWarning) {
  oca::test::TemporaryFolder folder;
  folder.Write("angle.obj", geometry::AngleObj());
  LoadOptions options;
  options.visual_as_collision = VisualAsCollision::kMissing;
  options.load_visuals = false;
  std::vector<std::string> warnings;
  options.warn = [&](const std::string& line) { warnings.push_back(line); };
  const char* const kMesh = "<visual><geometry><mesh filename='angle.obj'/></geometry></visual>";
  const auto model = ParseUrdf(Arm("", kMesh, kSolid), "two.urdf", options, folder.path());
  EXPECT_TRUE(
      std::holds_alternative<geometry::ConvexMesh>(model.links()[1].collisions.at(0).shape));
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("link 'upper': visual mesh 'angle.obj' counts as its "
                                              "convex hull, which adds 0.5 m^3")));
  // A mesh that would only be drawn need not exist; one that collides must.
  const char* const kLost = "<visual><geometry><mesh filename='lost.obj'/></geometry></visual>";
  EXPECT_THAT([&] { ParseUrdf(Arm("", kLost, kSolid), "two.urdf", options, folder.path()); },
              ThrowsMessage<models::ModelError>(
                  AllOf(HasSubstr("link 'upper' visual"), HasSubstr("lost.obj"))));
  options.visual_as_collision = VisualAsCollision::kNone;
  EXPECT_NO_THROW(ParseUrdf(Arm("", kLost, kSolid), "two.urdf", options, folder.path()));
}

}  // namespace unseen_links_test
}  // namespace oca::robot::test
