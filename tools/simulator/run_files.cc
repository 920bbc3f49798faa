// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/run_files.h"

#include <CLI/CLI.hpp>

#include "oca/diagrams/record/record.h"
#include "oca/diagrams/record/report.h"
#include "oca/diagrams/runs/csv.h"
#include "tools/simulator/file_name.h"
#include "tools/simulator/terminal.h"

namespace oca::tools {

void AddFileOptions(CLI::App& run, FileArguments& arguments) {
  run.add_option("--csv", arguments.csv_folder, "folder to write the recorded signals to")
      ->check(FileName());
  run.add_option("--record", arguments.record, "MCAP file to record the run into")
      ->check(FileName());
  run.add_option("--record-compression", arguments.record_compression, "none, lz4 or zstd")
      ->check(CLI::IsMember({"none", "lz4", "zstd"}));
  run.add_option("--report", arguments.report, "HTML file of the run: opens in a browser, offline")
      ->check(FileName());
}

RunFiles::RunFiles(const FileArguments& arguments, const std::vector<files::Override>& overrides)
    : record_file_(arguments.record) {
  const record::RecorderOptions options{.overrides = overrides};
  if (!arguments.csv_folder.empty()) {
    outputs_.push_back(std::make_unique<runs::Csv>(arguments.csv_folder));
  }
  if (!arguments.record.empty()) {
    auto record = std::make_unique<record::Record>(
        arguments.record, record::ParseCompression(arguments.record_compression), options);
    record_ = record.get();
    outputs_.push_back(std::move(record));
  }
  if (!arguments.report.empty()) {
    outputs_.push_back(std::make_unique<record::Report>(arguments.report, options));
  }
}

std::vector<runs::RunOutput*> RunFiles::outputs() const {
  std::vector<runs::RunOutput*> outputs;
  for (const auto& output : outputs_) outputs.push_back(output.get());
  return outputs;
}

void RunFiles::TellDropped() const {
  if (record_ == nullptr || record_->dropped() == 0) return;
  Tell("warning: {}: {} samples dropped, the writer was too slow\n", record_file_,
       record_->dropped());
}

}  // namespace oca::tools
