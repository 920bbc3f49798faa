// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "oca/diagrams/record/extracted_record.h"
#include "oca/diagrams/record/run_metadata.h"
#include "oca/diagrams/record/run_recorder.h"
#include "oca/diagrams/runs/blind_spots.h"
#include "oca/diagrams/runs/chatter_check.h"
#include "oca/diagrams/runs/run.h"
#include "oca/diagrams/runs/signal_recorder.h"
#include "oca/framework/dataflow/error.h"
#include "oca/version.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/interrupt.h"
#include "tools/simulator/live_commands.h"
#include "tools/simulator/output_files.h"
#include "tools/simulator/report_writer.h"
#include "tools/simulator/run_summary.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

using nlohmann::ordered_json;

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
    logger_.log(Map(level), "t={:.4f} {}", time, text);
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

/// What a warning says, without its place.
std::string TextOf(const std::string& warning) {
  const std::size_t at = warning.find("warning: ");
  return at == std::string::npos ? warning : warning.substr(at);
}

/// All warnings of a record's diagram: while nothing is changed, those that the record was made
/// with (that nothing uses a parameter is seen in the files as they were written, not in the one
/// that was made of them), else the diagram's own. Places are in the record, not in the folder that
/// it was put into.
void GatherWarnings(const record::McapFile& record, const std::string& file,
                    const std::string& folder, bool changed, loading::LoadedDiagram& loaded) {
  const bool own = changed || record.FindMetadata("oca.warnings") == nullptr;
  std::vector<std::string> warnings = own ? loaded.warnings : record::WarningsOf(record);
  for (const std::string& found : runs::ChatterWarnings(loaded)) {
    const bool told = std::any_of(warnings.begin(), warnings.end(), [&](const auto& other) {
      return TextOf(other) == TextOf(found);
    });
    if (!told) warnings.push_back(found);
  }
  for (std::string& warning : warnings) {
    const std::size_t at = warning.find(folder);
    if (at != std::string::npos) warning.replace(at, folder.size(), file);
  }
  loaded.warnings = std::move(warnings);
}

/// A record's own diagram if `file` is a record; with all warnings.
loading::LoadedDiagram Load(const std::string& file, const std::vector<files::Override>& overrides,
                            const files::Catalogue& catalogue,
                            std::optional<record::ExtractedRecord>& extracted) {
  if (!record::IsRecord(file)) {
    loading::LoadedDiagram loaded = loading::LoadDiagram(file, overrides, catalogue);
    runs::AddChatterWarnings(loaded);
    return loaded;
  }
  const auto record = record::McapFile::Read(file);
  extracted.emplace(record);
  loading::LoadedDiagram loaded = extracted->Load(overrides, catalogue);
  GatherWarnings(record, file, extracted->diagram().parent_path().string(), !overrides.empty(),
                 loaded);
  return loaded;
}

/// Records a run into a file.
class FileRecorder {
 public:
  FileRecorder(const RunArguments& arguments, const loading::LoadedDiagram& loaded,
               const std::vector<files::Override>& overrides, Log* log)
      : file_(arguments.record),
        stream_(Open(file_)),
        sink_(stream_, record::ParseCompression(arguments.record_compression)),
        recorder_(loaded, {Version(), overrides}, {&sink_}, log) {}

  record::RunRecorder& recorder() { return recorder_; }
  /// Says what was lost. throws ConfigError if the file could not be written to the end.
  void Finish() {
    if (recorder_.dropped() > 0) {
      Tell("warning: {}: {} samples dropped, the writer was too slow\n", file_,
           recorder_.dropped());
    }
    stream_.close();
    if (!stream_) {
      throw ConfigError(fmt::format("{}: could not be written to the end (disk full?)", file_));
    }
  }

 private:
  static std::ofstream Open(const std::string& file) {
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    if (!stream) throw ConfigError(fmt::format("{}: cannot be written", file));
    return stream;
  }

  std::string file_;
  std::ofstream stream_;
  record::McapSink sink_;
  record::RunRecorder recorder_;
};

/// What the seed drew of a family of scenarios.
ordered_json ToJson(const sampling::Scenario& scenario) {
  ordered_json parameters = ordered_json::object();
  for (const Value::Entry& entry : scenario.parameters) {
    double number = 0.0;
    if (entry.value.integer() != nullptr) {
      parameters[entry.key] = *entry.value.integer();
    } else if (entry.value.number(number)) {
      parameters[entry.key] = number;
    }
  }
  return {{"tries", scenario.tries},
          {"parameters", parameters},
          {"drawn_obstacles", scenario.obstacles}};
}

