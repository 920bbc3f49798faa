// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "oca/diagrams/record/message_values.h"
#include "oca/diagrams/record/robot_drawing.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/models/geometry/collider.h"
#include "oca/models/json_values.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/signals/roles.h"

namespace oca::record {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using models::internal::AppendJson;
using models::internal::AppendQuoted;
using systems::LinkForceSet;
using systems::LinkPoses;
using systems::ObstacleSet;
using systems::ProximitySet;
using systems::RolePort;
using systems::WrenchSet;

const Colour kRed(0.86, 0.15, 0.13, 1.0);
const Colour kYellow(0.95, 0.76, 0.05, 1.0);
const Colour kBlue(0.12, 0.42, 0.85, 1.0);
const Colour kGrey(0.55, 0.58, 0.62, 1.0);
const Colour kObstacle(0.30, 0.62, 0.40, 0.85);

constexpr std::size_t kTrailPiece = 12;  // points

template <class T>
const T& As(const void* value) {
  return *static_cast<const T*>(value);
}

/// An arrow of at most 0.4 m, half of which stand for `half`.
Vector3d ArrowOf(const Vector3d& vector, double half) {
  constexpr double kLongest = 0.4;
  const double norm = vector.norm();
  return norm > 0.0 ? Vector3d(vector * (kLongest / (norm + half))) : Vector3d(Vector3d::Zero());
}

/// The link at the end of the longest chain of joints, the last of several.
int TipOf(const robot::RobotModel& model) {
  std::vector<int> depth(static_cast<std::size_t>(model.num_links()), 0);
  int tip = 0;
  for (const auto& joint : model.joints()) {
    const auto child = static_cast<std::size_t>(joint.child_link);
    depth[child] = depth[static_cast<std::size_t>(joint.parent_link)] + 1;
    if (depth[child] >= depth[static_cast<std::size_t>(tip)]) tip = joint.child_link;
  }
  return tip;
}

std::string SceneMessage(const std::string& entities, const std::string& deletions = "") {
  return "{\"deletions\":[" + deletions + "],\"entities\":[" + entities + "]}";
}

void Separate(std::string& list) {
  if (!list.empty()) list += ',';
}

/// The outputs that hold a signal of a type, without those that show what others do.
template <class T>
std::vector<OutputHandle> DrawnOf(const Diagram& diagram) {
  std::vector<OutputHandle> drawn;
  for (const Diagram::Leaf& leaf : diagram.systems()) {
    const auto hidden = leaf.system->roles<systems::NotDrawn>();
    for (int i = 0; i < std::ssize(leaf.system->outputs()); ++i) {
      const OutputHandle output{{leaf.system, i}};
      const bool here = std::none_of(hidden.begin(), hidden.end(),
                                     [&](const auto* role) { return role->output == output; });
      if (here && &TypeOfPort(output) == &TypeOf<T>()) drawn.push_back(output);
    }
  }
  return drawn;
}

}  // namespace

Scene::Scene(const loading::LoadedDiagram& loaded, const runs::SignalFacts& facts) {
  const Diagram& diagram = *loaded.diagram;
  AddRobots(loaded, facts);
  obstacles_ = AddSources(DrawnOf<ObstacleSet>(diagram));
  proximities_ = AddSources(DrawnOf<ProximitySet>(diagram));
  forces_ = AddSources(DrawnOf<LinkForceSet>(diagram));
  wrenches_ = AddSources(DrawnOf<WrenchSet>(diagram));
  const auto fields = diagram.FindRoles<systems::Repels>();
  if (fields.empty()) return;
  far_ = 0.0;
  for (const auto& field : fields) far_ = std::max(far_, field.role->range);
}

std::vector<std::size_t> Scene::AddSources(const std::vector<OutputHandle>& outputs) {
  std::vector<std::size_t> places;
  for (const OutputHandle& output : outputs) {
    places.push_back(sources_.size());
    sources_.push_back(output);
  }
  return places;
}

