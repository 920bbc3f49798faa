// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/clearance.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "oca/models/random.h"
#include "tests/models/planning/scene.h"

namespace oca::robot {
namespace clearance_test {

Eigen::VectorXd Draw(const RobotModel& model, models::Random& random) {
  Eigen::VectorXd q(model.num_positions());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q[i] = random.Uniform(model.lower_limits()[i], model.upper_limits()[i]);
  }
  return q;
}

TEST(ClearanceTest, OfAStretchedArmIsTheGapBeforeItsEnd) {
  // The planar arm's fore link is a capsule of radius 0.04 that ends at 0.9 + 0.04 along x.
  Clearance clearance(planning::test::Arm("planar2"), false,
                      {planning::test::BoxAt({0.2, 0.2, 0.2}, {1.2, 0.0, 0.0})});
  clearance.MoveTo(Eigen::Vector2d::Zero());
  const NearPair nearest = clearance.Nearest();
  const double tip = nearest.point_on_link.x();
  EXPECT_NEAR(nearest.distance, 1.1 - tip, 1e-12);
  EXPECT_NEAR(nearest.point_on_other.x(), 1.1, 1e-12);
  EXPECT_LT((nearest.normal + Eigen::Vector3d::UnitX()).norm(), 1e-9);
  EXPECT_EQ(nearest.body, 0);
  EXPECT_EQ(clearance.model().links()[nearest.link].name.text(), "planar2_link_2");
}

TEST(ClearanceTest, WhatIsUncertainIsNearerAlongTheNormal) {
  Clearance clearance(planning::test::Arm("planar2"), false,
                      {planning::test::BoxAt({0.2, 0.2, 0.2}, {1.2, 0.0, 0.0})});
  clearance.MoveTo(Eigen::Vector2d::Zero());
  const NearPair known = clearance.Nearest();
  clearance.SetCovariance(0, Eigen::Vector3d(0.01 * 0.01, 1.0, 1.0).asDiagonal());
  const NearPair pair = clearance.Nearest();
  EXPECT_NEAR(pair.distance, known.distance - 0.03, 1e-9);
  EXPECT_NEAR(pair.point_on_other.x(), known.point_on_other.x() - 0.03, 1e-9);
  EXPECT_TRUE(clearance.NearerThan(pair.distance + 1e-9));
  EXPECT_FALSE(clearance.NearerThan(pair.distance - 1e-9));
  EXPECT_EQ(clearance.Nearest(pair.distance - 1e-6).distance, kUnlimited);
}

TEST(ClearanceTest, TellsNearerFromFartherOnBothSidesOfTheDistance) {
  Clearance clearance(planning::test::Arm("planar2"), false, planning::test::Post());
  clearance.MoveTo(Eigen::Vector2d(0.3, 0.1));
  const double distance = clearance.Nearest().distance;
  ASSERT_GT(distance, 0.0);
  EXPECT_TRUE(clearance.NearerThan(distance + 1e-9));
  EXPECT_FALSE(clearance.NearerThan(distance - 1e-9));
  EXPECT_EQ(clearance.Nearest(distance - 1e-6).distance, kUnlimited);
  EXPECT_EQ(clearance.Nearest(distance - 1e-6).link, -1);
}

TEST(ClearanceTest, HasTheGradientThatDifferencesShow) {
  Clearance clearance(planning::test::Arm("lwr4"), true,
                      {planning::test::BoxAt({0.1, 0.2, 0.3}, {0.4, 0.2, 0.6})});
  models::Random random(4);
  int checked = 0;
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd q = Draw(clearance.model(), random);
    clearance.MoveTo(q);
    const NearPair pair = clearance.Nearest();
    if (pair.distance < 0.01) continue;
    Eigen::VectorXd row(7);
    clearance.Gradient(pair, row);
    for (int j = 0; j < 7; ++j) {
      constexpr double kStep = 1e-6;
      Eigen::VectorXd step = Eigen::VectorXd::Zero(7);
      step[j] = kStep;
      clearance.MoveTo(q + step);
      const NearPair after = clearance.Nearest();
      clearance.MoveTo(q - step);
      const NearPair before = clearance.Nearest();
      if (after.link != pair.link || before.link != pair.link) continue;
      EXPECT_NEAR(row[j], (after.distance - before.distance) / (2 * kStep), 1e-4);
      ++checked;
    }
  }
  EXPECT_GT(checked, 200);
}

