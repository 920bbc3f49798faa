// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/record/record.h"
#include "oca/diagrams/record/report.h"
#include "oca/diagrams/runs/csv.h"
#include "tools/simulator/commands.h"

namespace oca::tools {

/// What the options of `run` want to be made of it: --csv, --record, --report.
class RunFiles {
 public:
  RunFiles(const RunArguments& arguments, const std::vector<files::Override>& overrides);
  RunFiles(const RunFiles&) = delete;
  RunFiles& operator=(const RunFiles&) = delete;

  const std::vector<runs::RunOutput*>& outputs() const { return outputs_; }
  /// After the run: a warning if the record lacks samples.
  void TellDropped() const;

 private:
  const std::string record_file_;
  std::optional<runs::Csv> csv_;
  std::optional<record::Record> record_;
  std::optional<record::Report> report_;
  std::vector<runs::RunOutput*> outputs_;
};

}  // namespace oca::tools
