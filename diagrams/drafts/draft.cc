// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/draft.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "oca/diagrams/drafts/draft_text.h"
#include "oca/diagrams/drafts/robot_reader.h"
#include "oca/diagrams/loading/blueprint.h"
#include "oca/diagrams/runs/output_files.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/robot/collision_check.h"
#include "oca/models/robot/srdf.h"

namespace oca::drafts {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostProposals = 60;

/// One call of MakeDraft.
class DraftMaker {
 public:
  explicit DraftMaker(const DraftOptions& options)
      : options_(options), draft_{.robot = ReadDraftRobot(options)} {
    const std::string name = internal::PlainName(draft_.robot.model->name().text());
    draft_.diagram = options.folder / (name + ".yaml");
    if (options.srdf.empty()) srdf_ = options.folder / (name + ".srdf");
    limits_text_ = internal::LimitsText(*draft_.robot.model);
    if (!limits_text_.empty()) limits_ = options.folder / (name + "_limits.yaml");
  }

  /// Leaves no file behind if it throws.
  Draft Make() {
    PrepareFolder();
    try {
      Fill();
    } catch (...) {
      for (const fs::path& file : draft_.files) {
        std::error_code ignored;
        fs::remove(file, ignored);
      }
      throw;
    }
    return std::move(draft_);
  }

 private:
  void Fill() {
    if (!srdf_.empty()) WriteSrdf();
    const auto motions = planning::ProposeMotions(draft_.robot.model, draft_.robot.tip,
                                                  kMostProposals, options_.seed);
    if (motions.empty()) {
      throw ConfigError(fmt::format(
          "{}: a first motion; got no posture of '{}' from which its tip goes half its reach, "
          "{:.3g} "
          "m, own links apart and none below its base; expected a robot that can",
          options_.robot.string(), draft_.robot.model->name().text(), draft_.robot.reach));
    }
    if (!limits_.empty()) Keep(limits_, limits_text_);
    WriteDiagram(motions.front());
    const loading::Blueprint blueprint(draft_.diagram);
    for (const planning::FirstMotion& motion : motions) {
      if (draft_.tries == options_.tries || Interrupted()) break;
      Attempt attempt = Try(blueprint, motion);
      const bool good = attempt.contact() && attempt.evaded();
      if (good || ++draft_.tries == 1 || Better(attempt, draft_.attempt)) {
        draft_.attempt = std::move(attempt);
      }
      if (good) break;
    }
    WriteDiagram(draft_.attempt.motion);
  }

  bool Interrupted() const { return options_.interrupted && options_.interrupted(); }

  void PrepareFolder() const {
    std::error_code error;
    fs::create_directories(options_.folder, error);
    if (error) {
      throw ConfigError(fmt::format("{}: {}; expected a folder to write to",
                                    options_.folder.string(), error.message()));
    }
    for (const fs::path& file : {draft_.diagram, srdf_, limits_}) {
      if (file.empty() || !fs::exists(file, error)) continue;
      throw ConfigError(
          fmt::format("{} is there already; expected a folder without it", file.string()));
    }
  }

  void Keep(const fs::path& file, const std::string& text) {
    internal::WriteDraft(file, text);
    draft_.files.push_back(file);
  }

  /// Of the arm, with all else where it is held. The robot is read again, with what it says.
  void WriteSrdf() {
    const robot::RobotModel& model = *draft_.robot.model;
    robot::SaveDisabledPairs(srdf_, model.name().text(),
                             robot::PairsToDisable(model, robot::CheckCollisions(model, {})));
    draft_.files.push_back(srdf_);
    DraftOptions known = options_;
    known.srdf = srdf_;
    known.warn = nullptr;
    draft_.robot = ReadDraftRobot(known);
  }

  void WriteDiagram(const planning::FirstMotion& motion) {
    const std::string srdf = srdf_.empty() ? internal::PathFrom(options_.folder, options_.srdf)
                                           : srdf_.filename().string();
    internal::WriteDraft(
        draft_.diagram,
        internal::DiagramText(options_, draft_.robot, internal::TextOf(motion, draft_.robot), srdf,
                              limits_.filename().string()));
    if (draft_.files.empty() || draft_.files.front() != draft_.diagram) {
      draft_.files.insert(draft_.files.begin(), draft_.diagram);
    }
  }

  Attempt Try(const loading::Blueprint& blueprint, const planning::FirstMotion& motion) const {
    Attempt attempt{motion};
    const auto run = [&](bool avoid) {
      auto overrides = internal::OverridesOf(internal::TextOf(motion, draft_.robot));
      overrides.push_back({"parameters.avoid", avoid ? "true" : "false"});
      runs::RunOptions options;
      options.progress = [this](double) { return !Interrupted(); };
      return runs::Run(blueprint.Build(overrides), options);
    };
    attempt.without = run(false);
    if (attempt.contact()) attempt.with = run(true);
    return attempt;
  }

  static bool Better(const Attempt& a, const Attempt& b) {
    const auto distance = [](const Attempt& attempt) {
      return attempt.with.metrics ? attempt.with.metrics->min_distance.value_or(-1.0) : -1.0;
    };
    return distance(a) > distance(b);
  }

  const DraftOptions& options_;
  Draft draft_;
  fs::path srdf_, limits_;  // that are written; empty: not
  std::string limits_text_;
};

}  // namespace

bool Attempt::contact() const {
  return !without.failure && without.metrics && without.metrics->min_distance.value_or(1.0) <= 0.0;
}

bool Attempt::evaded() const { return with.metrics && !with.failure && with.ExpectationsMet(); }

Draft MakeDraft(const DraftOptions& options) { return DraftMaker(options).Make(); }

}  // namespace oca::drafts
