// SPDX-License-Identifier: BSD-3-Clause
// How to embed the avoidance of a diagram file in a robot's own control loop:
// docs/how-to/embedding.md.
//
//     control_loop_example [FILE [SECONDS]] [-s PATH=VALUE]...
//
// Takes the place of the plant and of the camera: it pretends that the joints follow the commanded
// velocity exactly, and moves the obstacles. All else is the file's own, whatever its method of
// avoidance and however many joints its robot has. It runs at 1 kHz of the wall clock.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/control_loop.h"
#include "oca/systems/signals/roles.h"
#include "oca/systems/signals/signals.h"

namespace {

using oca::Status;
using oca::Vector;
using oca::files::Override;
using oca::systems::HoldsObstacles;
using oca::systems::Judges;
using oca::systems::ObstacleSet;
using oca::systems::Plant;

constexpr double kPeriod = 1e-3;  // s
constexpr const char* kUsage =
    "usage: control_loop_example [FILE [SECONDS]] [-s PATH=VALUE]...\n"
    "  FILE     a diagram file that includes parts/avoidance.yaml; diagrams/static_test.yaml if "
    "left"
    " out\n"
    "  SECONDS  from 0 to 1e6; 12 if left out\n"
    "  -s       as of `simulator run`, say parameters.avoidance=safety_filter\n";

struct Arguments {
  std::string file{"diagrams/static_test.yaml"};
  double seconds{12.0};
  std::vector<Override> overrides{{"parameters.rate", "1000"}};  // that of the loop
};

/// Whether the words make sense.
bool Read(const std::vector<std::string>& words, Arguments& arguments) {
  int place = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "-s" && i + 1 < words.size()) {
      arguments.overrides.push_back(Override::Parse(words[++i]));
    } else if (words[i].empty() || words[i].front() == '-' || place > 1) {
      return false;
    } else if (place++ == 0) {
      arguments.file = words[i];
    } else {
      char* end = nullptr;
      arguments.seconds = std::strtod(words[i].c_str(), &end);
      if (*end != '\0' || !(arguments.seconds >= 0.0 && arguments.seconds <= 1e6)) return false;
    }
  }
  return true;
}

/// The one system of a role. throws if there is not one.
template <class Role>
const Role& TheOne(const oca::loading::LoadedDiagram& whole, const char* what) {
  const auto found = whole.diagram->FindRoles<Role>();
  if (found.size() == 1) return *found[0].role;
  throw std::runtime_error(whole.file + ": systems; got " + std::to_string(found.size()) + " of " +
                           what + "; expected one");
}

/// The path of what drives an input.
std::string DriverOf(const oca::Diagram& whole, const oca::InputHandle& input) {
  if (const auto driver = whole.DriverOf(input)) return whole.PathOf(*driver);
  throw std::runtime_error(whole.PathOf(input) + ": driver; got none; expected one");
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
int Run(const Arguments& arguments) {
  // Read once: the whole file says where the joints and obstacles are, the part is what we run.
  const oca::loading::Blueprint blueprint(arguments.file);
  const auto whole = blueprint.Build(arguments.overrides);
  const oca::Diagram& all = *whole.diagram;
  const auto& plant = TheOne<Plant>(whole, "joints");
  const auto& camera = TheOne<HoldsObstacles>(whole, "obstacles");
  const auto& judge = TheOne<Judges>(whole, "judges");
  const auto part = blueprint.Build(arguments.overrides, {.part = oca::loading::InsideOf(all)});
  const oca::Diagram& diagram = *part.diagram;
  const auto measured = diagram.GetInput<Vector>(all.PathOf(plant.position));
  const auto obstacles = diagram.GetInput<ObstacleSet>(all.PathOf(camera.obstacles));
  const auto command = diagram.GetOutput<Vector>(DriverOf(all, plant.command));  // joint velocities
  const auto delta = diagram.GetOutput<Vector>(DriverOf(all, judge.delta));

  const oca::Context start_of_all = all.MakeContext();
  Eigen::VectorXd q = oca::Typed<Vector>(plant.position).Eval(start_of_all);
  const ObstacleSet first = oca::Typed<ObstacleSet>(camera.obstacles).Eval(start_of_all);
  ObstacleSet scene = first;

  oca::ControlLoop loop(diagram, oca::Period(1, 1000));
  loop.Watch(command);
  loop.Watch(delta);
  Guard guard;
  if (!guard.Fine(loop.Set(measured, q)) || !guard.Fine(loop.Set(obstacles, scene))) return 1;
  loop.Initialize();

  // From here on: no exception, no heap.
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto ticks = static_cast<long>(arguments.seconds / kPeriod);
  double worst = 0.0, total = 0.0, largest = 0.0;
  for (long k = 0; k < ticks; ++k) {
    const double t = static_cast<double>(k) * kPeriod;
    std::this_thread::sleep_until(start + std::chrono::microseconds(1000 * k));
    const auto woken = Clock::now();
    for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
      scene.obstacles[i].X_WO.translation().z() =
          first.obstacles[i].X_WO.translation().z() + 0.02 * std::sin(t);
    }
    if (guard.Fine(loop.Set(measured, q)) && guard.Fine(loop.Set(obstacles, scene)) &&
        guard.Fine(loop.Tick())) {
      q += kPeriod * loop.Get(command);
    }
    const double took = std::chrono::duration<double>(Clock::now() - woken).count();
    worst = std::max(worst, took);
    total += took;
    largest = std::max(largest, loop.Get(delta).lpNorm<Eigen::Infinity>());
  }
  std::printf(
      "%ld ticks of 1 ms, %ld joints; %.1f us each, the longest %.1f us; largest delta %.3f rad\n",
      ticks, static_cast<long>(q.size()), 1e6 * total / static_cast<double>(std::max(ticks, 1L)),
      1e6 * worst, largest);
  if (guard.failures() == 0) return 0;
  std::fprintf(stderr, "held still %ld times\n", guard.failures());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words == std::vector<std::string>{"--help"}) {
    std::fputs(kUsage, stdout);
    return 0;
  }
  try {
    Arguments arguments;
    if (Read(words, arguments)) return Run(arguments);
  } catch (const std::exception& error) {  // only while setting up
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  std::fputs(kUsage, stderr);
  return 64;
}
