// SPDX-License-Identifier: BSD-3-Clause
// A robot's own loop at 1 kHz of the wall clock:  10_own_robot_loop [FILE [SECONDS]]
// Robot stands for your driver. What fails makes it hold still: the arm gets no velocity.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/control_loop.h"
#include "oca/systems/signals/signals.h"

using oca::systems::ObstacleSet;
using Clock = std::chrono::steady_clock;

struct Robot {
  Eigen::VectorXd q;
  void Move(const Eigen::Ref<const Eigen::VectorXd>& speed) { q += 0.001 * speed; }
};

int main(int argc, char** argv) try {
  const oca::loading::Blueprint file(argc > 1 ? argv[1] : "diagrams/first.yaml");
  const long ticks = std::lround(1000.0 * (argc > 2 ? std::atof(argv[2]) : 8.0));
  const std::vector<oca::files::Override> faster{{"parameters.rate", "1000"}};
  const auto whole = file.Build(faster);
  const auto part = file.Build(faster, {.part = oca::loading::InsideOf(*whole.diagram)});
  const auto joints = part.diagram->GetInput<oca::Vector>("plant.position");
  const auto camera = part.diagram->GetInput<ObstacleSet>("obstacles.obstacles");
  const auto command = part.diagram->GetOutput<oca::Vector>("servo.command");
  const oca::Context start = whole.diagram->MakeContext();
  Robot robot{whole.diagram->GetOutput<oca::Vector>("plant.position").Eval(start)};
  ObstacleSet scene = whole.diagram->GetOutput<ObstacleSet>("obstacles.obstacles").Eval(start);

  oca::ControlLoop loop(*part.diagram, oca::Period(1, 1000));
  loop.Watch(command);
  oca::Status status = loop.Set(joints, robot.q);
  if (status.ok()) status = loop.Set(camera, scene);
  if (status.ok()) loop.Initialize();
  long held = 0;
  std::chrono::duration<double, std::micro> worst{0};
  auto wake = Clock::now();
  for (long k = 0; k < ticks && status.ok(); ++k) {
    std::this_thread::sleep_until(wake += std::chrono::milliseconds(1));
    const auto woken = Clock::now();
    const double rise = 1e-5 * std::cos(0.001 * static_cast<double>(k));
    for (auto& obstacle : scene.obstacles) obstacle.X_WO.translation().z() += rise;
    const bool fine = loop.Set(joints, robot.q).ok() && loop.Set(camera, scene).ok() &&
                      (status = loop.Tick()).ok();
    if (fine) robot.Move(loop.Get(command));
    if (!fine) ++held;
    worst = std::max<decltype(worst)>(worst, Clock::now() - woken);
  }
  std::printf("%ld ticks of 1 ms, %ld held, the longest %.0f us; joint 1 at %.2f rad %s\n", ticks,
              held, worst.count(), robot.q[0], status.message());
  return held == 0 && status.ok() ? 0 : 1;
} catch (const std::exception& error) {  // only while setting up
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
