// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "oca/diagrams/files/document.h"
#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/record/record_sink.h"
#include "oca/diagrams/record/run_recorder.h"
#include "oca/framework/dataflow/log.h"

namespace oca::tools {

/// Makes one HTML file of a run, which opens in a browser offline: the page with the record inside.
class ReportWriter {
 public:
  /// throws ConfigError if there is no page or the file cannot be written.
  ReportWriter(const std::string& file, const loading::LoadedDiagram& loaded,
               const std::vector<files::Override>& overrides, Log* log);

  record::RunRecorder& recorder() { return recorder_; }
  /// After the run. throws ConfigError if the file could not be written to the end.
  void Finish();

 private:
  std::string page_;
  std::string file_;
  std::ostringstream bytes_;
  record::McapSink sink_;
  record::RunRecorder recorder_;
};

}  // namespace oca::tools
