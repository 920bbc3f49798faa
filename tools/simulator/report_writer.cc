// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/report_writer.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "oca/diagrams/live/page.h"
#include "oca/framework/dataflow/error.h"
#include "oca/version.h"

namespace oca::tools {
namespace {

/// Before the run, so that nobody waits for a report that cannot be written; leaves no empty file.
std::string Writable(const std::string& file) {
  std::error_code ignored;
  const bool there = std::filesystem::exists(file, ignored);
  if (!std::ofstream(file, std::ios::binary | std::ios::app)) {
    throw ConfigError(fmt::format(
        "--report: file; got {}, which cannot be written; expected one that can", file));
  }
  if (!there) std::filesystem::remove(file, ignored);
  return file;
}

}  // namespace

ReportWriter::ReportWriter(const std::string& file, const loading::LoadedDiagram& loaded,
                           const std::vector<files::Override>& overrides, Log* log)
    : page_(live::LoadPage()),
      file_(Writable(file)),
      sink_(bytes_, record::Compression::kZstd),
      recorder_(loaded,
                {.version = Version(),
                 .overrides = overrides,
                 .start_epoch = 0,
                 .attach_files = true,
                 .brief = true},
                {&sink_}, log) {}

void ReportWriter::Finish() {
  std::ofstream stream(file_, std::ios::binary | std::ios::trunc);
  stream << live::PageWithRecord(page_, bytes_.view());
  stream.close();
  if (!stream) {
    throw ConfigError(fmt::format(
        "--report: file; got {}, which could not be written to the end; expected room", file_));
  }
}

}  // namespace oca::tools
