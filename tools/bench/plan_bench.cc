// SPDX-License-Identifier: BSD-3-Clause
//
// Rows planning/plan/N: what plans of an elastic band cost, one every 0.02 s for 4 s while the arm
// follows, among N bodies of which every other one moves: processor time `p50_us`, `p99_us` and
// `most_us` of the plans that are made, and `counted_us`, the most that their work counts as by
// planning::PlanPrices; `late`: plans that count as more than 0.02 s; `clear`: share of plans.
//
// Row planning/plan_cost: PlanPrices of this machine, counters `plan`, `band`, `exact` and `batch`
// in us: those with which the work of such plans comes nearest to the time that they take.

#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "oca/models/planning/band_replanner.h"
#include "oca/models/random.h"
#include "oca/models/robot/urdf.h"

namespace oca::bench {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kCourses = 10;
constexpr int kTicks = 200;
constexpr double kPlanPeriod = 0.02;  // s

struct PlanTaken {
  planning::PlanWork work;
  double seconds;
  double charged;
  bool clear;
};

double ProcessorTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

planning::ReplanSettings SettingsOfRecommended() {
  planning::ReplanSettings settings;
  settings.planner.most_evaluations = 4000;
  settings.plan_time = kPlanPeriod;
  settings.self_collision = true;
  return settings;
}

std::vector<geometry::Obstacle> BodiesOfCourse(models::Random& random, int count) {
  std::vector<geometry::Obstacle> bodies;
  for (int i = 0; i < count; ++i) {
    auto body = std::make_shared<geometry::ObstacleBody>();
    const std::string name = "body" + std::to_string(i);
    body->id = models::Name(name);
    const double size = random.Uniform(0.05, 0.12);
    body->collider =
        i % 3 == 0 ? geometry::MakeCollider(geometry::Sphere{size}, name)
                   : geometry::MakeCollider(geometry::Box{Vector3d::Constant(1.6 * size)}, name);
    geometry::Obstacle obstacle;
    obstacle.body = body;
    const double angle = random.Uniform(-3.1, 3.1), away = random.Uniform(0.45, 1.0);
    obstacle.X_WO.translation() =
        Vector3d(away * std::cos(angle), away * std::sin(angle), random.Uniform(0.1, 1.0));
    if (i % 2 == 1) {
      for (double& part : obstacle.linear) part = random.Uniform(-0.4, 0.4);
    }
    bodies.push_back(obstacle);
  }
  return bodies;
}

std::vector<PlanTaken> Course(std::uint64_t seed, int bodies) {
  static const auto model = [] {
    const std::string folder = OCA_SOURCE_DIR "/models/robots/lwr4/lwr4";
    robot::LoadOptions options;
    options.srdf = folder + ".srdf";
    options.acceleration_limits = VectorXd::Constant(1, 10.0);
    return std::make_shared<const robot::RobotModel>(robot::LoadUrdf(folder + ".urdf", options));
  }();
  models::Random random(seed);
  VectorXd start(7), goal(7);
  for (VectorXd* q : {&start, &goal}) {
    for (double& part : *q) part = random.Uniform(-1.2, 1.2);
  }
  const auto request = std::make_shared<const motion::Trajectory>(motion::Trajectory::CubicHermite(
      {{.time = 0.0, .position = start}, {.time = 3.0, .position = goal}}));
  auto obstacles = BodiesOfCourse(random, bodies);
  const planning::BandReplanner replanner(model, SettingsOfRecommended());
  planning::BandMemory memory;
  std::vector<PlanTaken> taken;
  for (int k = 0; k < kTicks; ++k) {
    const double time = kPlanPeriod * k;
    VectorXd measured = request->Evaluate(time, 0);
    if (!memory.At(time).empty()) memory.At(time).Add(time, 0, measured);
    const planning::BandSituation now{time, request, obstacles, measured};
    const auto plans = memory.report.plans + memory.report.overruns;
    const double begin = ProcessorTime();
    replanner.Plan(now, time + replanner.TimeToPlan(memory), std::nullopt, memory);
    const double seconds = ProcessorTime() - begin;
    if (memory.report.plans + memory.report.overruns > plans) {
      taken.push_back({memory.report.work, seconds, memory.report.charged, memory.report.clear});
    }
    for (geometry::Obstacle& obstacle : obstacles) {
      obstacle.X_WO.translation() += kPlanPeriod * obstacle.linear;
    }
  }
  return taken;
}

std::vector<PlanTaken> Courses(int bodies) {
  std::vector<PlanTaken> all;
  for (std::uint64_t seed = 0; seed < kCourses; ++seed) {
    const auto taken = Course(seed, bodies);
    all.insert(all.end(), taken.begin(), taken.end());
  }
  return all;
}

void Plans(benchmark::State& state) {
  std::vector<PlanTaken> all;
  for (auto _ : state) all = Courses(static_cast<int>(state.range(0)));
  std::vector<double> times;
  double counted = 0.0, clear = 0.0, late = 0.0;
  for (const PlanTaken& plan : all) {
    times.push_back(1e6 * plan.seconds);
    counted = std::max(counted, 1e6 * plan.charged);
    clear += plan.clear;
    late += plan.charged > kPlanPeriod;
  }
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times[static_cast<std::size_t>(share * static_cast<double>(times.size() - 1))];
  };
  state.counters["p50_us"] = at(0.5);
  state.counters["p99_us"] = at(0.99);
  state.counters["max_us"] = times.back();
  state.counters["counted_us"] = counted;
  state.counters["plans"] = static_cast<double>(times.size());
  state.counters["late"] = late;
  state.counters["clear"] = clear / static_cast<double>(times.size());
}

/// Least squares of shares of the times, none of the prices below 0.
void Prices(benchmark::State& state) {
  std::vector<PlanTaken> all;
  for (auto _ : state) {
    all = Courses(10);
    const auto more = Courses(20);
    all.insert(all.end(), more.begin(), more.end());
  }
  Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
  Eigen::Vector4d b = Eigen::Vector4d::Zero();
  for (const PlanTaken& plan : all) {
    const planning::PlanWork& work = plan.work;
    const Eigen::Vector4d row =
        Eigen::Vector4d(static_cast<double>(work.plans), work.band, work.exact, work.batches) /
        plan.seconds;
    A += row * row.transpose();
    b += row;
  }
  std::vector<int> kept{0, 1, 2, 3};
  Eigen::Vector4d prices = Eigen::Vector4d::Zero();
  while (!kept.empty()) {
    const Eigen::MatrixXd part = A(kept, kept);
    const Eigen::VectorXd found = part.ldlt().solve(Eigen::VectorXd(b(kept)));
    Eigen::Index least = 0;
    if (found.minCoeff(&least) >= 0.0) {
      prices(kept) = found;
      break;
    }
    kept.erase(kept.begin() + least);
  }
  state.counters["plan"] = 1e6 * prices[0];
  state.counters["band"] = 1e6 * prices[1];
  state.counters["exact"] = 1e6 * prices[2];
  state.counters["batch"] = 1e6 * prices[3];
}

BENCHMARK(Plans)
    ->Name("planning/plan")
    ->Arg(10)
    ->Arg(20)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Prices)->Name("planning/plan_cost")->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace oca::bench
