// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <string>
#include <vector>

#include "oca/models/robot/robot_model.h"
#include "oca/models/scenes/planning_scene.h"

namespace oca::drafts::internal {

/// Where the frames are that a scene may name, in the world: the scene's own frame.
class SceneFrames {
 public:
  /// `worlds` are names of that frame; the robot stands at `q`.
  /// throws ModelError `file:line: ...` for objects and fixed transforms in unknown frames
  SceneFrames(const robot::RobotModel& model, const Eigen::VectorXd& q,
              const std::vector<std::string>& worlds, const scenes::PlanningScene& scene);

  /// throws ModelError `file:line: frame; got X; expected Y` if there is none
  const Eigen::Isometry3d& Find(const scenes::PlacedName& frame) const;
  /// Of an object.
  Eigen::Isometry3d PoseOf(const scenes::SceneObject& object) const;
  const std::vector<Eigen::Isometry3d>& X_WL() const { return X_WL_; }
  /// Whether it is a link that moves.
  bool Moves(const std::string& frame) const;

 private:
  bool TryAdd(const scenes::SceneObject& object);
  void AddFixed(const scenes::PlanningScene& scene);
  void AddObjects(const scenes::PlanningScene& scene);

  const robot::RobotModel& model_;
  std::vector<Eigen::Isometry3d> X_WL_;
  std::map<std::string, Eigen::Isometry3d> frames_;
};

}  // namespace oca::drafts::internal
