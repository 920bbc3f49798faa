// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/motion_way.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace oca::planning {
namespace motion_way_test {

using Eigen::VectorXd;

constexpr double kArrived = 0.01;

ClairvoyantTask TaskOf(double duration, const BandRequest& request) {
  ClairvoyantTask task;
  task.duration = duration;
  task.request = request;
  return task;
}

TEST(MotionWayTest, AStraightWayIsAsLongAsItsEndsAreApart) {
  const auto task = TaskOf(2.0, [](double time, int, Eigen::Ref<VectorXd> out) {
    const double share = std::min(time, 1.0);
    out = Eigen::Vector2d(3.0 * share, 4.0 * share);
  });
  const MotionWay way = WayOf(task, BandCurve(), 2, kArrived);
  EXPECT_NEAR(way.length, 5.0, 1e-12);
  EXPECT_NEAR(way.time.value(), 1.0, 1e-9);  // a step before, 0.04 are left
}

TEST(MotionWayTest, ACircleIsAPolygonOfItsSteps) {
  const auto task = TaskOf(1.0, [](double time, int, Eigen::Ref<VectorXd> out) {
    const double angle = 2.0 * std::numbers::pi * time;
    out = Eigen::Vector2d(std::cos(angle), std::sin(angle));
  });
  const MotionWay way = WayOf(task, BandCurve(), 2, kArrived);
  EXPECT_NEAR(way.length, 200.0 * std::sin(0.01 * std::numbers::pi), 1e-12);
  EXPECT_EQ(way.time, 1.0);  // it was there at the start, too, and went away
}

TEST(MotionWayTest, WhatIsAddedCounts) {
  const auto task = TaskOf(1.0, [](double, int, Eigen::Ref<VectorXd> out) { out.setZero(); });
  BandCurve curve(1, {0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0});
  for (Eigen::Index i = 0; i < curve.controls().cols(); ++i) {
    curve.controls()(0, i) = 0.1 * static_cast<double>(i);  // ascending, and so is the curve
  }
  VectorXd first(1), last(1);
  curve.Evaluate(0.0, 0, first);
  curve.Evaluate(1.0, 0, last);
  const MotionWay way = WayOf(task, curve, 1, kArrived);
  EXPECT_NEAR(way.length, last[0] - first[0], 1e-12);
  EXPECT_GT(way.length, 0.5);
  EXPECT_EQ(way.time, std::nullopt);  // it ends away from the request
}

}  // namespace motion_way_test
}  // namespace oca::planning
