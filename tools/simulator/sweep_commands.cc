// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/sweep_commands.h"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "oca/diagrams/runs/output_files.h"
#include "oca/diagrams/sweep/merge.h"
#include "oca/diagrams/sweep/results_database.h"
#include "oca/diagrams/sweep/summary.h"
#include "oca/diagrams/sweep/summary_json.h"
#include "oca/diagrams/sweep/sweep_run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/opened_files.h"
#include "oca/version.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/file_name.h"
#include "tools/simulator/interrupt.h"
#include "tools/simulator/sweep_report.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

namespace fs = std::filesystem;
using sweep::Campaign;
using sweep::Results;
using sweep::Shard;

struct SweepArguments {
  Campaign campaign;
  std::vector<std::string> variations;
  std::string folder;
  std::string shard;  ///< empty: as the engine around says
  int jobs{static_cast<int>(std::max(1u, std::thread::hardware_concurrency()))};
  std::optional<double> timeout;
  bool json{false};
  bool no_progress{false};
};

struct MergeArguments {
  std::string folder;
  std::string database;
  std::string lines;
  bool json{false};
  bool markdown{false};
};

std::optional<int> EnvironmentNumber(const char* variable) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) return std::nullopt;
  const std::string_view view(text);
  int number = 0;
  const auto [stop, error] = std::from_chars(view.data(), view.data() + view.size(), number);
  if (error == std::errc() && stop == view.data() + view.size()) return number;
  throw ConfigError(fmt::format("{}: got '{}'; expected a whole number", variable, text));
}

/// The part of a Slurm array or of an MPI job that this process is.
Shard ShardOfSurroundings() {
  Shard shard;
  const char* engine = "SLURM_ARRAY_TASK_ID";
  if (const auto id = EnvironmentNumber(engine)) {
    const int step = std::max(1, EnvironmentNumber("SLURM_ARRAY_TASK_STEP").value_or(1));
    shard.index = (*id - EnvironmentNumber("SLURM_ARRAY_TASK_MIN").value_or(0)) / step;
    shard.count = EnvironmentNumber("SLURM_ARRAY_TASK_COUNT").value_or(1);
  } else if (const auto rank = EnvironmentNumber("OMPI_COMM_WORLD_RANK")) {
    engine = "OMPI_COMM_WORLD_RANK";
    shard.index = *rank;
    shard.count = EnvironmentNumber("OMPI_COMM_WORLD_SIZE").value_or(1);
  } else {
    return shard;
  }
  if (shard.index < 0 || shard.index >= shard.count) {
    throw ConfigError(fmt::format("{}: got part {} of {}; expected --shard I/N", engine,
                                  shard.index, shard.count));
  }
  Tell("shard {} of {}, as {} says\n", shard.index, shard.count, engine);
  return shard;
}

/// A bar on standard error that says how fast it goes and how long it will take.
class SweepBar {
 public:
  explicit SweepBar(bool visible) : visible_(visible) {}
  ~SweepBar() {
    if (visible_) Tell("\r\033[K");
  }
  void Show(std::int64_t done, std::int64_t all) {
    if (first_ < 0) first_ = done;
    if (!visible_ || all == 0) return;
    constexpr int kWidth = 30;
    const auto filled = static_cast<int>(kWidth * done / all);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
    const double rate = static_cast<double>(done - first_) / taken.count();
    std::string rest = "";
    if (rate > 0.0) {
      const auto seconds = static_cast<std::int64_t>(static_cast<double>(all - done) / rate);
      rest = fmt::format(", {:.3g} a second, {}:{:02}:{:02} left", rate, seconds / 3600,
                         seconds / 60 % 60, seconds % 60);
    }
    Tell("\r\033[K[{:#<{}}{:.<{}}] {} of {} runs{}", "", filled, "", kWidth - filled, done, all,
         rest);
  }

 private:
  bool visible_;
  std::int64_t first_{-1};
  std::chrono::steady_clock::time_point start_{std::chrono::steady_clock::now()};
};

bool WantsBar(bool unwanted) { return !unwanted && WantsColour(STDERR_FILENO); }

enum class Form { kTable, kJson, kMarkdown };