void Scene::AddRobots(const loading::LoadedDiagram& loaded, const runs::SignalFacts& facts) {
  for (const auto& [name, model] : loaded.models.all()) {
    Robot robot;
    robot.name = name;
    robot.model = model;
    robot.tip = TipOf(*model);
    robot.requested = {name + "/requested/", kGrey};
    robot.actual = {name + "/actual/", kBlue};
    for (const auto& link : model->links()) robot.frames.push_back(name + "/" + link.name.text());
    robot.X_WL = robot::LinkPoses(*model, Eigen::VectorXd::Zero(model->num_positions()));
    const auto of_robot = [&](const InputHandle& input) {
      const auto driver = RolePort(input).In(*loaded.diagram);
      return driver && facts.RobotOf(*driver) == robot.name;
    };
    for (const auto& [path, system, role] : loaded.diagram->FindRoles<systems::Kinematics>()) {
      if (!robot.links && of_robot(role->position)) robot.links = AddSources({role->links})[0];
    }
    for (const auto& [path, system, role] : loaded.diagram->FindRoles<systems::Judges>()) {
      if (robot.request || !of_robot(role->request)) continue;
      robot.request = AddSources({*loaded.diagram->DriverOf(role->request)})[0];
    }
    robots_.push_back(std::move(robot));
  }
}

std::vector<RecordChannel> Scene::Channels() {
  std::vector<RecordChannel> channels;
  channels.push_back(
      {"/tf", "foxglove.FrameTransforms", FoxgloveSchema("foxglove.FrameTransforms")});
  const std::string update = FoxgloveSchema("foxglove.SceneUpdate");
  for (const char* topic :
       {"/scene/robots", "/scene/obstacles", "/scene/forces", "/scene/trails"}) {
    channels.push_back({topic, "foxglove.SceneUpdate", update});
  }
  return channels;
}

void Scene::DrawRobots(std::uint64_t time, const Emit& emit) const {
  std::string entities;
  for (const Robot& robot : robots_) {
    for (int link = 0; link < robot.model->num_links(); ++link) {
      const std::string& frame = robot.frames[static_cast<std::size_t>(link)];
      SceneEntity entity(frame, frame);
      DrawLink(robot.model->links()[static_cast<std::size_t>(link)], entity);
      Separate(entities);
      entity.Append(entities, time, true);
    }
  }
  emit(kRobots, SceneMessage(entities));
}

void Scene::Draw(std::uint64_t time, std::span<const void* const> values, const Emit& emit) {
  DrawTransforms(time, values, emit);
  DrawObstacles(time, values, emit);
  DrawForces(time, values, emit);
  DrawTrails(time, values, emit);
}

void Scene::DrawTransforms(std::uint64_t time, std::span<const void* const> values,
                           const Emit& emit) {
  text_ = "{\"transforms\":[";
  bool first = true;
  const auto add = [&](std::string_view child, const Isometry3d& X_WF) {
    if (!first) text_ += ',';
    first = false;
    AppendTransform(text_, time, child, X_WF);
  };
  for (const Robot& robot : robots_) {
    const auto& poses = robot.links ? As<LinkPoses>(values[*robot.links]).poses : robot.X_WL;
    for (std::size_t i = 0; i < std::min(poses.size(), robot.frames.size()); ++i) {
      add(robot.frames[i], poses[i]);
    }
  }
  for (const std::size_t source : obstacles_) {
    for (const auto& obstacle : As<ObstacleSet>(values[source]).obstacles) {
      add("obstacle/" + obstacle.body->id.text(), obstacle.X_WO);
    }
  }
  text_ += "]}";
  emit(kTf, text_);
}

void Scene::DrawObstacles(std::uint64_t time, std::span<const void* const> values,
                          const Emit& emit) {
  std::string entities, deletions;
  std::map<std::string, const systems::ObstacleBody*> now;
  for (const std::size_t source : obstacles_) {
    for (const auto& obstacle : As<ObstacleSet>(values[source]).obstacles) {
      const std::string id = "obstacle/" + obstacle.body->id.text();
      now[id] = obstacle.body.get();
      const auto before = shown_.find(id);
      if (before != shown_.end() && before->second == obstacle.body.get()) continue;
      SceneEntity entity(id, id);
      entity.AddShape(obstacle.body->collider->shape(), Isometry3d::Identity(), kObstacle);
      Separate(entities);
      entity.Append(entities, time, true);
    }
  }
  for (const auto& [id, body] : shown_) {
    if (now.contains(id)) continue;
    Separate(deletions);
    deletions += "{\"timestamp\":";
    AppendTime(deletions, time);
    deletions += ",\"type\":0,\"id\":";
    AppendQuoted(deletions, id);
    deletions += '}';
  }
  if (!entities.empty() || !deletions.empty()) emit(kObstacles, SceneMessage(entities, deletions));
  shown_ = std::move(now);
}

