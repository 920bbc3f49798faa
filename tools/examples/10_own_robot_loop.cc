// SPDX-License-Identifier: BSD-3-Clause
// A robot's own loop at 1 kHz of the wall clock:  10_own_robot_loop [FILE [SECONDS]]
// Robot stands for your driver. What fails makes it hold still: the arm gets no velocity.
#include <Eigen/Core>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <thread>

#include "oca/diagrams/loading/blueprint.h"
#include "oca/framework/dataflow/control_loop.h"
#include "oca/systems/signals/signals.h"

using oca::systems::ObstacleSet;
struct Robot {
  Eigen::VectorXd q;
  void Move(const Eigen::Ref<const Eigen::VectorXd>& speed) { q += 0.001 * speed; }
};

int main(int argc, char** argv) try {
  const oca::loading::Blueprint file(argc > 1 ? argv[1] : "diagrams/first.yaml");
  const long ticks = std::lround(1000.0 * (argc > 2 ? std::atof(argv[2]) : 8.0));
  const auto whole = file.Build({{"parameters.rate", "1000"}});
  const auto part = file.Build(whole.overrides, {.part = oca::loading::InsideOf(*whole.diagram)});
  const auto joints = part.diagram->GetInput<oca::Vector>("plant.position");
  const auto camera = part.diagram->GetInput<ObstacleSet>("obstacles.obstacles");
  const auto command = part.diagram->GetOutput<oca::Vector>("servo.command");
  const oca::Context start = whole.diagram->MakeContext();
  Robot robot{whole.diagram->GetOutput<oca::Vector>("plant.position").Eval(start)};
  ObstacleSet scene = whole.diagram->GetOutput<ObstacleSet>("obstacles.obstacles").Eval(start);
  oca::ControlLoop loop(*part.diagram, oca::Period(1, 1000));
  loop.Watch(command);
  const auto sense = [&] {
    const oca::Status first = loop.Set(joints, robot.q);
    return first.ok() ? loop.Set(camera, scene) : first;
  };
  oca::Status failure = sense();
  if (failure.ok()) loop.Initialize();
  long held = 0;
  std::chrono::duration<double, std::micro> worst{0};
  auto wake = std::chrono::steady_clock::now();
  for (long k = 0; k < ticks; ++k) {
    std::this_thread::sleep_until(wake += std::chrono::milliseconds(1));
    for (auto& one : scene.obstacles) one.X_WO.translation().z() += 1e-5 * std::cos(0.001 * k);
    const oca::Status set = sense(), status = set.ok() ? loop.Tick() : set;
    if (status.ok()) robot.Move(loop.Get(command));
    if (!status.ok()) ++held;
    if (failure.ok()) failure = status;  // the first one is told
    worst = std::max<decltype(worst)>(worst, std::chrono::steady_clock::now() - wake);
  }
  std::printf("%ld ticks of 1 ms, %ld held, the longest %.0f us; joint 1 at %.2f rad %s\n", ticks,
              held, worst.count(), robot.q[0], failure.message());
  return failure.ok() ? 0 : 1;
} catch (const std::exception& error) {  // only while setting up
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
