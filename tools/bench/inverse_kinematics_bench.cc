// SPDX-License-Identifier: BSD-3-Clause
//
// Rows geometry/inverse_kinematics/ARM: the joint positions of 10,000 poses that the arm reaches,
// the same every time, from one posture. Counters: `reached`, the share within 1e-6 m and 1e-6
// rad, and of the single times the `median` and the `slowest` (us).

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "oca/models/robot/inverse_kinematics.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "tools/bench/bench_scene.h"

namespace oca::bench {
namespace {

constexpr int kPoses = 10000;

void InverseKinematics(benchmark::State& state, const std::string& arm) {
  const robot::RobotModel model =
      robot::LoadUrdf(OCA_SOURCE_DIR "/models/robots/" + arm + "/" + arm + ".urdf");
  const int tip = robot::TipLink(model);
  std::vector<Eigen::Isometry3d> poses;
  for (const Eigen::VectorXd& q : RandomConfigurations(model, kPoses)) {
    poses.push_back(robot::LinkPoses(model, q)[tip]);
  }
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(model.num_positions(), 0.3);
  std::vector<double> times;
  int reached = 0;
  using Clock = std::chrono::steady_clock;
  for (auto _ : state) {
    const Eigen::Isometry3d& X_WG = poses[times.size() % poses.size()];
    const Clock::time_point begin = Clock::now();
    const auto found = robot::SolveInverseKinematics(model, tip, X_WG, start);
    times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
    if (found.reached) ++reached;
  }
  std::sort(times.begin(), times.end());
  state.counters["reached"] = reached / static_cast<double>(times.size());
  state.counters["median"] = times[times.size() / 2];
  state.counters["slowest"] = times.back();
}

BENCHMARK_CAPTURE(InverseKinematics, lwr4, "lwr4")
    ->Name("geometry/inverse_kinematics/lwr4")
    ->Iterations(kPoses);
BENCHMARK_CAPTURE(InverseKinematics, iiwa14, "iiwa14")
    ->Name("geometry/inverse_kinematics/iiwa14")
    ->Iterations(kPoses);
BENCHMARK_CAPTURE(InverseKinematics, ur5e, "ur5e")
    ->Name("geometry/inverse_kinematics/ur5e")
    ->Iterations(kPoses);

}  // namespace
}  // namespace oca::bench