void Scene::DrawForces(std::uint64_t time, std::span<const void* const> values, const Emit& emit) {
  constexpr double kHalfForce = 5.0;   // N
  constexpr double kHalfTorque = 2.0;  // Nm
  std::vector<Vector3d> points;
  std::vector<Colour> colours;
  std::string distances = "[";
  for (const std::size_t source : proximities_) {
    for (const auto& p : As<ProximitySet>(values[source]).proximities) {
      const double near = 1.0 - std::clamp(p.distance / far_, 0.0, 1.0);
      const Colour colour(std::min(1.0, 2.0 * near), std::min(1.0, 2.0 - 2.0 * near), 0.1, 1.0);
      points.insert(points.end(), {p.point_on_link, p.point_on_obstacle});
      colours.insert(colours.end(), 2, colour);
      if (distances.size() > 1) distances += ',';
      AppendJson(distances, p.distance);
    }
  }
  distances_entity_.Clear();
  distances_entity_.AddLines(points, colours, false);
  // A line is as long as the shapes are apart, and as they are deep in each other: this tells
  // which.
  distances_entity_.AddMetadata("distances", distances + "]");
  forces_entity_.Clear();
  for (const std::size_t source : forces_) {
    for (const auto& force : As<LinkForceSet>(values[source]).forces) {
      forces_entity_.AddArrow(force.point, ArrowOf(force.force, kHalfForce), kRed);
    }
  }
  torques_entity_.Clear();
  for (const std::size_t source : wrenches_) {
    for (const auto& wrench : As<WrenchSet>(values[source]).wrenches) {
      torques_entity_.AddArrow(wrench.origin, ArrowOf(wrench.torque, kHalfTorque), kYellow);
    }
  }
  std::string entities;
  for (const SceneEntity* entity : {&distances_entity_, &forces_entity_, &torques_entity_}) {
    Separate(entities);
    entity->Append(entities, time, false);
  }
  emit(kForces, SceneMessage(entities));
}

void Scene::DrawTrails(std::uint64_t time, std::span<const void* const> values, const Emit& emit) {
  std::string entities;
  for (Robot& robot : robots_) {
    const auto tip = static_cast<std::size_t>(robot.tip);
    if (robot.links) {
      Extend(robot.actual, As<LinkPoses>(values[*robot.links]).poses[tip].translation(), time,
             entities);
    }
    if (robot.request) {
      const Eigen::Map<const Eigen::VectorXd> q(static_cast<const double*>(values[*robot.request]),
                                                robot.model->num_positions());
      robot::ForwardKinematics(*robot.model, q, robot.X_WL);
      Extend(robot.requested, robot.X_WL[tip].translation(), time, entities);
    }
  }
  if (!entities.empty()) emit(kTrails, SceneMessage(entities));
}

void Scene::Extend(Trail& trail, const Vector3d& point, std::uint64_t time, std::string& entities) {
  constexpr double kLeastStep = 1e-3;  // m
  if (!trail.points.empty() && (point - trail.points.back()).norm() < kLeastStep) return;
  trail.points.push_back(point);
  if (trail.points.size() >= kTrailPiece) CloseTrail(trail, time, entities);
}

void Scene::CloseTrail(Trail& trail, std::uint64_t time, std::string& entities) {
  if (trail.points.size() < 2) return;
  SceneEntity entity(trail.id + std::to_string(trail.pieces++), "world");
  entity.AddLines(trail.points, std::span(&trail.colour, 1), true);
  Separate(entities);
  entity.Append(entities, time, false);
  trail.points.erase(trail.points.begin(), trail.points.end() - 1);
}

void Scene::Finish(std::uint64_t time, const Emit& emit) {
  std::string entities;
  for (Robot& robot : robots_) {
    CloseTrail(robot.requested, time, entities);
    CloseTrail(robot.actual, time, entities);
  }
  if (!entities.empty()) emit(kTrails, SceneMessage(entities));
}

}  // namespace oca::record
