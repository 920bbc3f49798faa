// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "oca/diagrams/drafts/draft.h"
#include "oca/models/scenes/scene_problem.h"

namespace oca::drafts {

/// What a diagram of somebody else's scene is made of. Of `draft` the robot with its arguments,
/// SRDF and group, avoidance and warn count.
struct SceneDraftOptions {
  DraftOptions draft{};
  std::filesystem::path scene{};    ///< scenes::ReadPlanningScene
  std::filesystem::path request{};  ///< scenes::ReadMotionRequest; empty: the arm rests
  std::filesystem::path diagram{};  ///< the file to write
  bool intruder{false};             ///< a ball flies at the arm; the seed of a run says from where
};

struct SceneDraft {
  DraftRobot robot{};
  std::vector<std::filesystem::path> files{};  ///< all that were written, first the diagram
  int obstacles{0};
  int held{0};                          ///< attached objects
  std::vector<std::string> decided{};   ///< a line each
  std::vector<std::string> left_out{};  ///< what was not taken over, a line each
};

/// Writes a diagram file of the scene and the request: objects as obstacles, held ones as attached
/// to the arm, allowed collisions as `ignore`; the request a straight line of the joints within 6
/// s, or as much longer as the limits of the joints want, and then rest, up to 20 s. Beside it
/// meshes that the scene holds itself, an SRDF where none is given and the scene allows no
/// collisions, and limits of speed where the description has none.
///
/// The world is the scene's frame. Frames that it may name: that of the SRDF's virtual joint and
/// the robot's root, its links where they stand at the start, fixed transforms, objects and
/// subframes ("object/subframe").
/// throws ModelError, ConfigError for files that are wrong, an unknown frame, a joint of the arm of
///        which start or goal is missing, a goal beyond a limit, a file that is there already or
///        cannot be written, and what makes a diagram that cannot be loaded, as a pose out of reach
SceneDraft DraftScene(const SceneDraftOptions& options);

/// Writes sceneNNNN.yaml and requestNNNN.yaml of a problem into the folder, which is made if need
/// be; NNNN is the number. throws ConfigError if one is there already, or cannot be written
void WriteSceneProblem(const std::filesystem::path& folder, int number,
                       const robot::RobotModel& model, const scenes::SceneProblem& problem);

}  // namespace oca::drafts
