// SPDX-License-Identifier: BSD-3-Clause
//
// The whole control tick: rows control/tick/N/primitives|meshes run diagrams/static_test.yaml, as
// it is but for N obstacles of its own, sensed up to 0.3 m as in the report. Each stands beside
//
//   .../fcl_kdl       the same chain written plainly on FCL, KDL and a singular value
//                     decomposition, every pair measured, as in the report's program
//   .../fcl_kdl_cull  with the pairs left out whose bounding balls are beyond 0.3 m
//
// and control/latency/N reports the distribution over 10^6 ticks.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <kdl/utilities/svd_eigen_HH.hpp>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/simulation/simulator.h"
#include "tools/bench/allocation_counter.h"
#include "tools/bench/bench_scene.h"
#include "tools/bench/fcl_bodies.h"
#include "tools/bench/kdl_arm.h"

namespace oca::bench {
namespace {

constexpr double kMaxDistance = 0.3;  // m
constexpr double kPeriod = 0.01;      // s
constexpr int kLoop = 1000;           // ticks of a run, which then starts again

loading::LoadedDiagram LoadLoop(int obstacle_count, bool meshes) {
  std::vector<files::Override> overrides{
      {"parameters.sensing_distance", fmt::format("{}", kMaxDistance)},
      {"systems.obstacles.obstacles", ToYaml(MakeObstacles(*PrimitiveArm(), obstacle_count))}};
  if (meshes) overrides.push_back({"models.arm.urdf", "package://lwr4/lwr4_meshes.urdf"});
  return loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/static_test.yaml", overrides);
}

/// Runs the loop tick by tick, from the start again every 10 s of its time.
class Loop {
 public:
  Loop(int obstacle_count, bool meshes)
      : loaded_(LoadLoop(obstacle_count, meshes)),
        simulator_(*loaded_.diagram, loaded_.simulator.integration),
        start_(Initialized(simulator_)) {
    for (int i = 0; i < kLoop; ++i) Tick();  // warm-up
  }
  void Tick() {
    if (tick_ == kLoop) {
      simulator_.context() = start_;
      tick_ = 0;
    }
    simulator_.AdvanceTo(kPeriod * static_cast<double>(++tick_));
  }

 private:
  static Context Initialized(Simulator& simulator) {
    simulator.Initialize();
    return simulator.context();
  }
  loading::LoadedDiagram loaded_;
  Simulator simulator_;
  Context start_;
  int tick_{0};
};

void ControlTick(benchmark::State& state, int obstacle_count, bool meshes) {
  Loop loop(obstacle_count, meshes);
  const AllocationCounter allocations(state);
  for (auto _ : state) loop.Tick();
}

void Latency(benchmark::State& state, int obstacle_count, bool meshes) {
  Loop loop(obstacle_count, meshes);
  constexpr std::size_t kTicks = 1'000'000;
  std::vector<double> microseconds(kTicks);
  for (auto _ : state) {
    for (double& duration : microseconds) {
      const auto start = std::chrono::steady_clock::now();
      loop.Tick();
      duration =
          1e6 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }
  }
  std::sort(microseconds.begin(), microseconds.end());
  const auto at = [&](double share) {
    return microseconds[static_cast<std::size_t>(share * (kTicks - 1))];
  };
  state.counters["p50_us"] = at(0.5);
  state.counters["p99_us"] = at(0.99);
  state.counters["p99.9_us"] = at(0.999);
  state.counters["max_us"] = at(1.0);
}

/// The report's chain without a framework.
class PlainChain {
 public:
  PlainChain(std::shared_ptr<const robot::RobotModel> arm, int obstacle_count, bool cull)
      : arm_(std::move(arm)),
        kdl_(*arm_),
        fcl_(MovableLinks(*arm_), ToSet(MakeObstacles(*PrimitiveArm(), obstacle_count)),
             kMaxDistance, cull),
        w_(6 * arm_->num_bodies()),
        U_(w_.size(), arm_->num_positions()),
        V_(arm_->num_positions(), arm_->num_positions()),
        S_(arm_->num_positions()),
        work_(arm_->num_positions()),
        delta_(arm_->num_positions()),
        limited_(Eigen::VectorXd::Zero(arm_->num_positions())) {}

  void Tick(const Eigen::VectorXd& request) {
    kdl_.Calc(request + limited_);
    w_.setZero();
    for (const systems::Proximity& p : fcl_.Calc(kdl_.poses())) {
      if (p.distance > kMaxDistance) continue;
      const double rho = std::max(p.distance, 1e-3);
      const Eigen::Vector3d force = (1.0 / rho - 1.0 / kMaxDistance) / (rho * rho) * p.normal;
      const int body = arm_->body_index(arm_->FindLink(p.link.text()));
      const Eigen::Vector3d origin =
          kdl_.poses()[static_cast<std::size_t>(arm_->bodies()[body])].translation();
      w_.segment<3>(6 * body) += force;
      w_.segment<3>(6 * body + 3) += (p.point_on_link - origin).cross(force);
    }
    KDL::svd_eigen_HH(kdl_.jacobian(), U_, S_, V_, work_);
    work_.noalias() = U_.transpose() * w_;
    for (int k = 0; k < work_.size(); ++k) work_[k] = S_[k] > 1e-9 ? work_[k] / S_[k] : 0.0;
    delta_.noalias() = V_ * work_;
    const double step = 0.6 * kPeriod;
    limited_ += (delta_ - limited_).cwiseMax(-step).cwiseMin(step);
  }

 private:
  static std::vector<systems::LinkCollider> MovableLinks(const robot::RobotModel& arm) {
    auto links = systems::MakeLinkColliders(arm);
    std::erase_if(links, [&](const auto& link) { return arm.body(link.number) < 0; });
    return links;
  }
  std::shared_ptr<const robot::RobotModel> arm_;
  KdlArm kdl_;
  FclScene fcl_;
  Eigen::VectorXd w_;
  Eigen::MatrixXd U_, V_;
  Eigen::VectorXd S_, work_, delta_, limited_;
};

void PlainTick(benchmark::State& state, int obstacle_count, bool meshes, bool cull) {
  PlainChain chain(meshes ? OwnMeshArm() : PrimitiveArm(), obstacle_count, cull);
  const auto path = PathConfigurations(kLoop);
  std::size_t i = 0;
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    i = i + 1 == path.size() ? 0 : i + 1;
    chain.Tick(path[i]);
  }
}

void RegisterControl() {
  using benchmark::RegisterBenchmark;
  for (const bool meshes : {false, true}) {
    for (const int n : {1, 10, 100, 1000}) {
      const std::string kind = fmt::format("{}/{}", n, meshes ? "meshes" : "primitives");
      const std::string tick = "control/tick/" + kind;
      RegisterBenchmark(tick.c_str(), [=](auto& state) { ControlTick(state, n, meshes); });
      RegisterBenchmark((tick + "/fcl_kdl").c_str(),
                        [=](auto& state) { PlainTick(state, n, meshes, false); });
      RegisterBenchmark((tick + "/fcl_kdl_cull").c_str(),
                        [=](auto& state) { PlainTick(state, n, meshes, true); });
      RegisterBenchmark(("control/latency/" + kind).c_str(),
                        [=](auto& state) { Latency(state, n, meshes); })
          ->Iterations(1)
          ->Unit(benchmark::kMillisecond);
    }
  }
}

const bool kControlRegistered = (RegisterControl(), true);

}  // namespace
}  // namespace oca::bench
