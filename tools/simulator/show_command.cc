// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/show_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/record/page.h"
#include "oca/diagrams/record/robot_record.h"
#include "oca/diagrams/runs/output_files.h"
#include "oca/models/counted.h"
#include "oca/models/opened_files.h"
#include "oca/models/whole_file.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/file_name.h"
#include "tools/simulator/live_commands.h"
#include "tools/simulator/robot_options.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

constexpr std::size_t kMostTold = 20;  // warnings on the terminal

struct ShowArguments {
  RobotArguments robot;
  std::string srdf;    ///< empty: none
  std::string output;  ///< HTML file; empty: serve the page
  ViewArguments view;
};

/// A robot's record, and what a terminal is told of its load: a line a kind, where the page has one
/// at each link.
struct ShownRobot {
  record::RobotRecord record;
  std::vector<std::string> lines;
};

ShownRobot ReadRobot(const ShowArguments& arguments) {
  robot::LoadOptions options = LoadOptionsOf(arguments.robot);
  record::RobotSource source;
  source.file = arguments.robot.urdf;
  source.srdf = arguments.srdf;
  source.remedy = "--visual-as-collision missing";
  if (!arguments.srdf.empty()) options.srdf = files::ResolvePath(arguments.srdf, {}, {});
  ShownRobot robot;
  options.warn = [&robot](const std::string& line) { robot.lines.push_back(line); };
  options.warn_each = [&source](const std::string& line) { source.warnings.push_back(line); };
  const auto model = std::make_shared<const robot::RobotModel>(
      robot::LoadUrdf(files::ResolvePath(arguments.robot.urdf, {}, {}), options));
  robot.record = record::RecordRobot(model, source);
  // Those of the load are the first.
  robot.lines.insert(robot.lines.end(), robot.record.warnings.begin() + std::ssize(source.warnings),
                     robot.record.warnings.end());
  return robot;
}

int ShowCommand(const ShowArguments& arguments) {
  models::OpenedFiles opened;
  auto [record, lines] = ReadRobot(arguments);
  const std::size_t told = std::min(lines.size(), kMostTold);
  for (const std::string& line : std::span(lines).first(told)) {
    Tell("{}: warning: {}\n", arguments.robot.urdf, line);
  }
  if (lines.size() > told) {
    Tell("{}: {}, on the page\n", arguments.robot.urdf,
         models::Counted(lines.size() - told, "more warning"));
  }
  if (arguments.output.empty()) {
    return ServeRecord(arguments.robot.urdf, std::move(record.mcap), arguments.view);
  }
  runs::CheckOutputs({{"--output", arguments.output}},
                     runs::InputsOf(opened.files(), "what the robot is read from"));
  models::WriteWhole(arguments.output, record::PageWithRecord(record::LoadPage(), record.mcap));
  Tell("wrote {}\n", arguments.output);
  return kFine;
}

}  // namespace

void AddShow(CLI::App& robot, std::function<int()>& command) {
  CLI::App* const show = robot.add_subcommand(
      "show", "move its joints in a browser, beside its collision shapes and warnings");
  const auto arguments = std::make_shared<ShowArguments>();
  AddRobotOptions(*show, arguments->robot);
  show->add_option("--srdf", arguments->srdf,
                   "pairs of links that are not checked for contact: path or package://NAME/PATH")
      ->check(FileName());
  show->add_option("-o,--output", arguments->output,
                   "HTML file to write instead: opens in a browser, offline")
      ->check(FileName());
  AddServerOptions(*show, arguments->view);
  show->callback(
      [&command, arguments] { command = [arguments] { return ShowCommand(*arguments); }; });
}

}  // namespace oca::tools
