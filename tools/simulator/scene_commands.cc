// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/scene_commands.h"

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "oca/diagrams/drafts/scene_draft.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/models/random.h"
#include "oca/models/scenes/scene_families.h"
#include "oca/models/scenes/scene_problem.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/file_name.h"
#include "tools/simulator/interrupt.h"
#include "tools/simulator/terminal.h"
#include "tools/simulator/xacro_arguments.h"

namespace oca::tools {
namespace {

struct ImportArguments {
  std::string scene;
  std::string request;                 ///< empty: none
  std::string robot;                   ///< URDF or xacro
  std::vector<std::string> arguments;  ///< NAME=VALUE, of a xacro
  std::string srdf;
  std::string group;
  std::string avoidance{"recommended"};
  std::string diagram;
  bool intruder{false};
};

int ImportCommand(const ImportArguments& arguments) {
  drafts::SceneDraftOptions options;
  drafts::DraftOptions& draft = options.draft;
  draft.robot = files::ResolvePath(arguments.robot, {}, {});
  if (arguments.robot.starts_with("package://")) draft.named = arguments.robot;
  draft.arguments = ParseXacroArguments(arguments.arguments);
  if (!arguments.srdf.empty()) draft.srdf = files::ResolvePath(arguments.srdf, {}, {});
  if (arguments.srdf.starts_with("package://")) draft.named_srdf = arguments.srdf;
  draft.group = arguments.group;
  draft.avoidance = arguments.avoidance;
  draft.warn = [](const std::string& line) { Tell("warning: {}\n", line); };
  options.scene = arguments.scene;
  options.request = arguments.request;
  options.diagram = arguments.diagram;
  options.intruder = arguments.intruder;
  const drafts::SceneDraft scene = drafts::DraftScene(options);
  const robot::RobotModel& model = *scene.robot.model;
  Print("robot '{}': {} joints; {} obstacles, {} held objects\n", model.name().text(),
        model.num_positions(), scene.obstacles, scene.held);
  for (const auto& file : scene.files) Print("wrote {}\n", file.string());
  for (const std::string& line : scene.decided) Print("decided:  {}\n", line);
  for (const std::string& line : scene.left_out) Print("left out: {}\n", line);
  Print("next:     simulator run {} --live\n", scene.files.front().string());
  return kFine;
}

struct ScenesArguments {
  std::string robot;                   ///< URDF or xacro
  std::vector<std::string> arguments;  ///< NAME=VALUE, of a xacro
  std::string srdf;
  std::string group;
  std::vector<std::string> families;  ///< none: all
  int samples{10};
  std::uint64_t seed{0};
  std::string folder;
};

int ScenesCommand(const ScenesArguments& arguments) {
  CatchInterrupts();
  drafts::DraftOptions options;
  options.robot = files::ResolvePath(arguments.robot, {}, {});
  options.arguments = ParseXacroArguments(arguments.arguments);
  if (!arguments.srdf.empty()) options.srdf = files::ResolvePath(arguments.srdf, {}, {});
  options.group = arguments.group;
  options.warn = [](const std::string& line) { Tell("warning: {}\n", line); };
  const drafts::DraftRobot robot = drafts::ReadDraftRobot(options);
  std::vector<std::string> families = arguments.families;
  if (families.empty()) families = {scenes::kSceneFamilies.begin(), scenes::kSceneFamilies.end()};
  TaskProgress progress;
  for (const std::string& family : families) {
    int tries = 0;
    for (int i = 1; i <= arguments.samples; ++i) {
      progress.Show(family, static_cast<double>(i - 1) / arguments.samples);
      if (Interrupted()) return kInterrupted;
      const auto seed = models::Random::Seed(arguments.seed, static_cast<std::uint64_t>(i));
      const auto problem = scenes::MakeSceneProblem(robot.model, robot.tip, family, seed);
      tries += problem.tries;
      drafts::WriteSceneProblem(std::filesystem::path(arguments.folder) / family, i, *robot.model,
                                problem);
    }
    progress.Show(family, 1.0);
    Print("{}: {} problems of {} scenes that were drawn\n", family, arguments.samples, tries);
  }
  return kFine;
}

void AddScenes(CLI::App& app, std::function<int()>& command) {
  const auto arguments = std::make_shared<ScenesArguments>();
  CLI::App* const scenes = app.add_subcommand(
      "scenes", "make planning scenes and requests for an arm, as MoveIt writes them");
  scenes->add_option("ROBOT", arguments->robot, "URDF or xacro: path or package://NAME/PATH")
      ->required();
  scenes->add_option("--argument", arguments->arguments, "NAME=VALUE: argument of a xacro")
      ->allow_extra_args(false);
  scenes->add_option("--srdf", arguments->srdf, "its SRDF: path or package://NAME/PATH");
  scenes->add_option("--group", arguments->group,
                     "group of the SRDF that is the arm; or it is guessed");
  const std::vector<std::string> families(oca::scenes::kSceneFamilies.begin(),
                                          oca::scenes::kSceneFamilies.end());
  scenes
      ->add_option("--family", arguments->families, "of scenes; may be given again; all without it")
      ->check(CLI::IsMember(families))
      ->allow_extra_args(false);
  scenes->add_option("--samples", arguments->samples, "problems of each family")
      ->check(CLI::Range(1, 9999))
      ->capture_default_str();
  scenes->add_option("--seed", arguments->seed, "of what is drawn")->capture_default_str();
  scenes
      ->add_option("-o,--output", arguments->folder,
                   "folder for FAMILY/sceneNNNN.yaml and requestNNNN.yaml")
      ->required()
      ->check(FileName());
  scenes->footer(
      "Start and goal are 0.01 m from everything, and a search knows a way. The same seed makes "
      "the "
      "same bytes. More: docs/how-to/import_scene.md.");
  scenes->callback(
      [&command, arguments] { command = [arguments] { return ScenesCommand(*arguments); }; });
}

void AddImport(CLI::App& app, std::function<int()>& command) {
  const auto arguments = std::make_shared<ImportArguments>();
  CLI::App* const import = app.add_subcommand(
      "import", "write a diagram file of a planning scene and a motion request as MoveIt has them");
  import->add_option("SCENE", arguments->scene, "planning scene: YAML, or text named .scene")
      ->required();
  import->add_option("REQUEST", arguments->request,
                     "motion plan request in YAML; without it the arm rests");
  import->add_option("--robot", arguments->robot, "URDF or xacro: path or package://NAME/PATH")
      ->required();
  import->add_option("--argument", arguments->arguments, "NAME=VALUE: argument of a xacro")
      ->allow_extra_args(false);
  import->add_option("--srdf", arguments->srdf,
                     "its SRDF: path or package://NAME/PATH; without it, and without allowed "
                     "collisions in the scene, one is written by sampling");
  import->add_option("--group", arguments->group,
                     "group of the SRDF that is the arm, instead of the request's");
  import->add_option("--avoidance", arguments->avoidance, "method of avoidance")
      ->capture_default_str();
  import->add_flag("--intruder", arguments->intruder,
                   "a ball flies at the arm besides; the seed of a run says from where");
  import->add_option("-o,--output", arguments->diagram, "diagram file to write")
      ->required()
      ->check(FileName());
  import->footer(
      "What was decided and what was left out stands on standard output, a line each. "
      "More: docs/how-to/import_scene.md.");
  import->callback(
      [&command, arguments] { command = [arguments] { return ImportCommand(*arguments);
};
}  // namespace
);
}  // namespace oca::tools

}  // namespace

void AddSceneCommands(CLI::App& app, std::function<int()>& command) {
  AddImport(app, command);
  AddScenes(app, command);
}

}  // namespace oca::tools
