// SPDX-License-Identifier: BSD-3-Clause
// A robot's own loop whose program hands over what is wrong:
//
//     case_control_loop obstacle KIND           one obstacle, by the method of the report
//     case_control_loop joint METHOD RADIANS    one joint read wrong for four ticks
//
// by diagrams/static_test.yaml of the tree that OCA_SOURCE names. Prints what Set and the tick say;
// a joint's run ends with the longest tick.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/control_loop.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/signals/signals.h"

namespace {

using oca::ControlLoop;
using oca::Status;
using oca::Vector;
using oca::systems::Obstacle;
using oca::systems::ObstacleSet;

std::string File() {
  const char* const source = std::getenv("OCA_SOURCE");
  return std::string(source == nullptr ? "." : source) + "/diagrams/static_test.yaml";
}

Obstacle Box(double x, const char* id) {
  oca::systems::ShapeParams shape;
  shape.type = oca::systems::ShapeType::kBox;
  shape.size = Eigen::Vector3d(0.4, 0.4, 0.4);
  Obstacle box;
  box.body = oca::systems::MakeObstacleBody(id, shape, "box");
  box.X_WO.translation() = Eigen::Vector3d(x, 0.0, 1.2);
  return box;
}

void Spoil(const std::string& kind, ObstacleSet& scene) {
  Obstacle& box = scene.obstacles[0];
  if (kind == "empty_body") scene.obstacles.resize(2);
  if (kind == "shapeless") box.body = std::make_shared<oca::systems::ObstacleBody>();
  if (kind == "zero_rotation") box.X_WO.linear().setZero();
  if (kind == "scaled") box.X_WO.linear() *= 0.1;
  if (kind == "sheared") box.X_WO.linear()(0, 1) = 1e-6;
  if (kind == "mirrored") box.X_WO.linear() *= -1.0;
  if (kind == "at_1e300") box.X_WO.translation().x() = 1e300;
  if (kind == "at_2e6") box.X_WO.translation().y() = -2e6;
  if (kind == "nan") box.angular.z() = std::nan("");
  if (kind == "fast") box.linear.x() = 1e300;
  if (kind == "twice") scene.obstacles.push_back(Box(2.0, "box"));
  if (kind == "nameless") scene.obstacles.push_back(Box(2.0, ""));
}

const char* Say(const Status& status) { return status.ok() ? "ok" : status.message(); }

int RunObstacle(const std::string& kind) {
  const std::vector<std::string> part{"kinematics", "distance",   "field",  "wrenches",
                                      "mapping",    "relaxation", "limiter"};
  const auto avoidance = oca::loading::Blueprint(File()).Build(
      {{"parameters.max_distance", "2"}, {"parameters.sensing_distance", "2"}}, {.part = part});
  const auto q = avoidance.diagram->GetInput<Vector>("plant.position");
  const auto obstacles = avoidance.diagram->GetInput<ObstacleSet>("obstacles.obstacles");
  const auto near =
      avoidance.diagram->GetOutput<oca::systems::ProximitySet>("distance.proximities");
  ControlLoop loop(*avoidance.diagram, oca::Period(1, 100));
  loop.Watch(near);
  ObstacleSet scene{{Box(0.9, "box")}};
  if (!loop.Set(q, Eigen::VectorXd::Zero(7)).ok() || !loop.Set(obstacles, scene).ok()) return 1;
  loop.Initialize();
  Spoil(kind, scene);
  std::printf("Set: %s\n", Say(loop.Set(obstacles, scene)));
  std::printf("Tick: %s\n", Say(loop.Tick()));
  double least = 1e9;
  for (const auto& p : loop.Get(near).proximities) least = std::min(least, p.distance);
  std::printf("nearest %.4f m\n", least);
  return 0;
}

int RunJoint(const std::string& method, double radians) {
  const std::vector<oca::files::Override> overrides{{"parameters.avoidance", method}};
  std::vector<std::string> part;
  const oca::loading::Blueprint blueprint(File());
  for (const auto& block : blueprint.Build(overrides).systems) {
    const bool outside = block.type == "IntegratorPlant" || block.type == "ObstacleSource" ||
                         block.type == "MotionMetrics" || block.type == "TipError";
    if (!outside) part.push_back(block.name);
  }
  const auto loaded = blueprint.Build(overrides, {.part = part});
  const auto q = loaded.diagram->GetInput<Vector>("plant.position");
  const auto obstacles = loaded.diagram->GetInput<ObstacleSet>("obstacles.obstacles");
  ControlLoop loop(*loaded.diagram, oca::Period(1, 100));
  loop.Watch(loaded.diagram->GetOutput<Vector>("servo.command"));
  for (const auto& input : loaded.diagram->inputs()) {
    if (input.type != &oca::kVectorType || input.name == "plant.position") continue;
    if (!loop.Set(loaded.diagram->GetInput<Vector>(input.name), Eigen::VectorXd::Zero(7)).ok()) {
      return 1;
    }
  }
  Eigen::VectorXd measured = Eigen::VectorXd::Zero(7);
  const ObstacleSet scene{{Box(0.6, "box")}};
  if (!loop.Set(q, measured).ok() || !loop.Set(obstacles, scene).ok()) return 1;
  loop.Initialize();
  using Clock = std::chrono::steady_clock;
  double worst = 0.0;
  for (int k = 0; k < 70; ++k) {
    measured[3] = k >= 60 && k < 64 ? radians : 0.0;
    const auto start = Clock::now();
    const Status set = loop.Set(q, measured);
    if (k == 60) std::printf("Set: %s\n", Say(set));
    const Status tick = loop.Tick();
    if (k == 60) std::printf("Tick: %s\n", Say(tick));
    worst = std::max(worst, std::chrono::duration<double>(Clock::now() - start).count());
  }
  std::printf("the longest tick: %.0f ms\n", 1e3 * worst);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  try {
    if (words.size() == 2 && words[0] == "obstacle") return RunObstacle(words[1]);
    if (words.size() == 3 && words[0] == "joint") return RunJoint(words[1], std::stod(words[2]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 64;
}
