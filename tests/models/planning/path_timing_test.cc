// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/path_timing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "oca/models/planning/smooth_step.h"
#include "oca/models/robot/urdf.h"

namespace oca::planning {
namespace path_timing_test {

using Eigen::Vector2d;
using Eigen::VectorXd;

/// Two joints, one of 0.5 rad/s and one of 4 rad/s, 2 rad/s^2 and 8 rad/s^2.
robot::RobotModel Arm() {
  robot::LoadOptions options;
  options.acceleration_limits = Vector2d(2.0, 8.0);
  return robot::ParseUrdf(R"(<robot name="two"><link name="base"/><link name="a"/><link name="b"/>
  <joint name="slow" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="0.5" effort="1"/></joint>
  <joint name="fast" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="4" effort="1"/></joint></robot>)",
                          "two.urdf", options);
}

TEST(PathTimingTest, EachPieceTakesWhatItsSlowestJointOrAllOfThemNeed) {
  // 0.5 rad at 0.5 rad/s; then 1.2 and 1.6 rad: the first joint needs 2.4 s, 2 rad at 2 rad/s 1 s;
  // then 2 rad of the fast one, at 2 rad/s.
  const std::vector<VectorXd> path{Vector2d(0, 0), Vector2d(0.5, 0), Vector2d(-0.7, 1.6),
                                   Vector2d(-0.7, -0.4)};
  const std::vector<double> times = TimesAlong(Arm(), path);
  ASSERT_EQ(times.size(), 4u);
  EXPECT_DOUBLE_EQ(times[0], 0.0);
  EXPECT_DOUBLE_EQ(times[1], 1.0);
  EXPECT_DOUBLE_EQ(times[2], 3.4);
  EXPECT_DOUBLE_EQ(times[3], 4.4);
}

/// The largest speed and acceleration of SmoothStep over a way in a time.
struct Peak {
  double speed{0.0}, acceleration{0.0};
};
Peak PeakOf(double way, double duration) {
  Peak peak;
  constexpr double kStep = 1e-4;
  for (double s = kStep; s < 1.0; s += kStep) {
    const double before = SmoothStep(s - kStep), here = SmoothStep(s),
                 after = SmoothStep(s + kStep);
    peak.speed = std::max(peak.speed, way * (after - before) / (2.0 * kStep * duration));
    peak.acceleration = std::max(peak.acceleration, way * (after - 2.0 * here + before) /
                                                        (kStep * kStep * duration * duration));
  }
  return peak;
}

TEST(PathTimingTest, AStraightWayTakesLimitsToTheirShare) {
  for (const Vector2d& way : {Vector2d(1.0, 0.1), Vector2d(0.0, 0.05), Vector2d(0.02, 0.01)}) {
    const double duration = DurationAlong(Arm(), {Vector2d(0, 0), way}, 0.9);
    double most = 0.0;
    for (int j = 0; j < 2; ++j) {
      const Peak peak = PeakOf(way[j], duration);
      const double speed = Vector2d(0.5, 4.0)[j], acceleration = Vector2d(2.0, 8.0)[j];
      most = std::max({most, peak.speed / speed, std::sqrt(peak.acceleration / acceleration)});
    }
    EXPECT_NEAR(most, 0.9, 1e-3) << way.transpose();
  }
}

TEST(PathTimingTest, AWayWithinATimeIsTheOneThatTakesIt) {
  for (const double duration : {0.1, 0.5, 3.0}) {
    const VectorXd way = WayWithin(Arm(), duration, 0.9);
    for (int j = 0; j < 2; ++j) {
      const Peak peak = PeakOf(way[j], duration);
      const double speed = Vector2d(0.5, 4.0)[j], acceleration = Vector2d(2.0, 8.0)[j];
      EXPECT_NEAR(std::max(peak.speed / speed, std::sqrt(peak.acceleration / acceleration)), 0.9,
                  1e-3)
          << duration << " " << j;
    }
  }
}

}  // namespace path_timing_test
}  // namespace oca::planning
