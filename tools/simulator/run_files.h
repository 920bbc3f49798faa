// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "oca/diagrams/files/override.h"
#include "oca/diagrams/runs/run_output.h"

namespace CLI {
class App;
}

namespace oca::record {
class Recording;
}

namespace oca::tools {

/// The files that `run` shall make of a run; an empty name: none.
struct FileArguments {
  std::string csv_folder;
  std::string record;  ///< MCAP
  std::string record_compression{"zstd"};
  std::string report;  ///< HTML
};
/// Adds their options to `run`.
void AddFileOptions(CLI::App& run, FileArguments& arguments);

/// What makes them.
class RunFiles {
 public:
  RunFiles(const FileArguments& arguments, const std::vector<files::Override>& overrides);

  std::vector<runs::RunOutput*> outputs() const;
  /// After the run: a warning if the record lacks samples.
  void TellDropped() const;

 private:
  std::vector<std::unique_ptr<runs::RunOutput>> outputs_;
  const std::string record_file_;
  const record::Recording* record_{nullptr};
};

}  // namespace oca::tools
