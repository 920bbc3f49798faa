// SPDX-License-Identifier: BSD-3-Clause
//
// Rows geometry/kinematics (all link poses and the stacked 42 x 7 Jacobian), geometry/poses (what
// a tick needs of it) and geometry/mapping/METHOD, with their peers .../kdl: KDL's solvers as the
// report calls them, and its singular value decomposition.

#include <benchmark/benchmark.h>

#include <kdl/utilities/svd_eigen_HH.hpp>

#include "oca/models/robot/jacobian_mapping.h"
#include "oca/models/robot/kinematics.h"
#include "tools/bench/allocation_counter.h"
#include "tools/bench/bench_scene.h"
#include "tools/bench/kdl_arm.h"

namespace oca::bench {
namespace {

constexpr int kArmConfigurations = 1000;

template <class Calc>
void OverPath(benchmark::State& state, const Calc& calc) {
  const auto path = PathConfigurations(kArmConfigurations);
  std::size_t i = 0;
  const AllocationCounter allocations(state);
  for (auto _ : state) {
    i = i + 1 == path.size() ? 0 : i + 1;
    calc(path[i], i);
  }
}

void Poses(benchmark::State& state) {
  const auto arm = PrimitiveArm();
  std::vector<Eigen::Isometry3d> X_WL(arm->links().size());
  OverPath(state, [&](const Eigen::VectorXd& q, std::size_t) {
    robot::ForwardKinematics(*arm, q, X_WL);
    benchmark::DoNotOptimize(X_WL.data());
    benchmark::ClobberMemory();
  });
}

void Kinematics(benchmark::State& state) {
  const auto arm = PrimitiveArm();
  std::vector<Eigen::Isometry3d> X_WL(arm->links().size());
  Eigen::MatrixXd J(6 * arm->num_bodies(), arm->num_positions());
  OverPath(state, [&](const Eigen::VectorXd& q, std::size_t) {
    robot::ForwardKinematics(*arm, q, X_WL);
    robot::StackedJacobian(*arm, X_WL, J);
    benchmark::DoNotOptimize(J.data());
    benchmark::ClobberMemory();
  });
}

void KdlKinematics(benchmark::State& state) {
  const auto arm = PrimitiveArm();
  KdlArm kdl(*arm);
  OverPath(state, [&](const Eigen::VectorXd& q, std::size_t) {
    kdl.Calc(q);
    benchmark::DoNotOptimize(kdl.jacobian().data());
  });
}

/// Wrenches on the last two bodies, as one obstacle near the hand causes.
std::vector<robot::BodyWrench> SomeWrenches(const robot::RobotModel& arm) {
  std::vector<robot::BodyWrench> wrenches(arm.bodies().size());
  const std::size_t n = wrenches.size();
  wrenches[n - 1] = {Eigen::Vector3d(1.0, 2.0, -1.0), Eigen::Vector3d(0.1, 0.0, 0.2)};
  wrenches[n - 2] = {Eigen::Vector3d(0.5, 0.0, -1.0), Eigen::Vector3d(0.0, 0.3, 0.1)};
  return wrenches;
}

void Mapping(benchmark::State& state, robot::MappingMethod method) {
  const auto arm = PrimitiveArm();
  const auto wrenches = SomeWrenches(*arm);
  std::vector<std::vector<Eigen::Isometry3d>> poses;
  for (const auto& q : PathConfigurations(kArmConfigurations)) {
    poses.push_back(robot::LinkPoses(*arm, q));
  }
  robot::MappingWorkspace workspace(*arm);
  Eigen::VectorXd delta(arm->num_positions());
  OverPath(state, [&](const Eigen::VectorXd&, std::size_t i) {
    robot::MapWrenches(*arm, poses[i], wrenches, {method, 1.0, 0.1}, workspace, delta);
    benchmark::DoNotOptimize(delta.data());
    benchmark::ClobberMemory();
  });
}

void KdlMapping(benchmark::State& state) {
  const auto arm = PrimitiveArm();
  const auto wrenches = SomeWrenches(*arm);
  Eigen::VectorXd w(6 * arm->num_bodies());
  for (int b = 0; b < arm->num_bodies(); ++b) {
    w.segment<3>(6 * b) = wrenches[static_cast<std::size_t>(b)].force;
    w.segment<3>(6 * b + 3) = wrenches[static_cast<std::size_t>(b)].torque;
  }
  KdlArm kdl(*arm);
  std::vector<Eigen::MatrixXd> jacobians;
  for (const auto& q : PathConfigurations(kArmConfigurations)) {
    kdl.Calc(q);
    jacobians.push_back(kdl.jacobian());
  }
  const int n = arm->num_positions();
  Eigen::MatrixXd U(w.size(), n), V(n, n);
  Eigen::VectorXd S(n), work(n), delta(n);
  OverPath(state, [&](const Eigen::VectorXd&, std::size_t i) {
    KDL::svd_eigen_HH(jacobians[i], U, S, V, work);
    work.noalias() = U.transpose() * w;
    for (int k = 0; k < n; ++k) work[k] = S[k] > 1e-9 ? work[k] / S[k] : 0.0;
    delta.noalias() = V * work;
    benchmark::DoNotOptimize(delta.data());
  });
}

BENCHMARK(Poses)->Name("geometry/poses");
BENCHMARK(Kinematics)->Name("geometry/kinematics");
BENCHMARK(KdlKinematics)->Name("geometry/kinematics/kdl");
BENCHMARK_CAPTURE(Mapping, t, robot::MappingMethod::kTranspose)->Name("geometry/mapping/transpose");
BENCHMARK_CAPTURE(Mapping, p, robot::MappingMethod::kPseudoInverse)
    ->Name("geometry/mapping/pseudo_inverse");
BENCHMARK_CAPTURE(Mapping, d, robot::MappingMethod::kDamped)->Name("geometry/mapping/damped");
BENCHMARK(KdlMapping)->Name("geometry/mapping/pseudo_inverse/kdl");

}  // namespace
}  // namespace oca::bench
