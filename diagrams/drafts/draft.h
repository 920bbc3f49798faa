// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/runs/run_result.h"
#include "oca/models/planning/arm_guess.h"
#include "oca/models/planning/first_motion.h"
#include "oca/models/robot/srdf.h"
#include "oca/models/robot/urdf.h"

namespace oca::drafts {

/// What a first diagram file is made of.
struct DraftOptions {
  std::filesystem::path robot{};      ///< URDF or xacro
  std::string named{};                ///< how the diagram names it; empty: by its path
  robot::XacroArguments arguments{};  ///< of a xacro
  std::string named_srdf{};           ///< how the diagram names the SRDF; empty: by its path
  std::filesystem::path srdf{};       ///< empty: pairs are found by sampling, and written
  std::string group{};                ///< of the SRDF, that is the arm; empty: it is guessed
  /// rad or m, by name: where joints that are not of the arm are held, else at 0.
  std::map<std::string, double> stands{};
  std::string avoidance{"recommended"};                 ///< parts/avoidance_NAME.yaml
  std::filesystem::path folder{};                       ///< where the files go; made if need be
  std::uint64_t seed{0};                                ///< of sampled postures
  int tries{12};                                        ///< how many motions are run, at most; >= 1
  std::function<void(const std::string& line)> warn{};  ///< what loading the robot warns of
  /// Told now and then what is done, and what share of it; false: it ends, and leaves no file.
  std::function<bool(const std::string& task, double share)> progress{};
};

/// What is known of a robot before its first diagram.
struct DraftRobot {
  std::shared_ptr<const robot::RobotModel> model{};  ///< the arm; what is not of it is held
  int tip{0};                                        ///< number of the link
  double reach{0.0};                                 ///< m; planning::ReachOf
  std::map<std::string, double> held{};              ///< rad or m, by joint
  /// Where packages were found that the robot's file names, beside those that OCA knows.
  std::map<std::string, std::filesystem::path> packages{};
  bool visuals{false};  ///< links without collision shapes take what is drawn of them
};

/// A first motion, and what became of it.
struct Attempt {
  planning::FirstMotion motion{};
  runs::RunResult without{};  ///< as requested
  runs::RunResult with{};     ///< with avoidance
  bool contact() const;       ///< without avoidance
  bool evaded() const;        ///< clear, and arrived
};

/// A diagram file made for a robot.
struct Draft {
  DraftRobot robot{};
  std::filesystem::path diagram{};
  std::vector<std::filesystem::path> files{};  ///< all that were written; none: it was ended
  Attempt attempt{};                           ///< the one that the file has
  int tries{0};                                ///< motions that were run
};

/// The SRDF of `options`; an empty one if it names none.
robot::Srdf LoadSrdfOf(const DraftOptions& options, const robot::RobotModel& model);

/// Loads a robot and guesses its arm (planning::GuessArm), or takes that of the group. Packages
/// are looked for among the folders that lie above and beside its file too.
/// throws ModelError, ConfigError if it is none
DraftRobot ReadDraftRobot(const DraftOptions& options);

/// Writes NAME.yaml, a diagram in which the arm turns past a ball that lies across its way, and
/// beside it NAME.srdf, if none is given, and NAME_limits.yaml, if the description lacks limits of
/// speeds; NAME is the robot's. The first of planning::ProposeMotions counts that is in contact
/// without avoidance and evaded with it, else the one that comes nearest to that. A NAME.html that
/// is there is in the way too: it is where the run's report goes.
/// throws ModelError, ConfigError if the robot is none or slower than any, there is no such method,
///        no motion is found, a file is there already or cannot be written
Draft MakeDraft(const DraftOptions& options);

}  // namespace oca::drafts
