// SPDX-License-Identifier: BSD-3-Clause
#include "oca/tools/simulator/simulator_main.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/foreign_text.h"
#include "oca/models/geometry/decomposition.h"
#include "oca/version.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/file_name.h"
#include "tools/simulator/interrupt.h"
#include "tools/simulator/live_commands.h"
#include "tools/simulator/record_commands.h"
#include "tools/simulator/scene_commands.h"
#include "tools/simulator/show_command.h"
#include "tools/simulator/sweep_commands.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

/// Digits only: a conversion to an unsigned number would wrap what is negative.
CLI::Validator WholeNumber(std::size_t most_digits) {
  return CLI::Validator(
      [most_digits](std::string& text) -> std::string {
        const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
        if (digits && !text.empty() && text.size() <= most_digits) return "";
        return fmt::format("got '{}'; expected a whole number of at most {} digits", text,
                           most_digits);
      },
      "");
}

/// The command line: one subcommand, whose arguments are bound to the structs of commands.h.
class CommandLine {
 public:
  explicit CommandLine(const files::Catalogue& catalogue) : catalogue_(catalogue) {
    app_.require_subcommand(1);
    app_.set_version_flag("--version", std::string("simulator (OCA) ") + Version());
    AddNew();
    AddSceneCommands(app_, command_);
    AddRun();
    AddView();
    AddFileCommands();
    AddCatalogueCommands();
    AddRecordCommands(app_, command_);
    AddSweepCommands(app_, command_, catalogue_);
    AddRobot();
  }

  int Main(int argc, char** argv) {
    try {
      app_.parse(Words(argc, argv));
    } catch (const CLI::Success& help_or_version) {
      return app_.exit(help_or_version);
    } catch (const CLI::ParseError& error) {
      return Usage(error, argc, argv);
    }
    TaskProgress progress;
    const geometry::DecompositionListener listener([&](std::string_view mesh, double share) {
      const std::string file = std::filesystem::path(mesh).filename().string();
      progress.Show(fmt::format("decomposing '{}' into convex parts, which are kept",
                                models::internal::AsUtf8(file)),
                    share);
    });
    try {
      const int status = command_();
      if (!FlushOutput()) return kRunFailed;
      // One that came when there was nothing left to end counts too.
      return status == kFine && Interrupted() ? kInterrupted : status;
    } catch (const SimulationError& error) {
      Tell("error: {}\n", error.what());
      return kRunFailed;
    } catch (const Error& error) {
      Tell("{}\n", error.what());
    }
    return kBadInput;
  }

 private:
  /// The words of the command line, last first as CLI11 wants them. `--realtime` alone would take
  /// the word after it for its factor.
  static std::vector<std::string> Words(int argc, char** argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    std::replace(words.begin(), words.end(), std::string("--realtime"),
                 std::string("--realtime=1"));
    std::replace(words.begin(), words.end(), std::string("--live"), std::string("--live=8765"));
    std::reverse(words.begin(), words.end());
    return words;
  }

  void AddNew() {
    CLI::App* const command = app_.add_subcommand(
        "new", "write a first diagram for a robot, run it and make a report of the run");
    command->add_option("ROBOT", new_.robot, "URDF or xacro: path or package://NAME/PATH")
        ->required();
    command->add_option("--argument", new_.arguments, "NAME=VALUE: argument of a xacro")
        ->allow_extra_args(false);
    command->add_option("--srdf", new_.srdf, "its SRDF; without it one is written by sampling")
        ->check(FileName());
    command->add_option("--group", new_.group,
                        "group of the SRDF that is the arm; or it is guessed");
    command->add_option("--avoidance", new_.avoidance, "method of avoidance")
        ->capture_default_str();
    command->add_option("-o,--output", new_.folder, "folder for the files, instead of ./ROBOT")
        ->check(FileName());
    command->add_option("--seed", new_.seed, "of the postures that are looked at")
        ->check(WholeNumber(19))
        ->capture_default_str();
    command->add_option("--tries", new_.tries, "motions to run, until one is evaded")
        ->check(WholeNumber(3) & CLI::Range(1, 999))
        ->capture_default_str();
    command->callback([this] { command_ = [this] { return NewCommand(new_); }; });
  }

