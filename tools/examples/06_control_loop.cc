// SPDX-License-Identifier: BSD-3-Clause
// The avoidance of a file, tick by tick, without a simulator:  06_control_loop [FILE]
#include <cstdio>
#include <exception>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/control_loop.h"
#include "oca/systems/signals/signals.h"

using oca::systems::ObstacleSet;

int main(int argc, char** argv) {
  try {
    // All but what stands for something outside: we take the place of the joints and the camera.
    const oca::loading::Blueprint file(argc > 1 ? argv[1] : "diagrams/first.yaml");
    const auto whole = file.Build();
    const auto part = file.Build({}, {.part = oca::loading::InsideOf(*whole.diagram)});
    const auto measured = part.diagram->GetInput<oca::Vector>("plant.position");
    const auto seen = part.diagram->GetInput<ObstacleSet>("obstacles.obstacles");
    const auto command = part.diagram->GetOutput<oca::Vector>("servo.command");  // rad/s

    const oca::Context start = whole.diagram->MakeContext();
    const auto plant = whole.diagram->GetOutput<oca::Vector>("plant.position");
    const auto camera = whole.diagram->GetOutput<ObstacleSet>("obstacles.obstacles");
    Eigen::VectorXd q = plant.Eval(start);
    const ObstacleSet& scene = camera.Eval(start);

    const oca::Period period(1, 100);
    oca::ControlLoop loop(*part.diagram, period);
    loop.Watch(command);
    if (!loop.Set(measured, q).ok() || !loop.Set(seen, scene).ok()) return 1;
    loop.Initialize();  // from here on no heap, no exception

    double speed = 0.0;
    while (loop.ticks() < 800) {
      if (const auto status = loop.Set(measured, q); !status.ok()) {
        std::fprintf(stderr, "%s\n", status.message());
        return 1;
      }
      if (const auto status = loop.Tick(); !status.ok()) {
        std::fprintf(stderr, "%s\n", status.message());
        return 1;
      }
      q += period.seconds() * loop.Get(command);  // the robot
      speed = loop.Get(command).lpNorm<Eigen::Infinity>();
    }
    std::printf("%ld ticks, joint 1 at %.2f rad, speed %.2f rad/s\n",
                static_cast<long>(loop.ticks()), q[0], speed);
  } catch (const std::exception& error) {  // only while setting up
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
