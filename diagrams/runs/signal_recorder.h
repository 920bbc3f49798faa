// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/signal_table.h"
#include "oca/framework/simulation/simulator.h"

namespace oca::runs {

/// Writes the recorded signals of a run into a folder, a SignalTable each, while the run goes on.
class SignalRecorder {
 public:
  /// Makes the folder and the files and attaches itself to the simulator; must outlive the run.
  /// throws ConfigError if a file cannot be made.
  SignalRecorder(const std::filesystem::path& folder, const loading::LoadedDiagram& loaded,
                 Simulator& simulator);
  ~SignalRecorder();

  /// Closes the files. throws ConfigError naming a file that could not be written to the end.
  void Finish();

 private:
  struct File {
    OutputHandle output;
    bool vector;
    SignalTable table;
    std::vector<double> numbers;
    std::string json;
  };
  static void Write(File& file, const Context& context);

  std::vector<std::unique_ptr<File>> files_;
};

/// The files that a SignalRecorder would make.
std::vector<std::filesystem::path> SignalFiles(const std::filesystem::path& folder,
                                               const loading::LoadedDiagram& loaded);

}  // namespace oca::runs
