// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace oca::tools {

/// The properties of a JSON Schema as a Markdown table, a key a row, those of objects and lists
/// inside below them: `key`, `key.inner`, `list[].inner`, `map.NAME.inner`. Empty if there is none.
/// `"${...}"` instead of a number is not told of each key.
std::string SchemaTable(const nlohmann::ordered_json& schema);

/// A text as a cell of a table.
std::string Cell(std::string text);

}  // namespace oca::tools
