// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/drafts/draft.h"
#include "oca/diagrams/drafts/scene_shapes.h"

namespace oca::drafts::internal {

struct HeldText {
  BodyText body{};  ///< in the frame of the link
  std::string link{};
  std::vector<std::string> touches{};
};

struct PoseGoalText {
  std::string link{};
  Eigen::Isometry3d X_WG{Eigen::Isometry3d::Identity()};
  bool turns_freely{false};
};

/// What the diagram file of a scene has, beside its robot.
struct SceneText {
  std::string name{}, scene{}, request{};   ///< the last two: names of files, for the comment
  std::optional<Eigen::Isometry3d> base{};  ///< of the robot's root
  std::vector<BodyText> obstacles{};        ///< in the world
  std::vector<HeldText> held{};
  std::vector<std::pair<std::string, std::string>> ignored{};
  Eigen::VectorXd start{};
  std::optional<Eigen::VectorXd> goal{};
  std::optional<PoseGoalText> pose{};
  double duration{0.0};  ///< s; of the motion
  std::string limits{}, limits_text{};
  bool intruder{false};
};

/// The diagram file; `options.folder` is where it lies.
std::string SceneDiagramText(const DraftOptions& options, const DraftRobot& robot,
                             const SceneText& scene);

}  // namespace oca::drafts::internal