TEST(ClearanceTest, CollectsWhatLinkDistancesAndNearestSay) {
  Clearance clearance(planning::test::Arm("lwr4"), true,
                      {planning::test::BoxAt({0.1, 0.2, 0.3}, {0.4, 0.2, 0.6}),
                       planning::test::BoxAt({0.3, 0.3, 0.3}, {0, 0, 1})});
  models::Random random(5);
  std::vector<NearPair> pairs;
  std::vector<double> links(static_cast<std::size_t>(clearance.model().num_links()));
  std::vector<double> own(clearance.own_pairs().size());
  for (int i = 0; i < 100; ++i) {
    clearance.MoveTo(Draw(clearance.model(), random));
    clearance.Collect(0.4, pairs);
    clearance.LinkDistances(0.4, links);
    clearance.OwnDistances(0.4, own);
    double least = 0.4;
    std::vector<double> expected(links.size(), 0.4);
    for (const NearPair& pair : pairs) {
      least = std::min(least, pair.distance);
      if (pair.body >= 0) expected[pair.link] = std::min(expected[pair.link], pair.distance);
    }
    for (std::size_t link = 0; link < links.size(); ++link) {
      EXPECT_NEAR(links[link], expected[link], 1e-9);
    }
    const double nearest = std::min(*std::min_element(links.begin(), links.end()),
                                    *std::min_element(own.begin(), own.end()));
    EXPECT_NEAR(least, nearest, 1e-9);
    EXPECT_NEAR(least, std::min(0.4, clearance.Nearest(0.4).distance), 1e-9);
  }
}

TEST(ClearanceTest, SeesAFoldedArmMeetItselfOnlyIfAsked) {
  const auto arm = planning::test::Arm("lwr4");
  Clearance alone(arm, false);
  Clearance itself(arm, true);
  models::Random random(6);
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::VectorXd q = Draw(*arm, random);
    alone.MoveTo(q);
    itself.MoveTo(q);
    EXPECT_EQ(alone.Nearest().link, -1);
    if (itself.NearerThan(0.0)) ++met;
  }
  EXPECT_GT(met, 0);
}

TEST(ClearanceTest, LeavesOutTwoLinksInEitherOrder) {
  Clearance all(planning::test::Arm("lwr4"), true);
  const auto pairs = all.own_pairs();
  ASSERT_GT(pairs.size(), 2u);
  for (const bool turned : {false, true}) {
    Clearance some(planning::test::Arm("lwr4"), true);
    const auto [a, b] = pairs[1];
    some.IgnoreOwn(turned ? b : a, turned ? a : b);
    ASSERT_EQ(some.own_pairs().size(), pairs.size() - 1);
    EXPECT_EQ(some.own_pairs()[0], pairs[0]);
    EXPECT_EQ(some.own_pairs()[1], pairs[2]);
    EXPECT_EQ(some.own_scales().size(), pairs.size() - 1);
  }
}

TEST(ClearanceTest, FollowsABodyThatMoves) {
  Clearance clearance(planning::test::Arm("planar2"), false, planning::test::Post());
  clearance.MoveTo(Eigen::Vector2d::Zero());
  const double before = clearance.Nearest().distance;
  clearance.MoveBody(0, Eigen::Isometry3d(Eigen::Translation3d(0.6, 1.6, 0.0)));
  EXPECT_GT(clearance.Nearest().distance, before + 0.5);
}

}  // namespace clearance_test
}  // namespace oca::robot
