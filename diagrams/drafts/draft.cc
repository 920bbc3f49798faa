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
#include "oca/models/whole_file.h"

namespace oca::drafts {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostProposals = 60;

/// One call of MakeDraft.
class DraftMaker {
 public:
  explicit DraftMaker(const DraftOptions& options) : options_(options) {
    internal::CheckAvoidance(options);
    draft_.robot = ReadDraftRobot(options);
    CheckSpeeds();
    const std::string name = internal::PlainName(draft_.robot.model->name().text());
    draft_.diagram = options.folder / (name + ".yaml");
    if (options.srdf.empty()) srdf_ = options.folder / (name + ".srdf");
    limits_text_ = internal::LimitsText(*draft_.robot.model);
    if (!limits_text_.empty()) limits_ = options.folder / (name + "_limits.yaml");
  }

  /// Leaves no file behind if it throws, or is to end.
  Draft Make() {
    PrepareFolder();
    try {
      Fill();
    } catch (...) {
      RemoveAll();
      throw;
    }
    if (ended_) RemoveAll();
    return std::move(draft_);
  }

 private:
  /// A first motion goes at a quarter of the limits.
  void CheckSpeeds() const {
    constexpr double kSlowest = 1e-3;  // rad/s, m/s; a radian in more than an hour
    const robot::RobotModel& model = *draft_.robot.model;
    for (Eigen::Index j = 0; j < model.num_positions(); ++j) {
      if (model.velocity_limits()[j] >= kSlowest) continue;
      throw ConfigError(fmt::format(
          "{}: joint '{}': velocity limit; got {:g}; expected at least {:g} rad/s or m/s, for a "
          "first motion that ends",
          options_.robot.string(), model.position_names()[static_cast<std::size_t>(j)].text(),
          model.velocity_limits()[j], kSlowest));
    }
  }

  void Fill() {
    if (!srdf_.empty()) WriteSrdf();
    if (ended_) return;
    const auto motions = planning::ProposeMotions(
        draft_.robot.model, draft_.robot.tip, kMostProposals, options_.seed,
        [this](double share) { return GoesOn("looking for a first motion", share); },
        internal::LongestWays(*draft_.robot.model));
    if (ended_) return;
    if (motions.empty()) {
      throw ConfigError(fmt::format(
          "{}: a first motion; got no posture of '{}' from which its tip goes {:.2g} m, "
          "a sixteenth of its reach, past a ball, own links apart; expected a robot that can",
          options_.robot.string(), draft_.robot.model->name().text(), draft_.robot.reach / 16.0));
    }
    if (!limits_.empty()) Keep(limits_, limits_text_);
    WriteDiagram(motions.front());
    const loading::Blueprint blueprint(draft_.diagram);
    for (const planning::FirstMotion& motion : motions) {
      if (draft_.tries == options_.tries) break;
      Attempt attempt = Try(blueprint, motion);
      if (ended_) return;
      const bool good = attempt.contact() && attempt.evaded();
      if (good || ++draft_.tries == 1 || Better(attempt, draft_.attempt)) {
        draft_.attempt = std::move(attempt);
      }
      if (good) break;
    }
    WriteDiagram(draft_.attempt.motion);
  }

  bool GoesOn(const std::string& task, double share) {
    ended_ = ended_ || (options_.progress && !options_.progress(task, share));
    return !ended_;
  }

  void RemoveAll() {
    std::error_code ignored;
    for (const fs::path& file : draft_.files) fs::remove(file, ignored);
    draft_.files.clear();
    if (made_folder_) fs::remove(options_.folder, ignored);  // if it is empty
  }

  void PrepareFolder() {
    std::error_code error;
    made_folder_ = fs::create_directories(options_.folder, error);
    if (error) {
      throw ConfigError(fmt::format("{}: {}; expected a folder to write to",
                                    options_.folder.string(), error.message()));
    }
    fs::path page = draft_.diagram;
    page.replace_extension(".html");  // that whoever runs it writes
    for (const fs::path& file : {draft_.diagram, srdf_, limits_, page}) {
      if (file.empty() || !fs::exists(file, error)) continue;
      throw ConfigError(
          fmt::format("{} is there already; expected a folder without it", file.string()));
    }
  }

  void Keep(const fs::path& file, const std::string& text) {
    models::WriteWhole(file, text);
    draft_.files.push_back(file);
  }

  /// Of the arm, with all else where it is held. The robot is read again, with what it says.
  void WriteSrdf() {
    const robot::RobotModel& model = *draft_.robot.model;
    robot::CollisionSampling sampling;
    sampling.progress = [this](double share) { return GoesOn("looking at pairs of links", share); };
    const auto pairs = robot::CheckCollisions(model, sampling);
    if (ended_) return;
    robot::SaveDisabledPairs(srdf_, model.name().text(), robot::PairsToDisable(model, pairs));
    draft_.files.push_back(srdf_);
    DraftOptions known = options_;
    known.srdf = srdf_;
    known.warn = nullptr;
    draft_.robot = ReadDraftRobot(known);
  }

  void WriteDiagram(const planning::FirstMotion& motion) {
    const std::string srdf = srdf_.empty() ? internal::PathFrom(options_.folder, options_.srdf)
                                           : srdf_.filename().string();
    models::WriteWhole(draft_.diagram, internal::DiagramText(options_, draft_.robot,
                                                             internal::TextOf(motion, draft_.robot),
                                                             srdf, limits_.filename().string()));
    if (draft_.files.empty() || draft_.files.front() != draft_.diagram) {
      draft_.files.insert(draft_.files.begin(), draft_.diagram);
    }
  }

  Attempt Try(const loading::Blueprint& blueprint, const planning::FirstMotion& motion) {
    Attempt attempt{motion};
    const auto run = [&](bool avoid) {
      auto overrides = internal::OverridesOf(internal::TextOf(motion, draft_.robot),
                                             options_.robot.string() + ": its first motion");
      overrides.push_back({"parameters.avoid", avoid ? "true" : "false"});
      const loading::LoadedDiagram loaded = blueprint.Build(overrides);
      const std::string task = fmt::format("trying motion {} {} avoidance", draft_.tries + 1,
                                           avoid ? "with" : "without");
      runs::RunOptions options;
      options.progress = [&](double time) {
        return GoesOn(task, std::min(time / loaded.simulator.duration, 1.0));
      };
      return runs::Run(loaded, options);
    };
    attempt.without = run(false);
    if (!ended_ && attempt.contact()) attempt.with = run(true);
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
  bool made_folder_{false};
  bool ended_{false};  // as whoever is told of the progress wants
};

}  // namespace

bool Attempt::contact() const {
  return !without.failure && without.metrics && without.metrics->min_distance.value_or(1.0) <= 0.0;
}

bool Attempt::evaded() const { return with.metrics && !with.failure && with.ExpectationsMet(); }

Draft MakeDraft(const DraftOptions& options) { return DraftMaker(options).Make(); }

}  // namespace oca::drafts
