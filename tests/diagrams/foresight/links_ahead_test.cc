// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/links_ahead.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "oca/models/robot/kinematics.h"
#include "tests/systems/test_models.h"

namespace oca::foresight {
namespace links_ahead_test {

using Eigen::Vector2d;

/// Rests until 1 s, then turns the first joint with 1 rad/s.
Eigen::VectorXd Turn(double time) { return Vector2d(std::max(0.0, time - 1.0), 0.5); }

TEST(LinksAheadTest, AreWhereThePositionsBringThemInAnyOrderOfTimes) {
  const auto model = systems::LoadTestModel("planar2");
  LinksAhead links(model, Turn);
  const int tip = model->FindLink("planar2_tip");
  for (const double time : {2.5, 0.0, 1.5, 1.5}) {
    const auto X_WL = robot::LinkPoses(*model, Turn(time));
    EXPECT_EQ(links.X_WL(tip, time).matrix(), X_WL[static_cast<std::size_t>(tip)].matrix());
  }
}

TEST(LinksAheadTest, StandAsLongAsNoPositionChanges) {
  LinksAhead links(systems::LoadTestModel("planar2"), Turn);
  EXPECT_TRUE(links.Stands(1.0));
  EXPECT_FALSE(links.Stands(1.002));
}

TEST(LinksAheadTest, OfAVeryLongRunAreLookedAtSoOftenAndNotMore) {
  long looks = 0;
  const auto rests = [&looks](double time) -> Eigen::VectorXd {
    ++looks;
    return Vector2d(time > 5000.0 && time < 5001.0 ? 1.0 : 0.0, 0.5);  // but for one second
  };
  LinksAhead links(systems::LoadTestModel("planar2"), rests);
  EXPECT_TRUE(links.Stands(4999.0));
  EXPECT_FALSE(links.Stands(1e7));
  LinksAhead still(systems::LoadTestModel("planar2"), [&looks](double) -> Eigen::VectorXd {
    ++looks;
    return Vector2d(0.0, 0.5);
  });
  looks = 0;
  EXPECT_TRUE(still.Stands(1e7));
  EXPECT_LE(looks, 300'001);
}

TEST(LinksAheadTest, OfAFrameStandWithoutPositions) {
  LinksAhead frame(systems::LoadTestModel("table_frame"), {});
  EXPECT_TRUE(frame.Stands(100.0));
  EXPECT_EQ(frame.X_WL(0, 3.0).matrix(), frame.model().X_WB().matrix());
}

TEST(LinksAheadTest, HaveSolidsThatGoWithThem) {
  const auto model = systems::LoadTestModel("planar2");
  const auto links = std::make_shared<LinksAhead>(model, Turn);
  for (const robot::LinkCollider& link : robot::LinkCollidersOf(*model)) {
    const auto bodies = BodiesOf(links, link, models::Name("arm/x"), false);
    ASSERT_EQ(bodies.size(), link.elements.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      EXPECT_EQ(bodies[i].name, models::Name("arm/x"));
      EXPECT_EQ(bodies[i].collider, link.elements[i].collider);
      EXPECT_FALSE(bodies[i].stands);
      const Eigen::Isometry3d X_WC = links->X_WL(link.number, 2.0) * link.elements[i].X_LC;
      EXPECT_EQ(bodies[i].pose(2.0).matrix(), X_WC.matrix());
    }
  }
}

}  // namespace links_ahead_test
}  // namespace oca::foresight
