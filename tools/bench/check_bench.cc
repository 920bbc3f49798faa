// SPDX-License-Identifier: BSD-3-Clause
//
// Rows planning/check/ARM: is a configuration clear, by BatchClearance, eight at once, of random
// ones within the joint limits, own links counted; its peer .../exact, the exact distances alone.
// Counters: `ns` for a configuration, `balls` that contain the links, `clear` share of
// configurations, `undecided` share that the balls left to the exact distances.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "oca/models/planning/batch_clearance.h"
#include "oca/models/random.h"
#include "oca/models/robot/urdf.h"

namespace oca::bench {
namespace {

constexpr int kLanes = planning::BatchClearance::kLanes;
constexpr int kBatches = 500;
constexpr int kBodies = 20;
constexpr double kMargin = 0.002;

std::shared_ptr<const robot::RobotModel> ArmNamed(const std::string& name) {
  const std::string folder = OCA_SOURCE_DIR "/models/robots/" + name + "/" + name;
  robot::LoadOptions options;
  options.srdf = folder + ".srdf";
  return std::make_shared<const robot::RobotModel>(robot::LoadUrdf(folder + ".urdf", options));
}

/// Boxes, cylinders and spheres of 0.1 to 0.4 m, 0.4 to 1.1 m from the arm's foot.
std::vector<robot::PlacedBody> Bodies(models::Random& random) {
  std::vector<robot::PlacedBody> bodies;
  for (int i = 0; i < kBodies; ++i) {
    const double a = random.Uniform(0.1, 0.4), b = random.Uniform(0.1, 0.4);
    const geometry::Shape shapes[] = {geometry::Box{{a, b, random.Uniform(0.1, 0.4)}},
                                      geometry::Cylinder{0.5 * a, b}, geometry::Sphere{0.5 * a}};
    robot::PlacedBody body{geometry::MakeCollider(shapes[i % 3], "bench")};
    const Eigen::Vector3d way(random.Uniform(-1.0, 1.0), random.Uniform(-1.0, 1.0),
                              random.Uniform(-0.2, 1.0));
    body.X_WO.translation() = random.Uniform(0.4, 1.1) * way.normalized();
    body.X_WO.rotate(Eigen::AngleAxisd(random.Uniform(-3.0, 3.0), Eigen::Vector3d::UnitZ()));
    bodies.push_back(body);
  }
  return bodies;
}

/// check(clearance, batch, q) returns a bit for each clear lane.
template <class Check>
void OverConfigurations(benchmark::State& state, const std::string& arm, const Check& check) {
  models::Random random(11);
  robot::Clearance clearance(ArmNamed(arm), true, Bodies(random));
  planning::BatchClearance batch(clearance);
  const robot::RobotModel& model = clearance.model();
  std::vector<Eigen::MatrixXd> configurations;
  for (int i = 0; i < kBatches; ++i) {
    Eigen::MatrixXd q(model.num_positions(), kLanes);
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      const Eigen::Index j = k % q.rows();
      q(k) = random.Uniform(model.lower_limits()[j], model.upper_limits()[j]);
    }
    configurations.push_back(q);
  }
  double clear = 0.0;
  for (auto _ : state) {
    for (const Eigen::MatrixXd& q : configurations) {
      clear += __builtin_popcount(check(clearance, batch, q));
    }
  }
  const double count = 1.0 * kBatches * kLanes * static_cast<double>(state.iterations());
  state.counters["ns"] =
      benchmark::Counter(1e-9 * count, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["clear"] = clear / count;
  state.counters["balls"] = batch.num_balls();
  if (batch.looked_at() > 0) {
    state.counters["undecided"] =
        static_cast<double>(batch.undecided()) / static_cast<double>(batch.looked_at());
  }
}

void Batch(benchmark::State& state, const std::string& arm) {
  OverConfigurations(state, arm, [](auto&, auto& batch, const Eigen::MatrixXd& q) {
    return batch.Clear(q, kLanes, kMargin);
  });
}

void Exact(benchmark::State& state, const std::string& arm) {
  OverConfigurations(state, arm, [](auto& clearance, auto&, const Eigen::MatrixXd& q) {
    unsigned clear = 0;
    for (int lane = 0; lane < kLanes; ++lane) {
      clearance.MoveTo(q.col(lane));
      if (!clearance.NearerThan(kMargin)) clear |= 1u << lane;
    }
    return clear;
  });
}

#define OCA_CHECK_ROWS(arm)                                          \
  BENCHMARK_CAPTURE(Batch, arm, #arm)->Name("planning/check/" #arm); \
  BENCHMARK_CAPTURE(Exact, arm, #arm)->Name("planning/check/" #arm "/exact")
OCA_CHECK_ROWS(lwr4);
OCA_CHECK_ROWS(ur5e);
OCA_CHECK_ROWS(iiwa14);

}  // namespace
}  // namespace oca::bench