ordered_json ToJson(const loading::LoadedDiagram& loaded, const runs::RunResult& result) {
  ordered_json expectations = ordered_json::array();
  for (const runs::ExpectationResult& expectation : result.expectations) {
    expectations.push_back(
        {{"name", expectation.name},
         {"value", expectation.value ? ordered_json(*expectation.value) : ordered_json()},
         {"bound", expectation.bound},
         {"at", expectation.at},
         {"ok", expectation.ok}});
  }
  const IntegratorStatistics& integrator = result.statistics.integrator;
  ordered_json json{{"name", loaded.name},
                    {"file", loaded.file},
                    {"seed", loaded.simulator.seed},
                    {"duration", result.duration},
                    {"steps", result.statistics.steps},
                    {"wall_seconds", result.wall_seconds},
                    {"realtime_factor", result.duration / result.wall_seconds},
                    {"metrics", ordered_json::parse(result.metrics)},
                    {"not_seen", runs::BlindSpots(loaded)},
                    {"expectations", expectations},
                    {"integrator",
                     {{"steps", integrator.steps},
                      {"rejected_steps", integrator.rejected_steps},
                      {"derivative_calls", integrator.derivative_calls},
                      {"restarts", integrator.restarts}}},
                    {"interrupted", result.interrupted}};
  if (loaded.scenario.tries > 0) json["scenario"] = ToJson(loaded.scenario);
  if (result.paced) {
    json["overruns"] = result.statistics.overruns;
    json["worst_overrun"] = result.statistics.worst_overrun;
  }
  for (const SystemTime& time : result.profile) {
    json["profile"].push_back(
        {{"system", time.system}, {"calls", time.calls}, {"seconds", time.seconds}});
  }
  if (!result.failure.empty()) json["failure"] = result.failure;
  return json;
}

ExitStatus StatusOf(const runs::RunResult& result) {
  if (!result.failure.empty()) return kRunFailed;
  if (result.interrupted) return kInterrupted;
  return result.ExpectationsMet() ? kFine : kExpectationNotMet;
}

void PrintResult(const RunArguments& arguments, const loading::LoadedDiagram& loaded,
                 const runs::RunResult& result) {
  if (arguments.json) {
    std::cout << ToJson(loaded, result).dump(2, ' ', false, ordered_json::error_handler_t::replace)
              << '\n';
  } else {
    std::cout << RunSummary(loaded, result, WantsColour(STDOUT_FILENO)) << ProfileTable(result);
  }
  if (!result.failure.empty()) Tell("error: {}\n", result.failure);
}

}  // namespace

void CheckRunOutputs(const RunArguments& arguments, const loading::LoadedDiagram& loaded) {
  std::vector<OutputFile> outputs{{"--record", arguments.record}, {"--report", arguments.report}};
  if (!arguments.csv_folder.empty()) {
    outputs.push_back({"--csv", arguments.csv_folder});
    for (const auto& file : runs::SignalFiles(arguments.csv_folder, loaded)) {
      outputs.push_back({"--csv", file});
    }
  }
  std::vector<InputFile> inputs = InputsOf(loaded.opened, "read by what is run");
  inputs.insert(inputs.begin(), {arguments.file, "what is run"});
  CheckOutputs(outputs, inputs);
}

int RunCommand(const RunArguments& arguments, const files::Catalogue& catalogue) {
  std::vector<files::Override> overrides;
  for (const std::string& text : arguments.overrides) {
    overrides.push_back(files::Override::Parse(text));
  }
  if (arguments.seed) overrides.push_back({"simulator.seed", std::to_string(*arguments.seed)});
  if (arguments.live) {
    if (record::IsRecord(arguments.file)) {
      throw ConfigError(
          fmt::format("--live: file; got the record {}; expected a diagram file, or "
                      "`simulator view` to look at a record",
                      arguments.file));
    }
    StderrLog live_log(arguments.log_level);
    CatchInterrupts();
    return RunLiveCommand(arguments, overrides, catalogue, &live_log, Interrupted);
  }
  std::optional<record::ExtractedRecord> extracted;
  const loading::LoadedDiagram loaded = Load(arguments.file, overrides, catalogue, extracted);
  CheckRunOutputs(arguments, loaded);

  for (const std::string& warning : loaded.warnings) Tell("{}\n", warning);
  StderrLog log(arguments.log_level);
  runs::RunOptions options;
  options.duration = arguments.duration;
  options.csv_folder = arguments.csv_folder;
  options.realtime_factor = arguments.realtime;
  options.profile = arguments.profile;
  options.log = &log;
  std::optional<FileRecorder> recorder;
  if (!arguments.record.empty()) {
    recorder.emplace(arguments, loaded, overrides, &log);
    options.observers.push_back(&recorder->recorder());
    options.log = &recorder->recorder();
  }
  std::optional<ReportWriter> report;
  if (!arguments.report.empty()) {
    report.emplace(arguments.report, loaded, overrides, options.log);
    options.observers.push_back(&report->recorder());
    options.log = &report->recorder();
  }
  CatchInterrupts();
  std::optional<ProgressBar> bar;
  if (!arguments.no_progress && IsTerminal(STDERR_FILENO)) {
    bar.emplace(arguments.duration.value_or(loaded.simulator.duration));
  }
  options.progress = [&bar](double time) {
    if (bar) bar->Show(time);
    return !Interrupted();
  };
  const runs::RunResult result = runs::Run(loaded, options);
  bar.reset();
  if (recorder) recorder->Finish();
  if (report) report->Finish();

  PrintResult(arguments, loaded, result);
  return StatusOf(result);
}

}  // namespace oca::tools
