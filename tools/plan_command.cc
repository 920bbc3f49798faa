// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "diagrams/loader.h"
#include "framework/error.h"
#include "framework/port_access.h"
#include "models/planning/clairvoyant.h"
#include "systems/request_ahead.h"
#include "systems/signals.h"
#include "tools/commands.h"

namespace oca::tools {
namespace {

using Eigen::VectorXd;

/// What the systems `spline` and `obstacles` of a loaded file say about all its time.
class Script {
 public:
  explicit Script(const diagrams::LoadedDiagram& loaded)
      : context_(loaded.diagram->MakeContext()),
        ahead_{Port(loaded, "spline", "ahead")},
        obstacles_{Port(loaded, "obstacles", "obstacles")} {
    request_ = ahead_.Eval(context_).trajectory;
    const double duration = loaded.simulator.duration;
    for (int k = 0; k * kStep <= duration; ++k) Look(k * kStep);
  }

  const systems::Trajectory& request() const { return *request_; }

  std::vector<models::BandBody> Bodies() {
    std::vector<models::BandBody> bodies;
    for (const auto& [body, moves] : seen_) {
      bodies.push_back({body->id, body->collider,
                        [this, body](double time) { return PoseOf(*body, time); }, !moves});
    }
    return bodies;
  }

 private:
  static constexpr double kStep = 0.05;  // s, at which the script is searched for bodies

  static OutputHandle Port(const diagrams::LoadedDiagram& loaded, const char* system,
                           const char* port) {
    const System* const found = loaded.diagram->FindSystem(system);
    if (found == nullptr) {
      throw ConfigError(
          fmt::format("{}: no system of that name; expected one with the output {}", system, port));
    }
    return found->FindOutput(port);
  }
  void Look(double time) {
    context_.SetTime(time);
    for (const systems::Obstacle& obstacle : obstacles_.Eval(context_).obstacles) {
      const auto same = std::find_if(seen_.begin(), seen_.end(), [&](const auto& entry) {
        return entry.first == obstacle.body;
      });
      const bool moves = obstacle.linear.norm() + obstacle.angular.norm() > 0.0;
      if (same == seen_.end()) {
        seen_.emplace_back(obstacle.body, moves || time > 0.0);
      } else {
        same->second = same->second || moves;
      }
    }
  }
  Eigen::Isometry3d PoseOf(const systems::ObstacleBody& body, double time) {
    context_.SetTime(time);
    for (const systems::Obstacle& obstacle : obstacles_.Eval(context_).obstacles) {
      if (obstacle.body.get() == &body) return obstacle.X_WO;
    }
    Eigen::Isometry3d nowhere = Eigen::Isometry3d::Identity();
    nowhere.translation().x() = 1e4;
    return nowhere;
  }

  Context context_;
  const Output<systems::RequestAhead> ahead_;
  const Output<systems::ObstacleSet> obstacles_;
  std::shared_ptr<const systems::Trajectory> request_;
  std::vector<std::pair<std::shared_ptr<const systems::ObstacleBody>, bool>> seen_;
};

nlohmann::ordered_json Plan(const PlanArguments& arguments, int seed) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<diagrams::Override> overrides;
  for (const std::string& text : arguments.overrides) {
    overrides.push_back(diagrams::Override::Parse(text));
  }
  if (seed >= 0) overrides.push_back({"simulator.seed", std::to_string(seed)});
  const auto loaded = diagrams::LoadDiagram(arguments.file, overrides);
  Script script(loaded);
  const auto bodies = script.Bodies();
  models::ClairvoyantTask task;
  task.request = [&](double time, int derivative, Eigen::Ref<VectorXd> out) {
    script.request().Evaluate(time, derivative, out);
  };
  task.request_end = script.request().times().back();
  task.duration = arguments.duration.value_or(loaded.simulator.duration);
  task.bodies = bodies;
  task.seed = static_cast<std::uint64_t>(loaded.simulator.seed);
  task.starts = arguments.starts;
  const auto plan = models::PlanClairvoyantly(loaded.models.Get(arguments.model), task);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  return {{"seed", loaded.simulator.seed},
          {"clear", plan.clear},
          {"min_distance", plan.min_distance},
          {"speed", plan.speed},
          {"acceleration", plan.acceleration},
          {"start", models::kBandStartNames[static_cast<std::size_t>(plan.start)]},
          {"seconds", wall.count()}};
}

}  // namespace

int PlanCommand(const PlanArguments& arguments) {
  try {
    const int first = arguments.seed.value_or(-1);
    for (int i = 0; i < arguments.samples; ++i) {
      std::cout << Plan(arguments, first < 0 ? first : first + i).dump() << std::endl;
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return kBadInput;
  }
  return kFine;
}

}  // namespace oca::tools
