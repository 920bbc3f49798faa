// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sampling/task_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/model_section.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/models/planning/rrt_connect.h"
#include "oca/models/robot/kinematics.h"

namespace oca::sampling {
namespace {

constexpr double kTimeStep = 0.01;  // s, at which the requested motion is looked at

bool Same(const Value& a, const Value& b) {
  if (a.data().index() != b.data().index()) return false;
  if (a.list() != nullptr) {
    return std::equal(a.list()->begin(), a.list()->end(), b.list()->begin(), b.list()->end(), Same);
  }
  if (a.map() != nullptr) {
    return std::equal(a.map()->begin(), a.map()->end(), b.map()->begin(), b.map()->end(),
                      [](const Value::Entry& one, const Value::Entry& other) {
                        return one.key == other.key && Same(one.value, other.value);
                      });
  }
  double x = 0.0;
  double y = 0.0;
  if (a.number(x) && b.number(y)) return x == y;
  if (a.string() != nullptr) return *a.string() == *b.string();
  return a.boolean() == nullptr || *a.boolean() == *b.boolean();
}

/// An entry of a section; nullptr, with a problem, if there is none.
const Value* Named(const Value& root, const char* section, const std::string& name,
                   Problems& problems) {
  const Value* const map = root.Find(section);
  const Value* const found = map == nullptr ? nullptr : map->Find(name);
  if (found != nullptr && found->map() != nullptr) return found;
  std::vector<std::string> known;
  if (map != nullptr && map->map() != nullptr) {
    for (const Value::Entry& entry : *map->map()) known.push_back(entry.key);
  }
  problems.Add(root.location(),
               fmt::format("sampling: no '{}' in {}{}", name, section, DidYouMean(name, known)));
  return nullptr;
}

Value::Map Without(const Value& map, const char* key) {
  Value::Map rest;
  for (const Value::Entry& entry : *map.map()) {
    if (entry.key != key) rest.push_back(entry);
  }
  return rest;
}

}  // namespace

TaskGeometry::TaskGeometry(const Value& root, const TaskNames& names,
                           const files::Catalogue& catalogue, ModelCache& cache, Problems& problems)
    : catalogue_(catalogue), names_(names) {
  files::SimulatorParams simulator;
  if (const Value* const value = root.Find("simulator")) {
    ReadFields(*value, FieldsOf<files::SimulatorParams>(), "simulator", &simulator, problems);
  }
  duration_ = simulator.duration;
  LoadModel(root, cache, problems);
  if (!model_) return;
  request_ = Source(root, names.request, "position", problems);
  if (!request_) return;
  request_context_ = request_->MakeContext();
  const Eigen::Index joints = Request(0.0).size();
  if (joints == model_->num_positions()) return;
  problems.Add(root.location(),
               fmt::format("sampling: systems.{} requests {} joints; expected {} "
                           "of model '{}'",
                           names.request, joints, model_->num_positions(), names.model));
}

void TaskGeometry::LoadModel(const Value& root, ModelCache& cache, Problems& problems) {
  const Value* const entry = Named(root, "models", names_.model, problems);
  if (entry == nullptr) return;
  Value rest(Without(*entry, "base_pose"), entry->location());
  if (!cache.model || !Same(rest, cache.entry)) {
    Value::Map models{{names_.model, entry->location(), rest}};
    Value::Map sections{{"models", entry->location(), Value(std::move(models), entry->location())}};
    if (const Value* const packages = root.Find("packages")) {
      sections.push_back({"packages", packages->location(), *packages});
    }
    const files::ModelSection section(Value(std::move(sections), root.location()), problems);
    if (section.failed()) return;
    cache.model = section.models().Get(names_.model);
    cache.entry = std::move(rest);
  }
  systems::PoseParams pose;
  if (const Value* const value = entry->Find("base_pose")) {
    const std::string where = fmt::format("models.{}.base_pose", names_.model);
    ReadFields(*value, FieldsOf<systems::PoseParams>(), where, &pose, problems);
  }
  model_ = std::make_shared<const robot::RobotModel>(cache.model->At(pose.Pose("base_pose")));
  clearance_.emplace(model_);
}

// A system without inputs and without samples: with `period` 0 it is a function of time.
std::unique_ptr<Diagram> TaskGeometry::Source(const Value& root, const std::string& name,
                                              const char* output, Problems& problems) const {
  const Value* const entry = Named(root, "systems", name, problems);
  if (entry == nullptr) return nullptr;
  const std::string where = "systems." + name;
  const Value* const type = entry->Find("type");
  if (type == nullptr || type->string() == nullptr) {
    problems.Add(entry->location(), where + ".type: missing; expected the name of a system type");
    return nullptr;
  }
  Value::Map params = Without(*entry, "type");
  std::erase_if(params, [](const Value::Entry& field) {
    return field.key == "period" || field.key == "frequency";
  });
  try {
    systems::ModelSet models;
    if (model_) models.Add(names_.model, model_);
    Value::Map packages;
    if (const Value* const section = root.Find("packages")) {
      packages.push_back({"packages", section->location(), *section});
    }
    files::ModelSection files(Value(std::move(packages), root.location()), problems);
    const Value resolved = files.ResolveFiles(Value(std::move(params), entry->location()));
    auto system = catalogue_.Find(*type->string())->Make(resolved, where, models, problems);
    if (!system) return nullptr;
    DiagramBuilder builder;
    const System& added = builder.AddSystem(name, std::move(system));
    builder.ExportOutput(output, added.FindOutput(output));
    return builder.Build();
  } catch (const std::runtime_error& error) {
    problems.Add(entry->location(), fmt::format("{}: {}", where, error.what()));
  }
  return nullptr;
}

Eigen::VectorXd TaskGeometry::Request(double time) {
  request_context_->SetTime(time);
  return request_->GetOutput<Vector>("position").Eval(*request_context_);
}

Eigen::VectorXd TaskGeometry::Goal() { return Request(duration_); }

std::vector<Eigen::Isometry3d> TaskGeometry::LinkPosesAt(const Eigen::VectorXd& q) const {
  return robot::LinkPoses(*model_, q);
}

void TaskGeometry::SetObstacles(const Value& root, Problems& problems) {
  obstacles_ = Source(root, names_.obstacles, "obstacles", problems);
  if (obstacles_) obstacles_context_ = obstacles_->MakeContext();
}

void TaskGeometry::PlaceObstacles(double time) {
  obstacles_context_->SetTime(time);
  const auto& set =
      obstacles_->GetOutput<systems::ObstacleSet>("obstacles").Eval(*obstacles_context_);
  std::vector<robot::PlacedBody> bodies;
  bodies.reserve(set.obstacles.size());
  for (const systems::Obstacle& obstacle : set.obstacles) {
    bodies.push_back({obstacle.body->collider, obstacle.X_WO});
  }
  clearance_->SetBodies(std::move(bodies));
}

double TaskGeometry::Distance(const Eigen::VectorXd& q, double time) {
  PlaceObstacles(time);
  clearance_->MoveTo(q);
  return clearance_->Nearest().distance;
}

double TaskGeometry::RequestedDistance(double enough) {
  double least = robot::kUnlimited;
  const auto steps = static_cast<int>(duration_ / kTimeStep);
  for (int i = 0; i <= steps && least > enough; ++i) {
    const double time = i * kTimeStep;
    PlaceObstacles(time);
    clearance_->MoveTo(Request(time));
    least = std::min(least, clearance_->Nearest(std::max(least, 0.0)).distance);
  }
  return least;
}

double TaskGeometry::FootDistance() {
  std::vector<double> distances(static_cast<std::size_t>(model_->num_links()));
  double least = robot::kUnlimited;
  const auto steps = static_cast<int>(duration_ / kTimeStep);
  for (int i = 0; i <= steps; ++i) {
    PlaceObstacles(i * kTimeStep);
    clearance_->MoveTo(Request(i * kTimeStep));
    clearance_->LinkDistances(least, distances);
    least = std::min(least, distances[static_cast<std::size_t>(model_->bodies().front())]);
  }
  return least;
}

double TaskGeometry::LowestLinkOrigin(const Eigen::VectorXd& q) const {
  double lowest = robot::kUnlimited;
  for (const Eigen::Isometry3d& X_WL : LinkPosesAt(q)) {
    lowest = std::min(lowest, X_WL.translation().z());
  }
  return lowest;
}

bool TaskGeometry::HasClearPath(double margin, int most_nodes, std::uint64_t seed) {
  PlaceObstacles(0.0);
  robot::Clearance clearance(model_, true, clearance_->bodies());
  return planning::RrtConnect(
             clearance, Request(0.0), Goal(),
             {.seed = seed, .margin = margin, .most_nodes = most_nodes, .shortcuts = 0})
      .has_value();
}

}  // namespace oca::sampling
