// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "oca/diagrams/record/mcap.h"
#include "oca/diagrams/record/recording.h"

namespace oca::record {

class McapSink;

/// An MCAP file of a run, for Foxglove, for `simulator view`, and to run again from itself:
///
///     Record record("a.mcap");
///     Run(loaded, {.outputs = {&record}});
class Record final : public Recording {
 public:
  explicit Record(std::filesystem::path file, Compression compression = Compression::kZstd,
                  RecorderOptions options = {});
  ~Record() override;

  std::vector<runs::OutputFile> Files(const loading::LoadedDiagram& loaded) const override;
  /// throws ConfigError if the file cannot be opened.
  void Begin(const runs::RunStart& run) override;
  /// throws ConfigError if it could not be written to the end.
  void End(const runs::RunResult& result) override;

 private:
  const std::filesystem::path file_;
  const Compression compression_;
  std::ofstream stream_;
  std::unique_ptr<McapSink> sink_;
};

}  // namespace oca::record
