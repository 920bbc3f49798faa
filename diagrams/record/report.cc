// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/report.h"

#include <fmt/format.h>

#include <fstream>
#include <utility>

#include "oca/diagrams/record/page.h"
#include "oca/framework/dataflow/error.h"

namespace oca::record {
namespace {

/// Before the run, so that nobody waits for a report that cannot be written.
void RequireWritable(const std::filesystem::path& file) {
  std::error_code ignored;
  const bool there = std::filesystem::exists(file, ignored);
  if (!std::ofstream(file, std::ios::binary | std::ios::app)) {
    throw ConfigError(fmt::format(
        "report: file; got {}, which cannot be written; expected one that can", file.string()));
  }
  if (!there) std::filesystem::remove(file, ignored);
}

RecorderOptions Brief(RecorderOptions options) {
  options.brief = true;
  return options;
}

}  // namespace

Report::Report(std::filesystem::path file, RecorderOptions options)
    : Recording(Brief(std::move(options))), file_(std::move(file)) {}

std::vector<runs::OutputFile> Report::Files(const loading::LoadedDiagram& /*loaded*/) const {
  return {{"report", file_}};
}

void Report::Begin(const runs::RunStart& run) {
  if (!run.continued) {
    page_ = LoadPage();
    RequireWritable(file_);
    Stop();
    sink_.reset();
    bytes_ = std::ostringstream();
    SetSink(sink_.emplace(bytes_, Compression::kZstd));
  }
  Recording::Begin(run);
}

void Report::End(const runs::RunResult& result) {
  Recording::End(result);
  std::ofstream stream(file_, std::ios::binary | std::ios::trunc);
  stream << PageWithRecord(page_, bytes_.view());
  stream.close();
  if (!stream) {
    throw ConfigError(
        fmt::format("report: file; got {}, which could not be written to the end; expected room",
                    file_.string()));
  }
}

}  // namespace oca::record
