// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sampling/task_geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "oca/diagrams/files/model_section.h"
#include "oca/diagrams/files/run_params.h"
#include "oca/diagrams/foresight/tree_source.h"
#include "oca/models/planning/rrt_connect.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/sensing/placed_bodies.h"

namespace oca::sampling {
namespace {

constexpr double kTimeStep = 0.01;  // s, at which the requested motion is looked at

bool Same(const Value& a, const Value& b) {
  if (a.kind() != b.kind()) return false;
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
  request_source_ = Source(root, names.request, problems);
  if (!request_source_) return;
  const std::string port = names.request + ".position";
  request_ = foresight::PositionsAheadOf(*request_source_, request_source_->FindOutput(port),
                                         foresight::Samples::kBetween, "systems." + port)
                 .at;
  const Eigen::Index joints = Request(0.0).size();
  if (joints == model_->num_positions()) return;
  problems.Add(root.location(),
               fmt::format("sampling: systems.{} requests {} joints; expected {} "
                           "of model '{}'",
                           names.request, joints, model_->num_positions(), names.model));
}

void TaskGeometry::LoadModel(const Value& root, ModelCache& cache, Problems& problems) {
  const Value* const entry = foresight::FindEntry(root, "models", names_.model, problems);
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

std::unique_ptr<Diagram> TaskGeometry::Source(const Value& root, const std::string& name,
                                              Problems& problems) const {
  systems::ModelSet models;
  models.Add(names_.model, model_);
  return foresight::MakeTreeSource(root, name, models, catalogue_, problems);
}

std::vector<Eigen::Isometry3d> TaskGeometry::LinkPosesAt(const Eigen::VectorXd& q) const {
  return robot::LinkPoses(*model_, q);
}

void TaskGeometry::SetObstacles(const Value& root, Problems& problems) {
  std::shared_ptr<const Diagram> source = Source(root, names_.obstacles, problems);
  if (!source) return;
  const std::string port = names_.obstacles + ".obstacles";
  const OutputHandle output = source->FindOutput(port);
  obstacles_.emplace(std::move(source), output, "systems." + port);
}

void TaskGeometry::PlaceObstacles(double time) {
  clearance_->SetBodies(systems::PlacedBodies(obstacles_->At(time)));
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
  const motion::KeyPoint start{.time = 0.0, .position = Request(0.0)};
  const motion::KeyPoint goal{.time = 1.0, .position = Goal()};
  const auto straight = motion::Trajectory::Linear({start, goal});
  clearance.KeepOwn(robot::OwnRangesAlong(model_, &straight, robot::kSelfDistance), margin);
  return planning::RrtConnect(
             clearance, Request(0.0), Goal(),
             {.seed = seed, .margin = margin, .most_nodes = most_nodes, .shortcuts = 0})
      .has_value();
}

}  // namespace oca::sampling
