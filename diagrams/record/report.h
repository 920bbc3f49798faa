// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "oca/diagrams/record/recording.h"

namespace oca::record {

class McapSink;

/// One HTML file of a run, which opens in a browser offline: the page with the record inside. Where
/// the page is looked for, says LoadPage.
///
///     Report report("a.html");
///     Run(loaded, {.outputs = {&report}});
class Report final : public Recording {
 public:
  explicit Report(std::filesystem::path file, RecorderOptions options = {});
  ~Report() override;

  std::vector<runs::OutputFile> Files(const loading::LoadedDiagram& loaded) const override;
  /// throws ConfigError if there is no page.
  void Prepare(const runs::RunStart& run) override;
  void Begin(const runs::RunStart& run) override;
  /// throws ConfigError if the file could not be written to the end.
  void End(const runs::RunResult& result) override;

 private:
  const std::filesystem::path file_;
  std::string page_;
  std::ostringstream bytes_;
  std::unique_ptr<McapSink> sink_;
};

}  // namespace oca::record
