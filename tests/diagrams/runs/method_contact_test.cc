// SPDX-License-Identifier: BSD-3-Clause
// Whatever the method, an arm that touches a cube, or that one has sunk into, leaves it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "oca/systems/signals/signals.h"
#include "tests/diagrams/runs/method_run.h"

namespace oca::runs {
namespace method_contact_test {

using Eigen::Vector3d;

const Vector3d kAtTheWrist(0.795, 0.3, 0.943);  // m
const Vector3d kAtTheElbow(0.592, 0.3, 1.105);

struct Case {
  std::string method;
  bool at_the_wrist;
  double distance;  ///< m, at the start
};

double DistanceAt(const MethodRun& run) { return run.Nearest().distance; }

/// The arm of a file, and the cube where it is `distance` apart.
MethodRun Start(const std::string& file, const Case& of) {
  Vector3d p = of.at_the_wrist ? kAtTheWrist : kAtTheElbow;
  const auto make = [&] {
    std::vector<files::Override> overrides{{"systems.obstacles.obstacles.0.pose.xyz",
                                            fmt::format("[{}, {}, {}]", p.x(), p.y(), p.z())}};
    if (file == "dynamic_test") overrides.push_back({"parameters.obstacle_speed", "0"});
    // What it does not repulse, it merely slows: that cannot leave.
    if (of.method == "flacco") overrides.push_back({"parameters.repulsion", "all"});
    return MethodRun(file, of.method, overrides);
  };
  const systems::Proximity nearest = make().Nearest();
  p += (nearest.distance - of.distance) * nearest.normal;
  return make();
}

class ContactTest : public testing::TestWithParam<Case> {};

TEST_P(ContactTest, TheArmRetreatsUntilItIsClear) {
  MethodRun run = Start("dynamic_test", GetParam());
  double last = DistanceAt(run);
  ASSERT_NEAR(last, GetParam().distance, 1e-9);
  for (int k = 1; k <= 20; ++k) {
    run.AdvanceTo(0.1 * k);
    const double distance = DistanceAt(run);
    EXPECT_TRUE(last > 0.01 || distance > last + 1e-4) << k << ": " << last << " " << distance;
    last = distance;
  }
  EXPECT_GT(last, 0.02);
}

std::vector<Case> Cases() {
  std::vector<Case> cases;
  for (const std::string& method : Methods()) {
    if (method == "servo_scaling") continue;  // cannot evade: see below
    for (const bool at_the_wrist : {true, false}) {
      for (const double distance : {0.0, -0.02, -0.1}) {
        if (method == "flacco" && distance == -0.1) continue;  // see below
        cases.push_back({method, at_the_wrist, distance});
      }
    }
  }
  return cases;
}

std::string NameOf(const testing::TestParamInfo<Case>& of) {
  return fmt::format("{}_{}_{}mm", of.param.method, of.param.at_the_wrist ? "wrist" : "elbow",
                     std::lround(-1e3 * of.param.distance));
}

INSTANTIATE_TEST_SUITE_P(Methods, ContactTest, testing::ValuesIn(Cases()), NameOf);

// Deep inside, joints are held that would lead one link ever so little to the cube, though they led
// others out; and the request pulls back against a repulsion that is bounded.
TEST(FlaccoContactTest, FromDeepPenetrationTheArmRetreatsIfNotUntilItIsClear) {
  for (const bool at_the_wrist : {true, false}) {
    MethodRun run = Start("dynamic_test", {"flacco", at_the_wrist, -0.1});
    run.AdvanceTo(2.0);
    EXPECT_GT(DistanceAt(run), -0.097) << at_the_wrist;
  }
}

TEST(ServoScalingContactTest, TheArmStaysWhereItIsWhateverIsRequested) {
  for (const double distance : {0.0, -0.02, -0.1}) {
    MethodRun run = Start("static_test", {"servo_scaling", true, distance});
    ASSERT_NEAR(DistanceAt(run), distance, 1e-9);
    const Eigen::VectorXd start = run.Vector("plant", "position");
    run.AdvanceTo(8.0);
    EXPECT_GT((run.Vector("spline", "position") - start).norm(), 1.0);
    EXPECT_LT((run.Vector("plant", "position") - start).norm(), 1e-12) << distance;
  }
}

}  // namespace method_contact_test
}  // namespace oca::runs
