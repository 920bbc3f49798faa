// SPDX-License-Identifier: BSD-3-Clause
// What each signal may be that comes from outside: both sides of every bound.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/signals/clear_motion.h"
#include "oca/systems/signals/contact_slopes.h"
#include "oca/systems/signals/signals.h"
#include "tests/allocation_count.h"

namespace oca::systems {
namespace signal_checks_test {

using testing::HasSubstr;
using testing::StrEq;

Obstacle Ball(const std::string& id) {
  ShapeParams shape;
  shape.radius = 0.1;
  Obstacle ball;
  ball.body = MakeObstacleBody(id, shape, "ball");
  ball.X_WO = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1.0, 2.0, -1.0).normalized());
  return ball;
}

template <class T>
std::string Whole(const T& value) {
  return Signal<T>::Check(value, Look::kWhole).text();
}

template <class T>
bool Passes(const T& value, Look look = Look::kWhole) {
  return Signal<T>::Check(value, look).ok();
}

/// A change of the first obstacle, and what is said of it.
template <class Change>
std::string Spoilt(const Change& change) {
  ObstacleSet set{{Ball("ball"), Ball("other")}};
  EXPECT_TRUE(Passes(set));
  change(set.obstacles[0]);
  return Whole(set);
}

TEST(SignalChecksTest, AnObstacleHasABodyWhoeverMadeIt) {
  ObstacleSet set{{Ball("ball"), Obstacle()}};
  for (const Look look : {Look::kFinite, Look::kWhole}) {
    EXPECT_THAT(Signal<ObstacleSet>::Check(set, look).text(),
                StrEq("obstacle 1: body; got none; expected one of MakeObstacleBody"));
  }
  set.obstacles[1].body = std::make_shared<ObstacleBody>();
  EXPECT_THAT(Whole(set), HasSubstr("obstacle 1: body; got one without a shape"));
}

TEST(SignalChecksTest, AnObstacleIsTurnedRigidlyToABillionth) {
  EXPECT_EQ(Spoilt([](Obstacle& o) { o.X_WO.linear() *= 1.0 + 4e-10; }), "");
  EXPECT_THAT(Spoilt([](Obstacle& o) { o.X_WO.linear() *= 1.0 + 6e-10; }),
              HasSubstr("obstacle 'ball': rotation"));
  EXPECT_THAT(Spoilt([](Obstacle& o) { o.X_WO.linear().setZero(); }), HasSubstr("rotation"));
  EXPECT_THAT(Spoilt([](Obstacle& o) { o.X_WO.linear() *= -1.0; }), HasSubstr("mirrors"));
  EXPECT_THAT(Spoilt([](Obstacle& o) { o.X_WO.linear().col(1) += 1e-8 * o.X_WO.linear().col(0); }),
              HasSubstr("rotation"));
}

TEST(SignalChecksTest, AnObstacleIsWithinAThousandKilometresAndNoFaster) {
  EXPECT_EQ(Spoilt([](Obstacle& o) { o.X_WO.translation().y() = -1e6; }), "");
  EXPECT_THAT(Spoilt([](Obstacle& o) { o.X_WO.translation().y() = -1.000001e6; }),
              HasSubstr("obstacle 'ball': position; got [0, -1000001, 0] m"));
  EXPECT_EQ(Spoilt([](Obstacle& o) { o.linear.z() = 1e6; }), "");
  EXPECT_THAT(Spoilt([](Obstacle& o) { o.linear.z() = 1.1e6; }), HasSubstr("velocity"));
  EXPECT_THAT(Spoilt([](Obstacle& o) { o.angular.z() = -1e300; }), HasSubstr("velocity"));
}

TEST(SignalChecksTest, ObstaclesHaveNamesAndNoneTwice) {
  EXPECT_THAT(Spoilt([](Obstacle& o) { o = Ball(""); }), HasSubstr("got an empty one"));
  EXPECT_THAT(Spoilt([](Obstacle& o) { o = Ball("other"); }),
              StrEq("obstacle 1: id; got 'other' again; expected unique ids"));
  ObstacleSet many;
  for (int i = 0; i < 5000; ++i) many.obstacles.push_back(Ball("ball" + std::to_string(i)));
  EXPECT_TRUE(Passes(many));
  many.obstacles[4321].body = many.obstacles[17].body;
  EXPECT_THAT(Whole(many), StrEq("obstacle 4321: id; got 'ball17' again; expected unique ids"));
}

