// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/run_files.h"

#include "tools/simulator/terminal.h"

namespace oca::tools {

RunFiles::RunFiles(const RunArguments& arguments, const std::vector<files::Override>& overrides)
    : record_file_(arguments.record) {
  const record::RecorderOptions options{.overrides = overrides};
  if (!arguments.csv_folder.empty()) outputs_.push_back(&csv_.emplace(arguments.csv_folder));
  if (!arguments.record.empty()) {
    outputs_.push_back(&record_.emplace(
        arguments.record, record::ParseCompression(arguments.record_compression), options));
  }
  if (!arguments.report.empty()) {
    outputs_.push_back(&report_.emplace(arguments.report, options));
  }
}

void RunFiles::TellDropped() const {
  if (!record_ || record_->dropped() == 0) return;
  Tell("warning: {}: {} samples dropped, the writer was too slow\n", record_file_,
       record_->dropped());
}

}  // namespace oca::tools
