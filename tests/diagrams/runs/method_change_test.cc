// SPDX-License-Identifier: BSD-3-Clause
// What a change of the list of obstacles, or of the nearest feature of one, does to a motion.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "oca/models/robot/robot_model.h"
#include "tests/diagrams/runs/method_run.h"

namespace oca::runs {
namespace method_change_test {

std::string Ball(const std::string& id, const Eigen::Vector3d& p, const std::string& when = "") {
  return fmt::format(
      "{{id: {}, shape: {{type: sphere, radius: 0.1}}, pose: {{xyz: [{}, {}, {}]}}{}}}", id, p.x(),
      p.y(), p.z(), when);
}

std::vector<files::Override> Obstacles(const std::vector<std::string>& items) {
  return {{"systems.obstacles.obstacles", fmt::format("[{}]", fmt::join(items, ", "))}};
}

class ListTest : public testing::TestWithParam<std::string> {
 protected:
  /// Of static_test.yaml: positions of the joints, a column every 0.1 s.
  static Eigen::MatrixXd Motion(const std::vector<std::string>& obstacles) {
    std::vector<files::Override> overrides = Obstacles(obstacles);
    // The report's loop multiplies rounding by its gain at each tick; slower, it can be compared.
    if (GetParam().starts_with("report"))
      overrides.push_back({"parameters.relaxation_time", "0.3"});
    MethodRun run("static_test", GetParam(), overrides);
    Eigen::MatrixXd motion(7, 140);
    for (int k = 0; k < motion.cols(); ++k) {
      run.AdvanceTo(0.1 * (k + 1));
      motion.col(k) = run.Vector("plant", "position");
    }
    return motion;
  }
  static double Difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return (a - b).cwiseAbs().maxCoeff();
  }
  const Eigen::Vector3d low_{0.1, 0.6, 1.0};
  const Eigen::Vector3d high_{0.25, 0.5, 1.4};
};

TEST_P(ListTest, OrderAndNamesDoNotMatter) {
  const Eigen::MatrixXd motion = Motion({Ball("a", low_), Ball("b", high_)});
  EXPECT_LT(Difference(motion, Motion({Ball("c", high_), Ball("d", low_)})), 1e-9);
  EXPECT_GT(Difference(motion, Motion({Ball("a", low_)})), 1e-3);  // both balls do
  EXPECT_GT(Difference(motion, Motion({Ball("b", high_)})), 1e-3);
}

TEST_P(ListTest, WhatComesAndGoesFarAwayDoesNotMatter) {
  const std::string far = Ball("far", {0, 4, 1}, ", appear: 3.005, disappear: 6.123");
  const double difference = Difference(Motion({Ball("a", low_)}), Motion({far, Ball("a", low_)}));
  // The recommended method takes another look, and may find something better.
  EXPECT_LE(difference, GetParam() == "recommended" ? 0.1 : 0.0);
}

struct Scene {
  const char* name;
  std::vector<std::string> obstacles;
};

const std::vector<Scene>& Scenes() {
  static const std::vector<Scene> scenes{
      {"BallsComeAndGo",
       {Ball("a", {0.45, 0.3, 1.2}, ", appear: 0.2, disappear: 2.2"),
        Ball("b", {0.45, -0.19, 1.2}, ", appear: 1.2, disappear: 3.2")}},
      {"ABallAppearsInTheArm", {Ball("a", {0.45, 0.05, 1.2}, ", appear: 0.2, disappear: 2.2")}},
      {"ACubeTurnsBesideIt",  // 0.01 to 0.09 m away
       {"{id: cube, shape: {type: box, size: [0.2, 0.2, 0.2]}, pose: {xyz: [0.45, 0.25, 1.2]}, "
        "motion: {type: linear, velocity: [0, 0, 0], angular_velocity: [0, 0.5, 2]}}"}}};
  return scenes;
}

using Case = std::tuple<std::string, Scene>;

class JumpTest : public testing::TestWithParam<Case> {};

// The command moves on by no more than the largest joint speed does in a tick; what acceleration a
// method still asks for in excess, the motion limiter takes away.
TEST_P(JumpTest, NeitherWhatIsAskedNorWhatIsDoneJumps) {
  const auto& [method, scene] = GetParam();
  std::vector<files::Override> overrides = Obstacles(scene.obstacles);
  overrides.push_back({"parameters.limit_motion", "true"});
  overrides.push_back({"models.arm.acceleration_limits", "10"});
  MethodRun run("dynamic_test", method, overrides);
  const auto model = run.loaded().models.Get("arm");
  constexpr double kDt = 0.01;
  // Task priority bounds speeds by its damping, 0.5 m/s over 0.05 m/rad.
  const double alone = method == "task_priority" ? 10.0 : 2.0;
  const Eigen::VectorXd fastest = model->velocity_limits().cwiseMax(alone);
  const Eigen::VectorXd start = run.Vector("plant", "position");
  run.AdvanceTo(0.5 * kDt);
  Eigen::VectorXd asked = run.Vector("overlay", "position");
  Eigen::VectorXd sent = run.Vector("motion_limiter", "position");
  Eigen::VectorXd rate = (sent - start) / kDt;
  double evaded = 0.0;
  for (int k = 1; k <= 400; ++k) {
    run.AdvanceTo((k + 0.5) * kDt);
    const Eigen::VectorXd step = run.Vector("overlay", "position") - asked;
    ASSERT_TRUE((step.cwiseAbs().array() <= kDt * fastest.array() + 1e-9).all())
        << k << ": " << step.transpose() / kDt;
    const Eigen::VectorXd now = (run.Vector("motion_limiter", "position") - sent) / kDt;
    ASSERT_LE((now - rate).cwiseAbs().maxCoeff(), 10.0 * kDt + 1e-6) << k;
    asked += step;
    sent += kDt * now;
    rate = now;
    evaded = std::max(evaded, run.Vector("overlay", "applied_delta").cwiseAbs().maxCoeff());
  }
  EXPECT_TRUE(evaded > 1e-4 || method == "servo_scaling") << evaded;  // which has nothing to slow
}

INSTANTIATE_TEST_SUITE_P(Methods, ListTest, testing::ValuesIn(Methods()),
                         [](const auto& of) { return of.param; });
INSTANTIATE_TEST_SUITE_P(
    Methods, JumpTest, testing::Combine(testing::ValuesIn(Methods()), testing::ValuesIn(Scenes())),
    [](const auto& of) { return std::get<0>(of.param) + "_" + std::get<1>(of.param).name; });

}  // namespace method_change_test
}  // namespace oca::runs
