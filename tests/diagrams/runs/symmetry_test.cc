// SPDX-License-Identifier: BSD-3-Clause
// What is true of the world must not depend on where it stands: the arm and its box of
// static_test.yaml and dynamic_test.yaml, turned about z and moved together, or mirrored in the
// arm's plane. The box is tilted: where a link lies along a face, its nearest point is anybody's
// guess.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/diagrams/runs/method_run.h"

namespace oca::runs {
namespace symmetry_test {

using Eigen::Vector3d;

constexpr double kTurn = 0.7;  // rad
constexpr double kRoll = 0.2;
constexpr double kPitch = 0.1;
constexpr const char* kBox = "systems.obstacles.obstacles.0.pose";
constexpr const char* kTarget = "systems.spline.key_points.1.position";

/// A world that is moved, and mirrored for side = -1.
struct World {
  bool turned{false};
  double side{1.0};

  std::string Pose(const Vector3d& p, double roll, double pitch) const {
    Vector3d at(p.x(), side * p.y(), p.z());
    if (turned) at = Vector3d(1.3, -0.4, 0.2) + Eigen::AngleAxisd(kTurn, Vector3d::UnitZ()) * at;
    return fmt::format("{{xyz: [{}, {}, {}], rpy: [{}, {}, {}]}}", at.x(), at.y(), at.z(),
                       side * roll, pitch, turned ? kTurn : 0.0);
  }
  std::vector<files::Override> Overrides(const std::string& file) const {
    std::vector<files::Override> overrides{{"models.arm.base_pose", Pose({0, 0, 0.85}, 0, 0)}};
    if (file == "static_test") {
      overrides.push_back({kBox, Pose({0, 0.6, 1}, kRoll, kPitch)});
      overrides.push_back({kTarget, fmt::format("[{}, {}, {}, {}, 0, {}, 0]", side * 2.7, 1.48,
                                                side * -0.5, -0.61, 0.52)});
    } else {
      const double turn = turned ? kTurn * 180.0 / std::numbers::pi : 0.0;
      overrides.push_back({kBox, Pose({0.45, 1.2, 1.2}, kRoll, kPitch)});
      overrides.push_back({"parameters.obstacle_speed", "0.5"});
      overrides.push_back({"parameters.obstacle_azimuth", fmt::format("{}", turn - 90.0 * side)});
    }
    return overrides;
  }
};

struct Case {
  std::string method;
  std::string file;
};

/// To how many rad two worlds must show the same motion. Task priority inverts what is singular
/// where the tip leaves no freedom, and so magnifies rounding. The band searches in dynamic_test,
/// from random starts that know no mirror: relaxed they lead to the same way, but for what the last
/// step leaves open.
double Within(const Case& of) {
  if (of.method == "recommended" && of.file == "dynamic_test") return 1e-4;
  return of.method == "task_priority" && of.file == "dynamic_test" ? 1e-5 : 1e-9;
}

class SymmetryTest : public testing::TestWithParam<Case> {
 protected:
  /// Positions of the joints, a column every 0.1 s.
  Eigen::MatrixXd Motion(const World& world) {
    const auto& [method, file] = GetParam();
    std::vector<files::Override> overrides = world.Overrides(file);
    // The report's loop multiplies rounding by its gain at each tick; slower, it can be compared.
    if (method.starts_with("report") && file == "static_test") {
      overrides.push_back({"parameters.relaxation_time", "0.3"});
    }
    MethodRun run(file, method, overrides);
    Eigen::MatrixXd motion(7, file == "static_test" ? 140 : 50);
    for (int k = 0; k < motion.cols(); ++k) {
      run.AdvanceTo(0.1 * (k + 1));
      motion.col(k) = run.Vector("plant", "position");
      evaded_ = std::max(evaded_, run.Vector("overlay", "applied_delta").cwiseAbs().maxCoeff());
    }
    return motion;
  }
  double evaded_{0.0};  ///< rad
};

TEST_P(SymmetryTest, TheArmMovesTheSameInAWorldThatIsTurnedAndMoved) {
  const Eigen::MatrixXd motion = Motion({});
  EXPECT_GT(evaded_, 0.01);
  const Eigen::MatrixXd turned = Motion({.turned = true});
  EXPECT_LT((turned - motion).cwiseAbs().maxCoeff(), Within(GetParam()));
}

// The LWR 4 is its own mirror image in the xz plane, where joints 1, 3, 5 and 7 turn the other way.
// All arithmetic is mirrored with it, chaos too; see Within for the recommended method.
TEST_P(SymmetryTest, TheMirroredWorldMirrorsTheMotion) {
  const Eigen::MatrixXd motion = Motion({});
  Eigen::MatrixXd mirrored = Motion({.side = -1.0});
  EXPECT_GT((motion - mirrored).cwiseAbs().maxCoeff(), 1e-3);  // the side matters
  for (const int joint : {0, 2, 4, 6}) mirrored.row(joint) *= -1.0;
  EXPECT_LT((motion - mirrored).cwiseAbs().maxCoeff(), Within(GetParam()));
}

std::vector<Case> Cases() {
  std::vector<Case> cases;
  for (const std::string& method : Methods()) {
    cases.push_back({method, "static_test"});
    // What only slows a request does nothing where the arm should hold still.
    if (method != "servo_scaling") cases.push_back({method, "dynamic_test"});
  }
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Methods, SymmetryTest, testing::ValuesIn(Cases()),
                         [](const auto& of) { return of.param.method + "_" + of.param.file; });

}  // namespace symmetry_test
}  // namespace oca::runs
