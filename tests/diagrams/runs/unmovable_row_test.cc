// SPDX-License-Identifier: BSD-3-Clause
// A thing beside the first link, which turns about its own axis, is near for good: no joint moves
// that distance, but for rounding. It takes nothing from what the arm can do about the rest.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "oca/systems/signals/filter_activity.h"
#include "oca/systems/signals/signals.h"
#include "tests/diagrams/runs/method_run.h"

namespace oca::runs {
namespace unmovable_row_test {

using Eigen::Vector3d;

struct Scene {
  std::string name;
  std::string file;
  std::string others;  ///< the file's own obstacles, YAML
  Vector3d beside;     ///< m; somewhere beside the first link
  std::vector<files::Override> overrides{};
  bool round{true};  ///< the first link, about its axis
};

const Scene kScenes[] = {
    {"lwr4",
     "static_test",
     "{id: box, shape: {type: box, size: [0.2, 0.2, 0.2]}, pose: {xyz: [0, 0.6, 1]}}",
     {-0.1, -0.3, 1.0}},
    {"lwr4_meshes",
     "static_test",
     "{id: box, shape: {type: box, size: [0.2, 0.2, 0.2]}, pose: {xyz: [0, 0.6, 1]}}",
     {-0.1, -0.3, 1.0},
     {{"parameters.arm_meshes", "true"}},
     false},
    {"iiwa14",
     "iiwa14_arm",
     "{id: box, shape: {type: box, size: [0.2, 0.2, 0.2]}, pose: {xyz: [0, 0.75, 0.2]}}",
     {-0.2, -0.12, 0.12}},
    {"ur5e",
     "ur5e_arm",
     "{id: box, shape: {type: box, size: [0.2, 0.2, 0.2]}, pose: {xyz: [0, -0.6, 0.3]}}",
     {0.1, 0.2, 0.1}},
    {"planar3",
     "planar_arm",
     "{id: disc, shape: {type: cylinder, radius: 0.1, length: 0.1}, pose: {xyz: [0.9, 0.8, 0]}}",
     {-0.3, 0, 0}},
    {"ur5e_self",
     "ur5e_arm",
     "{id: box, shape: {type: box, size: [0.2, 0.2, 0.2]}, pose: {xyz: [0, -0.6, 0.3]}}",
     {0.1, 0.2, 0.1},
     {{"parameters.self_collision", "true"}}},
    {"iiwa14_self",
     "iiwa14_arm",
     "{id: box, shape: {type: box, size: [0.2, 0.2, 0.2]}, pose: {xyz: [0, 0.75, 0.2]}}",
     {-0.2, -0.12, 0.12},
     {{"parameters.self_collision", "true"}}},
    {"lwr4_moving",
     "dynamic_test",
     "{id: cube, shape: {type: box, size: [0.2, 0.2, 0.2]}, pose: {xyz: [0.45, 1.2, 1.2]}, "
     "motion: {type: linear, velocity: [0, -0.2, 0], start: 0.5, stop: 12.5}}",
     {-0.1, -0.3, 1.0}},
};

struct Case {
  Scene scene;
  std::string method;
};

class UnmovableRowTest : public testing::TestWithParam<Case> {
 protected:
  static MethodRun Make(const std::string& extra) {
    const auto& [scene, method] = GetParam();
    std::vector<files::Override> overrides = scene.overrides;
    overrides.push_back(
        {"systems.obstacles.obstacles", fmt::format("[{}{}]", scene.others, extra)});
    return MethodRun(scene.file, method, overrides);
  }
  static std::string Ball(const Vector3d& p) {
    return fmt::format(
        ", {{id: ball, shape: {{type: sphere, radius: 0.02}}, pose: {{xyz: [{}, {}, {}]}}}}", p.x(),
        p.y(), p.z());
  }
  static const systems::Proximity& FirstToBall(const MethodRun& run) {
    const auto& all = run.Eval<systems::ProximitySet>("distance", "proximities").proximities;
    const auto found = std::find_if(all.begin(), all.end(), [](const auto& proximity) {
      return proximity.obstacle == models::Name("ball");
    });
    if (found == all.end()) throw std::out_of_range("ball: got none; expected one near");
    return *found;
  }
  /// The least distance of each tick to all but the ball, over the whole run.
  static double Least(MethodRun& run) {
    double least = 1.0;
    for (int k = 0; k < 1400; ++k) {
      run.AdvanceTo(0.01 * k);
      for (const auto& proximity :
           run.Eval<systems::ProximitySet>("distance", "proximities").proximities) {
        if (proximity.obstacle != models::Name("ball")) {
          least = std::min(least, proximity.distance);
        }
      }
    }
    return least;
  }
};

TEST_P(UnmovableRowTest, TakesNothingFromTheRest) {
  Vector3d p = GetParam().scene.beside;
  {
    const MethodRun probe = Make(Ball(p));
    const systems::Proximity& first = FirstToBall(probe);
    p += (first.distance - 0.03) * first.normal;
  }
  MethodRun with = Make(Ball(p));
  ASSERT_NEAR(FirstToBall(with).distance, 0.03, 2e-3);
  MethodRun without = Make("");
  const double alone = Least(without);
  const double beside = Least(with);
  if (alone > 0.0) {
    EXPECT_GT(beside, 0.0) << "alone " << alone;
  } else {
    // These baselines give way to what comes: servo_scaling cannot evade, flacco creeps on.
    EXPECT_TRUE(GetParam().method == "servo_scaling" || GetParam().method == "flacco");
    EXPECT_GT(beside, alone - 0.01);
  }
  if (GetParam().method != "safety_filter" || !GetParam().scene.round) return;
  const auto& activity = with.Eval<systems::FilterActivity>("filter", "activity");
  const auto end = activity.bounds.begin() + activity.num_bounds;
  EXPECT_TRUE(std::any_of(activity.bounds.begin(), end, [](const auto& bound) {
    return bound.kind == systems::FilterBound::Kind::kUnmovable &&
           bound.obstacle == models::Name("ball");
  }));
}

std::vector<Case> Cases() {
  std::vector<Case> cases;
  for (const Scene& scene : kScenes) {
    for (const std::string& method : Methods()) cases.push_back({scene, method});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Arms, UnmovableRowTest, testing::ValuesIn(Cases()), [](const auto& of) {
  return of.param.scene.name + "_" + of.param.method;
});

}  // namespace unmovable_row_test
}  // namespace oca::runs
