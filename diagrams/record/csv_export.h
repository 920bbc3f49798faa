// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "oca/diagrams/record/mcap_reader.h"

namespace oca::record {

/// Writes the signals of a record into a folder, a runs::SignalTable each, as the run would
/// have done with `--csv`. Returns how many files there are. throws ConfigError naming what cannot
/// be written.
int ExportCsv(const McapFile& record, const std::filesystem::path& folder);

/// The files that it would write.
std::vector<std::filesystem::path> ExportedFiles(const McapFile& record,
                                                 const std::filesystem::path& folder);

}  // namespace oca::record
