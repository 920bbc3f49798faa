// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/record_commands.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "oca/diagrams/record/comparison.h"
#include "oca/diagrams/record/csv_export.h"
#include "oca/diagrams/record/report_figures.h"
#include "oca/diagrams/runs/output_files.h"
#include "tools/simulator/commands.h"
#include "tools/simulator/file_name.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {
namespace {

/// Reads a record; says so if it was cut.
record::McapFile ReadRecord(const std::string& file) {
  record::McapFile read = record::McapFile::Read(file);
  if (!read.complete()) Tell("warning: {}: {}\n", file, read.problem());
  return read;
}

int ExportCommand(const std::string& file, const std::string& folder) {
  const record::McapFile record = ReadRecord(file);
  std::vector<runs::OutputFile> outputs{{"--csv", folder, true}};
  for (const auto& output : record::ExportedFiles(record, folder)) {
    outputs.push_back({"--csv", output});
  }
  runs::CheckOutputs(outputs, {{file, "what is exported"}});
  const int files = record::ExportCsv(record, folder);
  Print("{}: {} signals\n", folder, files);
  return kFine;
}

std::string Shortened(const std::string& text) {
  constexpr std::size_t kMost = 160;
  if (text.empty()) return "nothing";
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

int CompareCommand(const std::string& first, const std::string& second) {
  const record::Comparison comparison = record::Compare(ReadRecord(first), ReadRecord(second));
  if (comparison.difference) {
    const record::Difference& difference = *comparison.difference;
    Print("first difference at {:.9g} s in {}\n  {}  {}\n  {}  {}\n", difference.time,
          difference.signal, first, Shortened(difference.first), second,
          Shortened(difference.second));
  } else {
    Print("no difference in {} messages\n", comparison.messages);
  }
  if (!comparison.metrics.empty()) Print("\n  {:<31} {:<26} {}\n", "metric", first, second);
  for (const auto& metric : comparison.metrics) {
    Print("{} {:<31} {:<26} {}\n", metric.first == metric.second ? ' ' : '*', metric.name,
          metric.first.empty() ? "-" : metric.first, metric.second.empty() ? "-" : metric.second);
  }
  return comparison.difference ? kRunFailed : kFine;
}

void AddPlot(CLI::App& app, std::function<int()>& command) {
  CLI::App* const plot =
      app.add_subcommand("plot", "draw recorded signals, of several runs at once");
  const auto arguments = std::make_shared<PlotArguments>();
  plot->add_option("RECORD", arguments->records,
                   "records of runs; of sweeps their folders, for method-comparison");
  plot->add_option("--signal", arguments->signals,
                   "system.port or system.port.joint with * and ?; a panel each")
      ->allow_extra_args(false);
  std::vector<std::string> figures = record::FigureNames();
  figures.push_back("method-comparison");
  plot->add_option("--figure", arguments->figure,
                   "a figure of the report, from runs of our own, or what sweeps reached")
      ->check(CLI::IsMember(figures));
  plot->add_option("-o,--output", arguments->output, "file to write, .svg or .png")
      ->required()
      ->check(FileName());
  plot->callback(
      [&command, arguments] { command = [arguments] { return PlotCommand(*arguments); }; });
}

}  // namespace

void AddRecordCommands(CLI::App& app, std::function<int()>& command) {
  CLI::App* const exported = app.add_subcommand("export", "write the signals of a record as CSV");
  const auto files = std::make_shared<std::pair<std::string, std::string>>();
  exported->add_option("RECORD", files->first, "record of a run")->required();
  exported->add_option("--csv", files->second, "folder to write to")->required()->check(FileName());
  exported->callback([&command, files] {
    command = [files] { return ExportCommand(files->first, files->second); };
  });

  CLI::App* const compare =
      app.add_subcommand("compare", "find where two records first differ, and in which metrics");
  const auto both = std::make_shared<std::pair<std::string, std::string>>();
  compare->add_option("FIRST", both->first, "record of a run")->required();
  compare->add_option("SECOND", both->second, "record of another run")->required();
  compare->callback(
      [&command, both] { command = [both] { return CompareCommand(both->first, both->second); }; });
  AddPlot(app, command);
}

}  // namespace oca::tools
