// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "oca/diagrams/drafts/draft.h"
#include "oca/diagrams/files/override.h"

namespace oca::drafts::internal {

/// The name of a file made for a robot: its letters and digits.
std::string PlainName(const std::string& robot);

/// How a file in `folder` names another one: from there, if that lies beside or below the folder,
/// else absolute.
std::string PathFrom(const std::filesystem::path& folder, const std::filesystem::path& file);

/// The same, of a file within the folder by its way from there.
std::string PathBeside(const std::filesystem::path& folder, const std::filesystem::path& file);

/// A template (*.yaml.in) with what stands for each `@name@` in it: alone in a line for whole
/// lines, or none.
std::string Filled(std::string_view text, const std::map<std::string_view, std::string>& values);
/// A text as YAML and JSON write it.
std::string Quoted(const std::string& text);
/// Parameters of the parts, for an arm, or a motion, that is smaller than those that their
/// distances are for.
std::string SmallerDistances(double size);
/// rad or m, n: how far joints go within the longest first motion.
Eigen::VectorXd LongestWays(const robot::RobotModel& model);
/// What an arm of sliders alone needs, whose positions are in m: a line of the spline, the plant.
std::string SplineUnit(const robot::RobotModel& model);
std::string PlantText(const robot::RobotModel& model, const std::string& start);
/// Section `expect`: that it arrives.
std::string ExpectText(const robot::RobotModel& model);
/// Section `packages`.
std::string PackagesText(const DraftRobot& robot);
/// What is below `models.arm`; `srdf` and `limits` (empty: none) as the diagram names them.
std::string ModelText(const DraftOptions& options, const DraftRobot& robot, const std::string& srdf,
                      const std::string& limits);

/// A first motion as a diagram file has it.
struct MotionText {
  std::string first, second;  ///< key points
  std::string ball;           ///< an obstacle
  std::string start, duration;
  std::string scale;       ///< SmallerDistances
  std::string time_scale;  ///< of the parts
};
MotionText TextOf(const planning::FirstMotion& motion, const DraftRobot& robot);
/// The same as overrides of another one, `made_for` what messages begin with.
std::vector<files::Override> OverridesOf(const MotionText& motion, const std::string& made_for);

/// The diagram file; `srdf` and `limits` (empty: none) are named as it finds them.
std::string DiagramText(const DraftOptions& options, const DraftRobot& robot,
                        const MotionText& motion, const std::string& srdf,
                        const std::string& limits);

/// A joint_limits.yaml for the joints whose speed nothing bounds; empty if there is none.
std::string LimitsText(const robot::RobotModel& model);

}  // namespace oca::drafts::internal
