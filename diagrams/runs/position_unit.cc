// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/position_unit.h"

#include <memory>
#include <vector>

#include "oca/models/robot/robot_model.h"
#include "oca/systems/signals/roles.h"

namespace oca::runs {
namespace {

constexpr const char* kEither = "rad or m";

/// By full names; the judges' robots, or all.
std::vector<std::shared_ptr<const robot::RobotModel>> JudgedRobots(
    const loading::LoadedDiagram& loaded) {
  const auto& all = loaded.models.all();
  std::vector<std::shared_ptr<const robot::RobotModel>> robots;
  bool named = true;
  for (const auto& judge : loaded.diagram->FindRoles<systems::Judges>()) {
    const auto found = all.find(loaded.models.FullName(judge.role->model));
    named = named && found != all.end();
    if (named) robots.push_back(found->second);
  }
  if (named && !robots.empty()) return robots;
  robots.clear();
  for (const auto& entry : all) {
    if (entry.second->num_positions() > 0) robots.push_back(entry.second);
  }
  return robots;
}

}  // namespace

std::string PositionUnit(const loading::LoadedDiagram& loaded) {
  std::string unit;
  for (const auto& robot : JudgedRobots(loaded)) {
    const std::string_view own = robot->position_unit();
    if (own == "mixed" || (!unit.empty() && unit != own)) return kEither;
    unit = own;
  }
  return unit.empty() ? "rad" : unit;
}

std::string UnitOverTime(const std::string& unit, const std::string& time) {
  return unit == kEither ? "rad/" + time + " or m/" + time : unit + "/" + time;
}

}  // namespace oca::runs
