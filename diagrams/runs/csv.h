// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "oca/diagrams/runs/run_output.h"
#include "oca/diagrams/runs/signal_table.h"

namespace oca::runs {

/// The recorded signals of a run in a folder, a SignalTable each, written while the run goes on.
class Csv final : public RunOutput {
 public:
  /// The folder is made with the run, if need be.
  explicit Csv(std::filesystem::path folder) : folder_(std::move(folder)) {}

  std::vector<OutputFile> Files(const loading::LoadedDiagram& loaded) const override;
  /// throws ConfigError if the diagram records nothing.
  void Prepare(const RunStart& run) override;
  /// throws ModelError if a file cannot be made. A signal that a run of another diagram began
  /// without is left out; at the instant of a change there is the row before it.
  void Begin(const RunStart& run) override;
  /// Closes the files. throws ModelError naming one that could not be written to the end.
  void End(const RunResult& result) override;

 private:
  struct File {
    std::string signal;
    bool vector;
    SignalTable table;
    OutputHandle output{};
    std::int64_t time{-1};  ///< of the last row, ns
    std::vector<double> numbers{};
    std::string json{};
  };
  File& Add(const files::RecordedSignal& signal, const loading::LoadedDiagram& loaded,
            const std::vector<std::string>& joints);
  File* Find(const std::string& signal) const;
  static void Write(File& file, const Context& context);

  const std::filesystem::path folder_;
  std::vector<std::unique_ptr<File>> files_;
};

}  // namespace oca::runs
