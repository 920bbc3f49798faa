// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/record/run_source.h"
#include "oca/diagrams/runs/result_json.h"
#include "oca/diagrams/runs/run.h"
#include "oca/models/foreign_text.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/interrupt.h"
#include "tools/simulator/live_commands.h"
#include "tools/simulator/run_summary.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

/// What systems log, on standard error.
class StderrLog final : public Log {
 public:
  explicit StderrLog(const std::string& level)
      : logger_("oca", std::make_shared<spdlog::sinks::stderr_color_sink_mt>()) {
    logger_.set_level(spdlog::level::from_str(level));
    logger_.set_pattern("%^%l%$ %v");
  }
  bool enabled(LogLevel level) const override { return logger_.should_log(Map(level)); }
  void Write(LogLevel level, double time, std::string_view text) override {
    logger_.log(Map(level), "t={:.4f} {}", time, models::internal::Harmless(text));
  }

 private:
  static spdlog::level::level_enum Map(LogLevel level) {
    switch (level) {
      case LogLevel::kDebug:
        return spdlog::level::debug;
      case LogLevel::kInfo:
        return spdlog::level::info;
      default:
        return spdlog::level::warn;
    }
  }
  mutable spdlog::logger logger_;
};

ExitStatus StatusOf(const runs::RunResult& result) {
  if (result.failure) return kRunFailed;
  if (result.interrupted) return kInterrupted;
  return result.ExpectationsMet() ? kFine : kExpectationNotMet;
}

void PrintResult(const RunArguments& arguments, const loading::LoadedDiagram& loaded,
                 const runs::RunResult& result) {
  if (arguments.json) {
    WriteData(runs::ResultJson(loaded, result) + "\n");
  } else {
    WriteOutput(RunSummary(loaded, result, WantsColour(STDOUT_FILENO)) + ProfileTable(result));
  }
  if (result.failure) Tell("error: {}\n", result.failure->message);
}

std::vector<files::Override> OverridesOf(const RunArguments& arguments) {
  std::vector<files::Override> overrides;
  for (const std::string& text : arguments.overrides) {
    overrides.push_back(files::Override::Parse(text));
  }
  if (arguments.seed) overrides.push_back({"simulator.seed", std::to_string(*arguments.seed)});
  return overrides;
}

}  // namespace

int RunCommand(const RunArguments& arguments, const files::Catalogue& catalogue) {
  const std::vector<files::Override> overrides = OverridesOf(arguments);
  StderrLog log(arguments.log_level);
  if (arguments.live) return RunLiveCommand(arguments, overrides, catalogue, &log);
  // What a record brings along is put into a folder, which must go whenever the program ends.
  if (record::IsRecord(arguments.file)) CatchInterrupts();
  const record::RunSource source(arguments.file, overrides, catalogue);
  if (Interrupted()) return kInterrupted;
  const loading::LoadedDiagram& loaded = source.loaded();
  RunFiles files(arguments.files, overrides);
  std::optional<ProgressBar> bar;
  runs::RunOptions options;
  options.duration = arguments.duration;
  options.realtime_factor = arguments.realtime;
  options.profile = arguments.profile;
  options.log = &log;
  options.outputs = files.outputs();
  options.inputs = {{arguments.file, "what is run"}};
  options.progress = [&bar](double time) {
    if (bar) bar->Show(time);
    return !Interrupted();
  };
  runs::CheckRunFiles(loaded, options);
  for (const std::string& warning : loaded.warnings) Tell("{}\n", warning);
  CatchInterrupts();
  if (!arguments.no_progress && IsTerminal(STDERR_FILENO)) {
    bar.emplace(arguments.duration.value_or(loaded.simulator.duration));
  }
  const runs::RunResult result = runs::Run(loaded, options);
  bar.reset();
  files.TellDropped();
  PrintResult(arguments, loaded, result);
  return StatusOf(result);
}

}  // namespace oca::tools
