// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/report.h"

#include <utility>

#include "oca/diagrams/record/mcap_sink.h"
#include "oca/diagrams/record/page.h"
#include "oca/models/whole_file.h"

namespace oca::record {
namespace {

RecorderOptions Brief(RecorderOptions options) {
  options.brief = true;
  return options;
}

}  // namespace

Report::Report(std::filesystem::path file, RecorderOptions options)
    : Recording(Brief(std::move(options))), file_(std::move(file)) {}

Report::~Report() { Stop(); }

std::vector<runs::OutputFile> Report::Files(const loading::LoadedDiagram& /*loaded*/) const {
  return {{"report", file_}};
}

void Report::Prepare(const runs::RunStart& run) {
  page_ = LoadPage();
  Recording::Prepare(run);
}

void Report::Begin(const runs::RunStart& run) {
  if (!run.continued) {
    Stop();
    sink_.reset();
    bytes_ = std::ostringstream();
    sink_ = std::make_unique<McapSink>(bytes_, Compression::kZstd);
    SetSink(*sink_);
  }
  Recording::Begin(run);
}

void Report::End(const runs::RunResult& result) {
  Recording::End(result);
  models::WriteWhole(file_, PageWithRecord(page_, bytes_.view()));
}

}  // namespace oca::record