TEST(SignalChecksTest, AVelocityThatIsNotKnownIsWrittenAsZero) {
  EXPECT_EQ(Spoilt([](Obstacle& o) { o.velocity_known = false; }), "");
  EXPECT_THAT(Spoilt([](Obstacle& o) {
                o.velocity_known = false;
                o.angular.x() = 1e-9;
              }),
              HasSubstr("velocity; got one that is not known; expected zeros"));
}

TEST(SignalChecksTest, AnEstimateHasACovarianceAndAnAge) {
  ObstacleSet set{{Ball("ball"), Ball("other")}};
  set.estimates.resize(2);
  EXPECT_TRUE(Passes(set));
  const auto spoilt = [&](const auto& change) {
    ObstacleSet bad = set;
    change(bad.estimates[1]);
    return Whole(bad);
  };
  EXPECT_EQ(spoilt([](ObstacleEstimate& e) { e.covariance.setConstant(1.0); }), "");  // of rank 1
  EXPECT_THAT(spoilt([](ObstacleEstimate& e) { e.covariance(2, 2) = -1e-12; }),
              HasSubstr("obstacle 'other': covariance; got a matrix that is not positive"));
  EXPECT_THAT(spoilt([](ObstacleEstimate& e) {
                e.covariance.setIdentity();
                e.covariance(0, 1) = 0.1;
              }),
              HasSubstr("not symmetric"));
  EXPECT_EQ(spoilt([](ObstacleEstimate& e) { e.age = 0.0; }), "");
  EXPECT_THAT(spoilt([](ObstacleEstimate& e) { e.age = -1e-9; }), HasSubstr("age; got -1e-09 s"));
  EXPECT_THAT(spoilt([](ObstacleEstimate& e) { e.acceleration.x() = 1.1e6; }),
              HasSubstr("acceleration"));
  EXPECT_THAT(spoilt([](ObstacleEstimate& e) { e.covariance(0, 0) = std::nan(""); }),
              HasSubstr("NaN"));
  set.estimates.resize(1);
  EXPECT_THAT(Whole(set), HasSubstr("got 2 obstacles and 1 estimates"));
}

TEST(SignalChecksTest, WhatOnlyTheInsideMaySayIsDroppedAtTheDoor) {
  ObstacleSet set{{Ball("ball")}, 7, {0, 5}};
  Signal<ObstacleSet>::FromOutside(set);
  EXPECT_EQ(set.layout, 0u);
  EXPECT_TRUE(set.moving.empty());
}

TEST(SignalChecksTest, LinksHaveColumnsOfOneLengthRigidPosesAndNames) {
  LinkPoses links;
  for (const char* name : {"a", "b"}) {
    links.links.emplace_back(name);
    links.poses.push_back(Eigen::Isometry3d::Identity());
    links.bodies.push_back(-1);
  }
  EXPECT_TRUE(Passes(links));
  const auto spoilt = [&](const auto& change) {
    LinkPoses bad = links;
    change(bad);
    return Whole(bad);
  };
  EXPECT_THAT(spoilt([](LinkPoses& l) { l.poses.pop_back(); }), HasSubstr("2 links, 1 poses"));
  EXPECT_THAT(spoilt([](LinkPoses& l) { l.velocities.emplace_back(); }), HasSubstr("1 velocities"));
  EXPECT_THAT(spoilt([](LinkPoses& l) { l.bodies[1] = 2; }), HasSubstr("link 'b': body; got 2"));
  EXPECT_THAT(spoilt([](LinkPoses& l) { l.links[1] = l.links[0]; }), HasSubstr("got 'a' again"));
  EXPECT_THAT(spoilt([](LinkPoses& l) { l.links[1] = {}; }), HasSubstr("empty name"));
  EXPECT_THAT(spoilt([](LinkPoses& l) { l.poses[1].linear() *= 2.0; }),
              HasSubstr("link 'b': rotation"));
  EXPECT_THAT(spoilt([](LinkPoses& l) { l.poses[0].translation().x() = 2e6; }),
              HasSubstr("link 'a': position"));
  // What would crash a reader is seen inside, too.
  links.poses.pop_back();
  EXPECT_FALSE(Passes(links, Look::kFinite));
}