int Report(const Results& results, Form form, bool colour) {
  const sweep::Summary summary = sweep::Summarize(results);
  if (form == Form::kJson) {
    WriteData(sweep::SummaryJson(results, summary) + "\n");
  } else if (form == Form::kMarkdown) {
    WriteData(SweepMarkdown(results, summary));
  } else {
    WriteOutput(SweepTable(results, summary, colour));
  }
  if (summary.unfinished > 0) return kRunFailed;
  return summary.unmet > 0 ? kExpectationNotMet : kFine;
}

int SweepCommand(const SweepArguments& arguments, const files::Catalogue& catalogue) {
  Campaign campaign = arguments.campaign;
  campaign.version = Version();
  for (const std::string& text : arguments.variations) {
    campaign.variations.push_back(sweep::Variation::Parse(text));
  }
  campaign.Check();
  if (arguments.jobs < 1 || arguments.jobs > 1024) {
    throw ConfigError(fmt::format("jobs: got {}; expected in [1, 1024]", arguments.jobs));
  }
  const Shard shard =
      arguments.shard.empty() ? ShardOfSurroundings() : Shard::Parse(arguments.shard);
  const fs::path folder(arguments.folder);
  models::OpenedFiles opened;
  const loading::Blueprint blueprint(campaign.file, catalogue);
  for (const std::string& warning : Inspect(campaign, blueprint)) Tell("{}\n", warning);
  std::vector<runs::OutputFile> outputs{{"-o", folder, true}, {"-o", folder / "results.db"}};
  for (const char* const end : {".jsonl", ".jsonl.part", ".timings.jsonl"}) {
    outputs.push_back({"-o", folder / (shard.Stem() + end)});
  }
  std::vector<runs::InputFile> inputs = runs::InputsOf(opened.files(), "read by what is run");
  inputs.insert(inputs.begin(), {campaign.file, "what is run"});
  runs::CheckOutputs(outputs, inputs);
  sweep::ResultFile file(folder, campaign, shard);
  const std::int64_t before = std::ssize(file.results().rows);
  if (before > 0) {
    Tell("{} of {} runs are there already\n", before, CountRuns(campaign, shard));
  }
  CatchInterrupts();
  sweep::SweepOptions options;
  options.jobs = arguments.jobs;
  options.timeout = arguments.timeout;
  options.interrupted = Interrupted;
  std::optional<SweepBar> bar(std::in_place, WantsBar(arguments.no_progress));
  options.progress = [&bar](std::int64_t done, std::int64_t all) { bar->Show(done, all); };
  const auto start = std::chrono::steady_clock::now();
  const bool finished = RunSweep(campaign, blueprint, shard, options, file);
  bar.reset();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  const std::int64_t ran = std::ssize(file.results().rows) - before;
  Tell("{} runs in {:.3g} s, {:.3g} a second, on {} threads\n", ran, taken.count(),
       static_cast<double>(ran) / taken.count(), arguments.jobs);
  if (finished && shard.count == 1) WriteDatabase(folder / "results.db", file.results());
  const int status = Report(file.results(), arguments.json ? Form::kJson : Form::kTable,
                            WantsColour(STDOUT_FILENO));
  if (finished) return status;
  Tell("interrupted: {} of {} runs are kept, the same command goes on with them\n",
       file.results().rows.size(), CountRuns(campaign, shard));
  return kInterrupted;
}

/// A file that holds something else is not ours to replace.
void RequireDatabase(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error) || fs::file_size(file, error) == 0) return;
  constexpr std::string_view kMagic = "SQLite format 3";
  if (models::BeginningOf(file, kMagic.size()) == kMagic) return;
  throw ConfigError(
      fmt::format("-o: {}; got a file that is no database; expected a new one, or one to replace",
                  file.string()));
}