  void AddRun() {
    CLI::App* const run = app_.add_subcommand("run", "run a diagram file and judge the motion");
    run->add_option("FILE", run_.file, "diagram file, or a record of a run")->required();
    run->add_option("-s,--set", run_.overrides, "PATH=VALUE: override a value of the file")
        ->allow_extra_args(false);
    run->add_option("-t,--duration", run_.duration, "seconds to simulate, instead of the file's");
    run->add_option("--seed", run_.seed, "seed of everything random")
        ->check(WholeNumber(10) & CLI::Range(0.0, 2147483647.0));
    AddFileOptions(*run, run_.files);
    CLI::Option* const live =
        run->add_option("--live", run_.live,
                        "show the run while it goes on, to browsers and Foxglove: =PORT, or 8765")
            ->check(CLI::Range(0, 65535));
    run->add_option("--live-address", run_.live_address, "address to show it on")
        ->capture_default_str();
    run->add_option("--live-origin", run_.live_origins,
                    "page that may connect too: SCHEME://HOST[:PORT], foxglove or lichtblick")
        ->allow_extra_args(false);
    run->add_option("--realtime", run_.realtime,
                    "hold to the wall clock: =FACTOR simulated seconds a second, or 1");
    run->add_flag("--profile", run_.profile, "print what each system took")->excludes(live);
    run->add_flag("--json", run_.json, "print one JSON object instead of the summary")
        ->excludes(live);
    run->add_flag("--no-progress", run_.no_progress, "no progress bar");
    run->add_option("--log-level", run_.log_level, "least level that is logged")
        ->check(CLI::IsMember({"debug", "info", "warning", "off"}));
    run->callback([this] { command_ = [this] { return RunCommand(run_, catalogue_); }; });
  }

  void AddView() {
    CLI::App* const view = app_.add_subcommand("view", "show a record in a browser");
    view->add_option("FILE", view_.file, "record (.mcap)")->required();
    AddServerOptions(*view, view_);
    view->callback([this] { command_ = [this] { return ViewCommand(view_); }; });
  }

  /// What is said of a diagram file without a run of it.
  void AddFileCommands() {
    CLI::App* const check = app_.add_subcommand("check", "find all errors of diagram files");
    check->add_option("FILE", check_files_, "diagram files")->required();
    check->add_option("-s,--set", check_overrides_, "PATH=VALUE: override a value of the files")
        ->allow_extra_args(false);
    check->callback([this] {
      command_ = [this] { return CheckCommand(check_files_, check_overrides_, catalogue_); };
    });

    CLI::App* const plan = app_.add_subcommand(
        "plan", "say whether an optimiser that knows the whole script finds a clear motion");
    plan->add_option("FILE", plan_.file, "diagram file with a request that is known ahead")
        ->required();
    plan->add_option("-s,--set", plan_.overrides, "PATH=VALUE: override a value of the file")
        ->allow_extra_args(false);
    plan->add_option("--seed", plan_.seed, "of the scenario, instead of the file's")
        ->check(WholeNumber(10) & CLI::Range(0.0, 2147483647.0));
    plan->add_option("--samples", plan_.samples, "scenarios with this seed and those after it")
        ->check(WholeNumber(9) & CLI::Range(1, 1000000000));
    plan->add_option("--starts", plan_.starts, "motions that it tries beside the request")
        ->check(WholeNumber(5))
        ->capture_default_str();
    plan->add_option("--model", plan_.model, "the robot; needed if the file judges several");
    plan->add_option("-t,--duration", plan_.duration, "s, instead of the file's");
    plan->add_option("--reference", plan_.reference,
                     "also seek the shortest way, in ten searches of so many seconds")
        ->check(CLI::Range(0.0, 3600.0));
    plan->footer(PlanFooter());
    plan->callback([this] { command_ = [this] { return PlanCommand(plan_, catalogue_); }; });

    CLI::App* const graph = app_.add_subcommand("graph", "draw a diagram file");
    graph->add_option("FILE", graph_.file, "diagram file")->required();
    graph->add_option("--format", graph_.format, "dot, svg or mermaid")
        ->check(CLI::IsMember({"dot", "svg", "mermaid"}));
    graph->add_option("-s,--set", graph_.overrides, "PATH=VALUE: override a value of the file")
        ->allow_extra_args(false);
    graph->callback([this] { command_ = [this] { return GraphCommand(graph_, catalogue_); }; });
  }

  void AddCatalogueCommands() {
    app_.add_subcommand("list", "the system types, a line each")->callback([this] {
      command_ = [this] { return ListCommand(catalogue_); };
    });
    CLI::App* const describe =
        app_.add_subcommand("describe", "ports, parameters, equation and source of a system type");
    describe->add_option("TYPE", described_, "system type")->required();
    describe->callback(
        [this] { command_ = [this] { return DescribeCommand(described_, catalogue_); }; });
    app_.add_subcommand("schema", "JSON Schema of diagram files, for editors")->callback([this] {
      command_ = [this] { return SchemaCommand(catalogue_); };
    });
    CLI::App* const docs =
        app_.add_subcommand("docs", "a page of the reference in Markdown, from what is built in");
    docs->add_option("PAGE", page_, "systems or diagram_file")
        ->required()
        ->check(CLI::IsMember({"systems", "diagram_file"}));
    docs->callback([this] { command_ = [this] { return DocsCommand(page_, catalogue_); }; });

    CLI::App* const eval = app_.add_subcommand(
        "eval", "feed one system JSON lines of inputs, get JSON lines of outputs");
    eval->add_option("TYPE", eval_.type, "system type")->required();
    eval->add_option("--params", eval_.params, "its parameters as JSON");
    eval->add_option(
            "--model", eval_.models,
            "NAME=URDF, or xacro, or an entry of `models` as JSON: a robot that parameters name")
        ->allow_extra_args(false);
    eval->add_option("--argument", eval_.arguments, "MODEL.NAME=VALUE: argument of a xacro")
        ->allow_extra_args(false);
    eval->callback([this] {
      command_ = [this] { return EvalCommand(eval_, catalogue_, std::cin, std::cout); };
    });
  }