TEST(SignalChecksTest, AProximityHasAUnitNormalNamesAndNoNegativeSpeed) {
  ProximitySet set;
  set.proximities.push_back({.link = models::Name("l"), .obstacle = models::Name("o")});
  EXPECT_TRUE(Passes(set));
  const auto spoilt = [&](const auto& change) {
    ProximitySet bad = set;
    change(bad, bad.proximities[0]);
    return Whole(bad);
  };
  EXPECT_EQ(spoilt([](auto&, Proximity& p) { p.normal.x() = 1.0 + 5e-10; }), "");
  EXPECT_THAT(spoilt([](auto&, Proximity& p) { p.normal.x() = 1.0 + 2e-9; }),
              HasSubstr("proximity of 'l' and 'o': normal; got length 1.000000002"));
  EXPECT_THAT(spoilt([](auto&, Proximity& p) { p.normal.setZero(); }), HasSubstr("normal"));
  EXPECT_THAT(spoilt([](auto&, Proximity& p) { p.link = {}; }), HasSubstr("empty name"));
  EXPECT_THAT(spoilt([](auto&, Proximity& p) { p.point_on_link.z() = 2e6; }),
              HasSubstr("beyond 1e6"));
  EXPECT_THAT(spoilt([](auto&, Proximity& p) { p.obstacle_speed = -1.0; }),
              HasSubstr("obstacle_speed"));
  EXPECT_THAT(spoilt([](auto&, Proximity& p) { p.range = 0.0; }), HasSubstr("range"));
  EXPECT_THAT(spoilt([](ProximitySet& s, auto&) { s.max_distance = -0.1; }),
              HasSubstr("max_distance"));
}

TEST(SignalChecksTest, ForcesAndWrenchesActOnALinkAtAPlace) {
  LinkForceSet forces;
  forces.forces.push_back({models::Name("l"), {}, {1e9, 0, 0}, {0, 0, 1}});
  EXPECT_TRUE(Passes(forces));
  forces.forces[0].point.z() = 2e6;
  EXPECT_THAT(Whole(forces), HasSubstr("force on 'l': place"));
  forces.forces[0].link = {};
  EXPECT_THAT(Whole(forces), HasSubstr("force: link"));
  WrenchSet wrenches;
  wrenches.wrenches.emplace_back().link = models::Name("l");
  wrenches.wrenches[0].origin.y() = -2e6;
  EXPECT_THAT(Whole(wrenches), HasSubstr("wrench on 'l': place; got [0, -2000000, 0] m"));
}

TEST(SignalChecksTest, OtherInputsSayWhatTheyAre) {
  EXPECT_TRUE(Passes(ClearMotion{.clear_for = 0.0}));
  EXPECT_THAT(Whole(ClearMotion{.clear_for = -1.0}), HasSubstr("clear_for: got -1 s"));
  ContactSlopes slopes;
  slopes.slopes.emplace_back();
  slopes.slopes[0].link = models::Name("l");
  slopes.slopes[0].normal = Eigen::Vector3d(0.0, 0.0, 2.0);
  EXPECT_THAT(Whole(slopes), HasSubstr("slope on 'l': normal; got length 2"));
}

TEST(SignalChecksTest, LookingTakesNoMemoryGoodOrBad) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  ObstacleSet set;
  for (int i = 0; i < 1000; ++i) set.obstacles.push_back(Ball("n" + std::to_string(i)));
  ObstacleSet bad = set;
  bad.obstacles[999].X_WO.linear() *= 2.0;
  const std::int64_t before = AllocationCount();
  EXPECT_TRUE(Passes(set));
  EXPECT_FALSE(Passes(bad));
  EXPECT_EQ(AllocationCount() - before, 0);
}

}  // namespace signal_checks_test
}  // namespace oca::systems
