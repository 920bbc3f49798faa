// SPDX-License-Identifier: BSD-3-Clause
// What a band makes of limits that are open, extreme or exceeded.
#include <gtest/gtest.h>

#include "oca/models/planning/band_optimizer.h"
#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace band_limits_test {

using Eigen::VectorXd;

/// A scene of one planar joint set to `lower` and `upper`, far from a box; the arm rests at 0.
struct Rest {
  Rest(double lower, double upper, double velocity = robot::kUnlimited) {
    const auto arm = test::Arm("planar3");
    std::vector<robot::Joint> joints = arm->joints();
    joints[1].lower_limit = lower;
    joints[1].upper_limit = upper;
    joints[1].velocity_limit = velocity;
    model = std::make_shared<const robot::RobotModel>(arm->name(), arm->links(), joints);
    const robot::PlacedBody box = test::BoxAt({0.1, 0.1, 0.1}, {0.0, 9.0, 0.0});
    bodies.push_back(
        {models::Name("box"), box.collider, [X = box.X_WO](double) { return X; }, true});
  }
  /// A band whose joint 1 starts at `from` and goes to `to`.
  BandCheck Check(double from, double to) const {
    std::vector<double> times;
    for (int i = 0; i <= 10; ++i) times.push_back(0.5 * i);
    BandCurve curve(3, times);
    const VectorXd zero = VectorXd::Zero(3);
    curve.StartWith(from * VectorXd::Unit(3, 1), zero, zero);
    curve.Follow([&](double) -> VectorXd { return to * VectorXd::Unit(3, 1); });
    BandOptimizer band(model, {});
    band.Prepare(
        curve, [](double, int, Eigen::Ref<VectorXd> out) { out.setZero(); }, bodies, false);
    EXPECT_TRUE(std::isfinite(band.Cost(curve)));
    BandCurve relaxed = curve;
    EXPECT_TRUE(std::isfinite(band.Relax(relaxed, 5)));
    EXPECT_TRUE(relaxed.controls().allFinite());
    return band.Check(curve);
  }
  std::shared_ptr<const robot::RobotModel> model;
  std::vector<BandBody> bodies;
};

TEST(BandLimitsTest, KeepsALimitOnOneSideAndNoneOfARangeThatOverflows) {
  const Rest above(-robot::kUnlimited, 0.5);
  EXPECT_TRUE(above.Check(0.0, 0.4).clear());
  EXPECT_FALSE(above.Check(0.0, 0.6).clear());
  EXPECT_TRUE(above.Check(0.0, -2.0).clear());
  const Rest below(-0.5, robot::kUnlimited);
  EXPECT_FALSE(below.Check(0.0, -0.6).clear());
  EXPECT_TRUE(below.Check(0.0, 2.0).clear());
  EXPECT_TRUE(Rest(-1e308, 1e308).Check(0.0, 2.0).clear());
}

TEST(BandLimitsTest, AllowsAnArmBeyondALimitToComeBack) {
  const Rest rest(-0.5, 0.5);
  EXPECT_TRUE(rest.Check(0.8, 0.0).clear());
  EXPECT_TRUE(rest.Check(0.8, 0.8).clear());  // no worse
  EXPECT_FALSE(rest.Check(0.8, 0.9).clear());
  EXPECT_FALSE(rest.Check(0.8, -0.6).clear());
}

TEST(BandLimitsTest, DividesByNoLimit) {
  for (const double limit : {1e-300, 0.0, 1e308, robot::kUnlimited})
    Rest(-1, 1, limit).Check(0.0, 0.5);
}

}  // namespace band_limits_test
}  // namespace oca::planning
