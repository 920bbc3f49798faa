// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/record/mcap.h"
#include "oca/diagrams/record/mcap_reader.h"

namespace oca::record {

/// The parameters of a diagram file by name, as YAML.
Texts ParameterTexts(const loading::LoadedDiagram& loaded);
/// What was overridden on the command line: path and value.
Texts OverrideTexts(const std::vector<files::Override>& overrides);
/// What was warned of when the diagram was loaded, as metadata `oca.warnings`; and back.
Texts WarningTexts(const std::vector<std::string>& warnings);
std::vector<std::string> WarningsOf(const McapFile& record);
/// What the distances of a run do not look at (runs::BlindSpots), a JSON list.
std::string NotSeenJson(const loading::LoadedDiagram& loaded);

}  // namespace oca::record
