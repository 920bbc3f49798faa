// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/record.h"

#include <fmt/format.h>

#include <utility>

#include "oca/diagrams/record/mcap_sink.h"
#include "oca/framework/dataflow/error.h"

namespace oca::record {

Record::Record(std::filesystem::path file, Compression compression, RecorderOptions options)
    : Recording(std::move(options)), file_(std::move(file)), compression_(compression) {}

Record::~Record() { Stop(); }

std::vector<runs::OutputFile> Record::Files(const loading::LoadedDiagram& /*loaded*/) const {
  return {{"record", file_}};
}

void Record::Begin(const runs::RunStart& run) {
  if (!run.continued) {
    Stop();
    sink_.reset();
    stream_ = std::ofstream(file_, std::ios::binary | std::ios::trunc);
    if (!stream_) throw ConfigError(fmt::format("{}: cannot be written", file_.string()));
    sink_ = std::make_unique<McapSink>(stream_, compression_);
    SetSink(*sink_);
  }
  Recording::Begin(run);
}

void Record::End(const runs::RunResult& result) {
  Recording::End(result);
  stream_.close();
  if (stream_) return;
  throw ConfigError(
      fmt::format("{}: could not be written to the end (disk full?)", file_.string()));
}

}  // namespace oca::record
