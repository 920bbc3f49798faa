// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace oca::models {

/// Appends a name as a cell that CsvTable reads back, quoted where need be (RFC 4180).
void AppendCsvName(std::string& line, std::string_view name);

/// Names of columns behind one called `time`, each there once: one that is there already gets `_2`,
/// `_3`, ... behind it.
std::vector<std::string> UniqueColumns(std::vector<std::string> names);

}  // namespace oca::models
