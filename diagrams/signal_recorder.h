// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "diagrams/loader.h"
#include "framework/simulator.h"

namespace oca::diagrams {

/// Writes the recorded signals of a run into a folder, a file a signal, while the run goes on.
///
/// A Vector becomes `system.output.csv` with a header line, columns `time` (s) and one an element;
/// every other signal `system.output.jsonl`, one object {"time", "value"} a line. Numbers are
/// written with all digits they have.
class SignalRecorder {
 public:
  /// Makes the folder and the files and attaches itself to the simulator; must outlive the run.
  /// throws ConfigError if a file cannot be made.
  SignalRecorder(const std::filesystem::path& folder, const std::vector<RecordedSignal>& signals,
                 Simulator& simulator);
  ~SignalRecorder();

  /// Closes the files. throws ConfigError naming a file that could not be written to the end.
  void Finish();

 private:
  struct File {
    std::filesystem::path path;
    OutputHandle output;
    bool vector;
    std::ofstream stream;
    std::string line;
  };
  void Write(File& file, const Context& context);

  std::vector<std::unique_ptr<File>> files_;
};

}  // namespace oca::diagrams
