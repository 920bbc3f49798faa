// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/attach_objects.h"

#include <gmock/gmock.h>

#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace attach_objects_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

RobotModel Planar3() { return LoadUrdf(ProductFile("robots/planar3/planar3.urdf")); }

AttachedObject Box(const std::string& id, const std::string& link) {
  AttachedObject box;
  box.id = id;
  box.link = link;
  box.X_LO.translation() = Eigen::Vector3d(0.1, 0.0, 0.0);
  box.shape = geometry::Box{Eigen::Vector3d(0.2, 0.1, 0.1)};
  return box;
}

TEST(AttachObjectsTest, AnObjectMovesWithTheLinkThatCarriesIt) {
  const RobotModel robot = Planar3();
  const AttachedObject boxes[] = {Box("cup", "planar3_tip")};
  const RobotModel holding = AttachObjects(robot, boxes);
  EXPECT_EQ(holding.num_positions(), 3);
  EXPECT_EQ(holding.num_links(), robot.num_links() + 1);
  const int cup = holding.FindLink("cup");
  EXPECT_EQ(cup, robot.num_links());
  EXPECT_EQ(holding.body(cup), holding.FindLink("planar3_link_3"));
  // Turned up by a right angle: the tip at (0, 1.2), the box 0.1 m beyond.
  const auto X_WL = LinkPoses(holding, Eigen::Vector3d(std::acos(0.0), 0.0, 0.0));
  EXPECT_LT((X_WL[cup].translation() - Eigen::Vector3d(0.0, 1.3, 0.0)).norm(), 1e-15);
  EXPECT_EQ(holding.links()[cup].collisions.size(), 1u);
  EXPECT_EQ(holding.links()[cup].visuals.size(), 1u);
}

TEST(AttachObjectsTest, AnObjectMayTouchItsCarrierAndWhatItSays) {
  const RobotModel robot = Planar3();
  AttachedObject tool = Box("tool", "planar3_tip");
  tool.touches = {"planar3_link_1"};
  AttachedObject cup = Box("cup", "tool");
  cup.touches = {"tool"};
  const AttachedObject objects[] = {tool, cup};
  const RobotModel holding = AttachObjects(robot, objects);
  const auto checked = [&](const char* a, const char* b) {
    const int one = holding.FindLink(a), two = holding.FindLink(b);
    return !holding.adjacent(one, two) && !holding.collision_disabled(one, two);
  };
  EXPECT_FALSE(checked("tool", "planar3_tip"));
  EXPECT_FALSE(checked("tool", "planar3_link_3")) << "rigidly connected";
  EXPECT_TRUE(checked("tool", "planar3_link_2")) << "a neighbour, but across a joint";
  EXPECT_FALSE(checked("planar3_link_3", "planar3_link_2")) << "built to clear each other";
  EXPECT_FALSE(checked("tool", "planar3_link_1")) << "said so";
  EXPECT_TRUE(checked("cup", "planar3_link_1"));
  EXPECT_FALSE(checked("cup", "tool"));
}

TEST(AttachObjectsTest, ARobotWithoutObjectsIsItself) {
  const RobotModel robot = Planar3();
  const RobotModel same = AttachObjects(robot, {});
  EXPECT_EQ(same.num_links(), robot.num_links());
  EXPECT_EQ(same.disabled_pairs(), robot.disabled_pairs());
}

TEST(AttachObjectsTest, UnknownLinksAndTakenNamesAreRefused) {
  const RobotModel robot = Planar3();
  const auto attach = [&](const AttachedObject& object) {
    const AttachedObject objects[] = {object};
    AttachObjects(robot, objects);
  };
  EXPECT_THAT([&] { attach(Box("cup", "planar3_tpi")); },
              ThrowsMessage<models::ModelError>(HasSubstr("nearest is 'planar3_tip'")));
  EXPECT_THAT([&] { attach(Box("planar3_link_1", "planar3_tip")); },
              ThrowsMessage<models::ModelError>(HasSubstr("got one that is taken")));
  EXPECT_THAT([&] { attach(Box("", "planar3_tip")); },
              ThrowsMessage<models::ModelError>(HasSubstr("got an empty one")));
  AttachedObject cup = Box("cup", "planar3_tip");
  cup.touches = {"planar3_link_9"};
  EXPECT_THAT([&] { attach(cup); }, ThrowsMessage<models::ModelError>(HasSubstr("'cup' touches")));
  cup = Box("cup", "planar3_tip");
  cup.X_LO.linear() *= 2.0;
  EXPECT_THAT([&] { attach(cup); }, ThrowsMessage<models::ModelError>(HasSubstr("no rotation")));
}

}  // namespace attach_objects_test
}  // namespace oca::robot::test
