// SPDX-License-Identifier: BSD-3-Clause
// How to embed the avoidance of a diagram file in a robot's own control loop: docs/embedding.md.
//
//     control_loop_example [FILE [SECONDS]]
//
// Takes the place of everything around the avoidance: it asks for a motion, pretends that the
// joints follow exactly, and moves an obstacle. It runs at 1 kHz of the wall clock.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <thread>

#include "diagrams/loader.h"
#include "framework/control_loop.h"
#include "systems/signals.h"

namespace {

using oca::Status;
using oca::Vector;
using oca::systems::ObstacleSet;
using std::numbers::pi;

constexpr double kPeriod = 1e-3;  // s

/// The joints asked for at t, rad: joints 1 and 3 swing the arm through the box within 10 s.
void Request(double t, Eigen::VectorXd& q) {
  const double s = 0.5 - 0.5 * std::cos(pi * std::min(t / 10.0, 1.0));
  q << 1.75 * pi / 2 * s, 85.0 * pi / 180, -30.0 * pi / 180 * s, -35.0 * pi / 180, 0.0,
      30.0 * pi / 180, 0.0;
}

/// What a robot does about a failure is its own affair; here it holds still, and says why once.
class Guard {
 public:
  bool Fine(const Status& status) {
    if (!status.ok() && failures_++ == 0) {
      std::fprintf(stderr, "holding still: %s\n", status.message());
    }
    return status.ok();
  }
  long failures() const { return failures_; }

 private:
  long failures_{0};
};

/// Exit status: 0 if every tick went well.
int Run(const char* file, double seconds) {
  // Load once. The limiter and its like work at the loop's rate.
  const auto avoidance = oca::diagrams::LoadPart(
      file, {"kinematics", "distance", "field", "wrenches", "mapping", "relaxation", "limiter"},
      {{"parameters.rate", "1000"}, {"parameters.relaxation_time", "0.4"}});
  const oca::Diagram& diagram = *avoidance.diagram;
  const auto measured = diagram.GetInput<Vector>("plant_position");
  const auto obstacles = diagram.GetInput<ObstacleSet>("obstacles_obstacles");
  const auto delta = diagram.GetOutput<Vector>("limiter_limited_delta");

  ObstacleSet scene = oca::Signal<ObstacleSet>::ReadJson(
      R"([{"id": "box", "shape": {"type": "box", "size": [0.2, 0.2, 0.2]},
           "pose": {"xyz": [0, 0.6, 1.0]}}])");
  Eigen::VectorXd request(7), q(7);
  Request(0.0, request);
  q = request;

  oca::ControlLoop loop(diagram, oca::Period(1, 1000));
  loop.Watch(delta);
  Guard guard;
  if (!guard.Fine(loop.Set(measured, q)) || !guard.Fine(loop.Set(obstacles, scene))) return 1;
  loop.Initialize();

  // From here on: no exception, no heap.
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto ticks = static_cast<long>(seconds / kPeriod);
  double worst = 0.0, total = 0.0, largest = 0.0;
  for (long k = 0; k < ticks; ++k) {
    const double t = static_cast<double>(k) * kPeriod;
    std::this_thread::sleep_until(start + std::chrono::microseconds(1000 * k));
    const auto woken = Clock::now();
    scene.obstacles[0].X_WO.translation().z() = 1.0 + 0.02 * std::sin(t);
    if (guard.Fine(loop.Set(measured, q)) && guard.Fine(loop.Set(obstacles, scene)) &&
        guard.Fine(loop.Tick())) {
      Request(t, request);
      q = request + loop.Get(delta);  // the command; the joints follow it
    }
    const double took = std::chrono::duration<double>(Clock::now() - woken).count();
    worst = std::max(worst, took);
    total += took;
    largest = std::max(largest, loop.Get(delta).cwiseAbs().maxCoeff());
  }
  std::printf("%ld ticks of 1 ms; %.1f us each, the longest %.1f us; largest delta %.3f rad\n",
              ticks, 1e6 * total / static_cast<double>(std::max(ticks, 1L)), 1e6 * worst, largest);
  if (guard.failures() == 0) return 0;
  std::fprintf(stderr, "held still %ld times\n", guard.failures());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  char* end = nullptr;
  const double seconds = argc > 2 ? std::strtod(argv[2], &end) : 12.0;
  const bool usable = argc < 3 || (end != argv[2] && *end == '\0');
  if (argc > 3 || (argc > 1 && argv[1][0] == '-') || !usable ||
      !(seconds >= 0.0 && seconds <= 1e6)) {
    std::fprintf(stderr, "usage: control_loop_example [FILE [SECONDS]]; SECONDS from 0 to 1e6\n");
    return 64;
  }
  try {
    return Run(argc > 1 ? argv[1] : "diagrams/static_test.yaml", seconds);
  } catch (const std::exception& error) {  // only while setting up
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
