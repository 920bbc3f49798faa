// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/scene_frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "oca/framework/dataflow/nearest.h"
#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"

namespace oca::drafts::internal {

SceneFrames::SceneFrames(const robot::RobotModel& model, const Eigen::VectorXd& q,
                         const std::vector<std::string>& worlds, const scenes::PlanningScene& scene)
    : model_(model), X_WL_(robot::LinkPoses(model, q)) {
  frames_[""] = Eigen::Isometry3d::Identity();
  for (const std::string& world : worlds) frames_[world] = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < X_WL_.size(); ++i) {
    frames_[model.links()[i].name.text()] = X_WL_[i];
  }
  AddFixed(scene);
  AddObjects(scene);
}

/// What a file says of a frame goes before what is taken for granted.
void SceneFrames::AddFixed(const scenes::PlanningScene& scene) {
  std::vector<const scenes::SceneFrame*> left;
  for (const scenes::SceneFrame& frame : scene.frames) left.push_back(&frame);
  for (std::size_t before = left.size() + 1; left.size() < before;) {
    before = left.size();
    std::erase_if(left, [&](const scenes::SceneFrame* frame) {
      const auto parent = frames_.find(frame->parent);
      if (parent == frames_.end()) return false;
      frames_[frame->name] = parent->second * frame->X_PF;
      return true;
    });
  }
  // MoveIt lists the transforms of a robot's other sensors too; who names them gets the error.
}

bool SceneFrames::TryAdd(const scenes::SceneObject& object) {
  const auto frame = frames_.find(object.frame.text);
  if (frame == frames_.end()) return false;
  const Eigen::Isometry3d X_WO = frame->second * object.X_FO;
  frames_.emplace(object.id, X_WO);
  for (const scenes::SceneFrame& subframe : object.subframes) {
    frames_.emplace(object.id + "/" + subframe.name, X_WO * subframe.X_PF);
  }
  return true;
}

void SceneFrames::AddObjects(const scenes::PlanningScene& scene) {
  std::vector<const scenes::SceneObject*> left;
  for (const scenes::SceneObject& object : scene.objects) left.push_back(&object);
  for (const scenes::HeldSceneObject& held : scene.held) left.push_back(&held.object);
  for (std::size_t before = left.size() + 1; left.size() < before;) {
    before = left.size();
    std::erase_if(left, [&](const scenes::SceneObject* object) { return TryAdd(*object); });
  }
  models::ModelErrors errors;
  for (const scenes::SceneObject* object : left) {
    errors.Try([&] { Find(object->frame); });
  }
  errors.Throw();
}

const Eigen::Isometry3d& SceneFrames::Find(const scenes::PlacedName& frame) const {
  const auto found = frames_.find(frame.text);
  if (found != frames_.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [name, X] : frames_) {
    if (!name.empty()) names.push_back(name);
  }
  throw models::ModelError(
      fmt::format("{}: frame; got '{}'; expected a link, an object, a subframe or a fixed frame{}",
                  frame.where, frame.text, DidYouMean(frame.text, names)));
}

Eigen::Isometry3d SceneFrames::PoseOf(const scenes::SceneObject& object) const {
  return Find(object.frame) * object.X_FO;
}

bool SceneFrames::Moves(const std::string& frame) const {
  const auto& links = model_.links();
  const auto found = std::find_if(links.begin(), links.end(), [&](const robot::Link& link) {
    return link.name.text() == frame;
  });
  return found != links.end() && model_.body(static_cast<int>(found - links.begin())) >= 0;
}

}  // namespace oca::drafts::internal
