// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "oca/diagrams/drafts/draft.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/record/page.h"
#include "oca/diagrams/record/report.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/interrupt.h"
#include "tools/simulator/run_summary.h"
#include "tools/simulator/terminal.h"
#include "tools/simulator/xacro_arguments.h"

namespace oca::tools {
namespace {

namespace fs = std::filesystem;

/// The robot's file without its endings.
fs::path FolderOf(const NewArguments& arguments, const fs::path& robot) {
  if (!arguments.folder.empty()) return arguments.folder;
  const std::string name = robot.filename().string();
  return name.substr(0, name.find('.'));
}

void PrintRobot(const drafts::DraftRobot& robot) {
  const robot::RobotModel& model = *robot.model;
  Print("robot '{}': {} joints, tip '{}', reach about {:.2g} m\n", model.name().text(),
        model.num_positions(), model.links()[static_cast<std::size_t>(robot.tip)].name.text(),
        robot.reach);
  if (!robot.held.empty()) {
    std::vector<std::string> joints;
    for (const auto& [joint, position] : robot.held) {
      joints.push_back(fmt::format("{} at {:.4g}", joint, position));
    }
    Print("held, as not of the arm: {}\n", fmt::join(joints, ", "));
  }
}

void PrintWithout(const runs::RunResult& result) {
  if (!result.metrics || !result.metrics->min_distance) {
    Print("without avoidance: nothing is known\n");
    return;
  }
  const robot::MotionMetricsValue& metrics = *result.metrics;
  const double distance = *metrics.min_distance;
  Print("without avoidance: {} of {} with {}, {:.3f} m{}\n",
        distance <= 0.0 ? "CONTACT" : "no contact", metrics.min_distance_link.text(),
        metrics.min_distance_obstacle.text(), std::abs(distance),
        distance <= 0.0 ? " deep" : " apart");
}

/// Without the page of reports, which Node builds, the run is told of all the same.
bool HasPage() {
  try {
    record::LoadPage();
    return true;
  } catch (const ConfigError& error) {
    Tell("warning: no report: {}\n", error.what());
    return false;
  }
}

}  // namespace

int NewCommand(const NewArguments& arguments) {
  CatchInterrupts();
  drafts::DraftOptions options;
  options.robot = files::ResolvePath(arguments.robot, {}, {});
  if (arguments.robot.starts_with("package://")) options.named = arguments.robot;
  options.arguments = ParseXacroArguments(arguments.arguments);
  options.srdf = arguments.srdf;
  options.group = arguments.group;
  options.avoidance = arguments.avoidance;
  options.folder = FolderOf(arguments, options.robot);
  options.seed = arguments.seed;
  options.tries = arguments.tries;
  options.warn = [](const std::string& line) { Tell("warning: {}\n", line); };
  std::optional<TaskProgress> progress(std::in_place);
  options.progress = [&progress](const std::string& task, double share) {
    progress->Show(task, share);
    return !Interrupted();
  };
  const drafts::Draft draft = drafts::MakeDraft(options);
  progress.reset();
  if (draft.files.empty()) return kInterrupted;
  PrintRobot(draft.robot);
  for (const fs::path& file : draft.files) Print("wrote {}\n", file.string());
  PrintWithout(draft.attempt.without);
  const loading::LoadedDiagram loaded = loading::LoadDiagram(draft.diagram);
  fs::path page = draft.diagram;
  record::Report report(page.replace_extension(".html"));
  runs::RunOptions run;
  run.progress = [](double) { return !Interrupted(); };
  if (HasPage()) run.outputs = {&report};
  const runs::RunResult result = runs::Run(loaded, run);
  Print("with '{}':\n{}", arguments.avoidance,
        RunSummary(loaded, result, WantsColour(STDOUT_FILENO)));
  if (!run.outputs.empty()) Print("report: {}\n", page.string());
  Print("next:   simulator run {} --live\n", draft.diagram.string());
  if (result.failure) {
    Tell("error: {}\n", result.failure->message);
    return kRunFailed;
  }
  if (result.interrupted) return kInterrupted;
  return draft.attempt.contact() && result.ExpectationsMet() ? kFine : kExpectationNotMet;
}

}  // namespace oca::tools