  void AddRobot() {
    CLI::App* const robot = app_.add_subcommand("robot", "look at a robot's description");
    robot->require_subcommand(1);
    CLI::App* const check = robot->add_subcommand(
        "check-collisions", "find the pairs of links that need no check for collision");
    AddRobotOptions(*check, collisions_.robot);
    check
        ->add_option("--write-srdf", collisions_.write_srdf,
                     "file to write the pairs to; what else it holds is kept")
        ->check(FileName());
    check->add_option("--samples", collisions_.samples, "random positions to look at")
        ->check(WholeNumber(8))
        ->capture_default_str();
    check->add_option("--seed", collisions_.seed, "of the random positions")
        ->check(WholeNumber(19))
        ->capture_default_str();
    check
        ->add_option("--margin", collisions_.margin,
                     "m; a pair that comes nearer counts as one that may collide")
        ->capture_default_str();
    check->add_flag("--json", collisions_.json, "print one JSON object instead of the table");
    check->callback([this] { command_ = [this] { return CheckCollisionsCommand(collisions_); }; });
    CLI::App* const expand =
        robot->add_subcommand("expand", "print the URDF that a xacro file stands for");
    expand->add_option("XACRO", expand_.xacro, "path or package://NAME/PATH")->required();
    expand->add_option("--argument", expand_.arguments, "NAME=VALUE: an argument of the file")
        ->allow_extra_args(false);
    expand->add_option("-o,--output", expand_.output, "file to write it to")->check(FileName());
    expand->callback([this] { command_ = [this] { return ExpandCommand(expand_); }; });
    AddShow(*robot, command_);
  }

  /// CLI11 says little of misspelt words; name the nearest ones.
  int Usage(const CLI::ParseError& error, int argc, char** argv) {
    std::vector<std::string> commands;
    for (const CLI::App* command : app_.get_subcommands([](CLI::App*) { return true; })) {
      commands.push_back(command->get_name());
    }
    const std::string first = argc > 1 ? argv[1] : "";
    std::string what = error.what();
    if (first == "robot") {
      what = ExplainRobot(what, argc, argv);
    } else if (std::find(commands.begin(), commands.end(), first) != commands.end()) {
      what = ExplainOption(*app_.get_subcommand(first), what, argc, argv);
    } else if (argc > 1 && !first.starts_with("-")) {
      what = fmt::format("unknown command '{}'{}", first, DidYouMean(first, commands));
    }
    Tell(
        "error: {}\nusage: simulator COMMAND ...; commands: {}; `simulator COMMAND "
        "--help` tells more\n",
        what, fmt::join(commands, ", "));
    return kUsage;
  }

  std::string ExplainRobot(const std::string& what, int argc, char** argv) {
    const std::vector<std::string> commands{"check-collisions", "expand", "show"};
    const std::string second = argc > 2 ? argv[2] : "";
    if (std::find(commands.begin(), commands.end(), second) != commands.end()) {
      return ExplainOption(*app_.get_subcommand("robot")->get_subcommand(second), what, argc, argv);
    }
    if (second.empty() || second.starts_with("-")) {
      return fmt::format("{}: robot {}", what, fmt::join(commands, " or "));
    }
    return fmt::format("unknown command 'robot {}'{}", second, DidYouMean(second, commands));
  }

  static std::string ExplainOption(const CLI::App& command, const std::string& what, int argc,
                                   char** argv) {
    std::vector<std::string> options;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
    }
    for (int i = 2; i < argc; ++i) {
      const std::string word(argv[i]);
      const std::string name = word.substr(0, word.find('='));
      if (!name.starts_with("--") || name == "--") continue;
      if (std::find(options.begin(), options.end(), name) != options.end()) continue;
      return fmt::format("unknown option '{}'{}", name, DidYouMean(name, options));
    }
    return what;
  }

  const files::Catalogue& catalogue_;
  CLI::App app_{"OCA: online collision avoidance of robot arms, from a diagram file", "simulator"};
  std::function<int()> command_;
  NewArguments new_;
  RunArguments run_;
  ViewArguments view_;
  std::vector<std::string> check_files_, check_overrides_;
  PlanArguments plan_;
  GraphArguments graph_;
  std::string described_;
  std::string page_;
  CheckCollisionsArguments collisions_;
  ExpandArguments expand_;
  EvalArguments eval_;
};

}  // namespace

int SimulatorMain(int argc, char** argv, const files::Catalogue& catalogue) {
  PrepareTerminal();
  EndOnInterrupts();
  try {
    return CommandLine(catalogue).Main(argc, argv);
  } catch (const std::exception& error) {
    Tell("error: {}\n", oca::internal::Explain(error));
  } catch (...) {  // of a block of somebody else's
    Tell("error: an exception of an unknown type\n");
  }
  return kRunFailed;
}

}  // namespace oca::tools
