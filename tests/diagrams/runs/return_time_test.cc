// SPDX-License-Identifier: BSD-3-Clause
// How soon an arm is back at its request once the way there is free: tasks of the tip, by the
// recommended method, past balls that stand, go away, and fly through.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "oca/models/random.h"
#include "oca/models/robot/clearance.h"
#include "tests/diagrams/runs/method_run.h"

namespace oca::runs {
namespace return_time_test {

using Eigen::VectorXd;

constexpr double kBack = 0.01;       // rad; of all joints: the arm is at its request
constexpr double kAway = 0.05;       // rad; of a joint: there is something to return from
constexpr double kPreferred = 0.12;  // m; what the method prefers to keep

/// What came of one run.
struct Returns {
  std::vector<double> times;  ///< s; of each return, see Meter
  double min_distance{robot::kUnlimited};
  double first_distance{0.0};
};

/// Measures returns tick by tick: an arm that has left its request is back when it is at the
/// request again. Its return takes from the first time from which on the straight motion of the
/// joints to the request keeps the preferred distance until it is back. Where no time is such, or
/// the arm was nearer than kAway by then, it came back as the way became free, and nothing is
/// measured.
class Meter {
 public:
  explicit Meter(MethodRun& run) : run_(run), clearance_(run.loaded().models.Get("arm")) {}

  Returns Measure() {
    run_.Initialize();
    Place();
    clearance_.MoveTo(run_.Vector("plant", "position"));
    returns_.first_distance = clearance_.Nearest().distance;
    if (returns_.first_distance < kPreferred) return std::move(returns_);
    const int ticks = static_cast<int>(std::lround(100.0 * run_.loaded().simulator.duration));
    for (int k = 1; k <= ticks; ++k) {
      run_.AdvanceTo(0.01 * k);
      Look(0.01 * k);
    }
    return std::move(returns_);
  }

 private:
  void Look(double time) {
    const VectorXd q = run_.Vector("plant", "position");
    const VectorXd wanted = run_.Vector("spline", "position");
    Place();
    clearance_.MoveTo(q);
    returns_.min_distance = std::min(returns_.min_distance, clearance_.Nearest(1.0).distance);
    const double away = (q - wanted).cwiseAbs().maxCoeff();
    if (away <= kBack) {
      if (free_since_ && away_then_ >= kAway) returns_.times.push_back(time - *free_since_);
      free_since_.reset();
    } else if (!Free(q, wanted)) {
      free_since_.reset();
    } else if (!free_since_) {
      free_since_ = time;
      away_then_ = away;
    }
  }

  void Place() {
    std::vector<robot::PlacedBody> bodies;
    for (const geometry::Obstacle& one :
         run_.Eval<systems::ObstacleSet>("obstacles", "obstacles").obstacles) {
      bodies.push_back({one.body->collider, one.X_WO});
    }
    clearance_.SetBodies(std::move(bodies));
  }

  bool Free(const VectorXd& from, const VectorXd& to) {
    constexpr int kPieces = 20;
    for (int i = 0; i <= kPieces; ++i) {
      clearance_.MoveTo(from + (to - from) * i / kPieces);
      if (clearance_.NearerThan(kPreferred)) return false;
    }
    return true;
  }

  MethodRun& run_;
  robot::Clearance clearance_;
  std::optional<double> free_since_;
  double away_then_{0.0};
  Returns returns_;
};

/// A ball on or beside the way of the tip of scenarios/task_line.yaml, or task_circle.yaml.
struct Ball {
  bool circle;
  enum class Kind { kStands, kGoesAway, kFlies } kind;
  int seed;
};

std::string TextOf(const Ball& ball) {
  models::Random random(models::Random::Seed(static_cast<std::uint64_t>(ball.seed), "returns"));
  const double share = random.Uniform(0.3, 0.7);  // of the way
  const double angle = 2.0 * 3.141592653589793 * share;
  const Eigen::Vector3d on_way =
      ball.circle ? Eigen::Vector3d(0.5, 0.25 * std::sin(angle), 0.35 + 0.25 * std::cos(angle))
                  : Eigen::Vector3d(0.1 + 0.75 * share, 0.0, 0.65 - 0.3 * share);
  const double radius = random.Uniform(0.05, 0.1);
  Eigen::Vector3d place =
      on_way + Eigen::Vector3d(0.0, random.Uniform(-0.08, 0.08), random.Uniform(-0.05, 0.05));
  const double there = 3.5 + 10.0 * share;  // s; when the tip is about there
  std::string more;
  if (ball.kind == Ball::Kind::kGoesAway) {
    more = fmt::format(", disappear: {}", there + random.Uniform(0.0, 2.0));
  } else if (ball.kind == Ball::Kind::kFlies) {
    const double speed = random.Uniform(0.15, 0.8);
    const double heading = random.Uniform(-3.14, 3.14);
    const Eigen::Vector3d velocity =
        speed *
        Eigen::Vector3d(0.3 * std::cos(heading), std::sin(heading), 0.5 * std::cos(heading));
    const double before = 2.0;  // s; from the start to the way
    place -= before * velocity;
    more = fmt::format(", motion: {{type: linear, velocity: [{}, {}, {}], start: {}}}, appear: {}",
                       velocity.x(), velocity.y(), velocity.z(), there - before, there - before);
  }
  return fmt::format(
      "[{{id: ball, shape: {{type: sphere, radius: {}}}, pose: {{xyz: [{}, {}, {}]}}{}}}]", radius,
      place.x(), place.y(), place.z(), more);
}

double MedianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST(ReturnTimeTest, IsASecondAtMostInTheMedianForTasksOfTheTip) {
  const char* const names[] = {"stands", "goes away", "flies"};
  for (const auto kind : {Ball::Kind::kStands, Ball::Kind::kGoesAway, Ball::Kind::kFlies}) {
    std::vector<double> times;
    double least = robot::kUnlimited;
    for (const bool circle : {false, true}) {
      for (int seed = 0, runs = 0; runs < 16 && seed < 80; ++seed) {
        MethodRun run(circle ? "scenarios/task_circle" : "scenarios/task_line", "recommended",
                      {{"systems.obstacles.obstacles", TextOf({circle, kind, seed})}});
        const Returns returns = Meter(run).Measure();
        if (returns.first_distance < kPreferred) continue;  // it starts at the arm
        ++runs;
        times.insert(times.end(), returns.times.begin(), returns.times.end());
        least = std::min(least, returns.min_distance);
      }
    }
    ASSERT_FALSE(times.empty());
    fmt::print("a ball that {}: {} returns, median {:.2f} s, longest {:.2f} s; nearest {:.4f} m\n",
               names[static_cast<int>(kind)], times.size(), MedianOf(times),
               *std::max_element(times.begin(), times.end()), least);
    EXPECT_LE(MedianOf(times), 1.0) << names[static_cast<int>(kind)];
    EXPECT_GT(least, 0.0) << names[static_cast<int>(kind)];
  }
}

}  // namespace return_time_test
}  // namespace oca::runs
