// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "diagrams/record/mcap_reader.h"

namespace oca::record {

/// Writes the signals of a record into a folder, a file a signal: `system.port.csv` with columns
/// `time` (s) and one a number for vectors, `system.port.jsonl` with {"time", "value"} a line for
/// all others. Numbers keep the digits they have in the record. Returns how many files there are.
/// throws ConfigError naming what cannot be written.
int ExportCsv(const McapFile& record, const std::filesystem::path& folder);

}  // namespace oca::record
