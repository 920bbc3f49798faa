// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/record/mcap.h"
#include "oca/diagrams/record/mcap_reader.h"
#include "oca/diagrams/runs/run.h"

namespace oca::record {

/// The parameters of a diagram file by name, as YAML.
McapTexts ParameterTexts(const loading::LoadedDiagram& loaded);
/// What was overridden on the command line: path and value.
McapTexts OverrideTexts(const std::vector<files::Override>& overrides);
/// What was warned of when the diagram was loaded, as metadata `oca.warnings`; and back.
McapTexts WarningTexts(const std::vector<std::string>& warnings);
std::vector<std::string> WarningsOf(const McapFile& record);
/// What the distances of a run do not look at (diagrams::BlindSpots), a JSON list.
std::string NotSeenJson(const loading::LoadedDiagram& loaded);
/// The expectations and how they turned out, a JSON list as `simulator run --json` prints it.
std::string ExpectationsJson(const runs::RunResult& result);

}  // namespace oca::record