int MergeCommand(const MergeArguments& arguments) {
  const Results results = sweep::MergeShards(arguments.folder);
  const fs::path database = arguments.database.empty() ? fs::path(arguments.folder) / "results.db"
                                                       : fs::path(arguments.database);
  std::vector<runs::InputFile> inputs;
  for (const auto& entry : fs::directory_iterator(arguments.folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("shard-") && !name.starts_with("results.jsonl") &&
        !name.starts_with("results.timings.jsonl")) {
      continue;
    }
    inputs.push_back({entry.path(), "what is merged"});
  }
  runs::CheckOutputs({{"--jsonl", arguments.lines}, {"-o", database}}, inputs);
  RequireDatabase(database);
  if (!arguments.lines.empty()) {
    sweep::WriteResults(arguments.lines, results.campaign, results.rows);
  }
  WriteDatabase(database, results);
  const Form form = arguments.json       ? Form::kJson
                    : arguments.markdown ? Form::kMarkdown
                                         : Form::kTable;
  return Report(results, form, WantsColour(STDOUT_FILENO));
}

/// Digits only: a conversion to an unsigned number would wrap what is negative.
CLI::Validator Digits(std::size_t most) {
  return CLI::Validator(
      [most](std::string& text) -> std::string {
        const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
        if (digits && !text.empty() && text.size() <= most) return "";
        return fmt::format("got '{}'; expected a whole number of at most {} digits", text, most);
      },
      "");
}

void AddSweep(CLI::App& app, std::function<int()>& command, const files::Catalogue& catalogue) {
  CLI::App* const sub =
      app.add_subcommand("sweep", "run many random samples of a diagram file and sum them up");
  const auto arguments = std::make_shared<SweepArguments>();
  Campaign& campaign = arguments->campaign;
  sub->add_option("FILE", campaign.file, "diagram file")->required();
  sub->add_option("--samples", campaign.samples, "how many")->check(Digits(10))->required();
  sub->add_option("--seed", campaign.seed, "of the campaign; each sample's follows from it")
      ->check(Digits(19));
  sub->add_option("-j,--jobs", arguments->jobs, "threads; all processors if left out")
      ->check(Digits(4));
  sub->add_option("--vary", arguments->variations,
                  "PATH=A,B,...: each sample with each value; PATH=uniform(LOWER, UPPER[, "
                  "step=STEP]), integers(LOWER, UPPER), choice(A, B, ...): drawn for each sample")
      ->allow_extra_args(false);
  sub->add_option("-s,--set", campaign.overrides, "PATH=VALUE: override a value of the file")
      ->allow_extra_args(false);
  sub->add_option("-t,--duration", campaign.duration, "seconds to simulate, not the file's");
  sub->add_option("-o,--output", arguments->folder,
                  "folder of the results; what is in it of the "
                  "same campaign is not run again")
      ->required()
      ->check(FileName());
  sub->add_option("--shard", arguments->shard,
                  "I/N: run samples I, I + N, ... alone; for `merge`. By itself within a Slurm "
                  "array or mpirun");
  sub->add_option("--arrival", campaign.arrival, "final error that counts as arrived, rad or m")
      ->capture_default_str();
  sub->add_option("--timeout", arguments->timeout, "seconds of the wall clock that a run may take")
      ->check(CLI::Range(1e-3, 1e9));
  sub->add_flag("--json", arguments->json, "print one JSON object instead of the table");
  sub->add_flag("--no-progress", arguments->no_progress, "no progress bar");
  sub->callback([&command, &catalogue, arguments] {
    command = [arguments, &catalogue] { return SweepCommand(*arguments, catalogue); };
  });
}

}  // namespace

void AddSweepCommands(CLI::App& app, std::function<int()>& command,
                      const files::Catalogue& catalogue) {
  AddSweep(app, command, catalogue);
  CLI::App* const merge =
      app.add_subcommand("merge", "put the shards of a sweep together and sum them up");
  const auto arguments = std::make_shared<MergeArguments>();
  merge->add_option("DIR", arguments->folder, "folder of the shards")->required();
  merge
      ->add_option("-o,--output", arguments->database,
                   "SQLite database to write; DIR/results.db if left out")
      ->check(FileName());
  merge->add_option("--jsonl", arguments->lines, "file to write all results to, as JSON lines")
      ->check(FileName());
  CLI::Option* const json =
      merge->add_flag("--json", arguments->json, "print one JSON object instead of the table");
  merge
      ->add_flag("--markdown", arguments->markdown, "print the table as Markdown, without failures")
      ->excludes(json);
  merge->callback(
      [&command, arguments] { command = [arguments] { return MergeCommand(*arguments); }; });
}

}  // namespace oca::tools
