// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/csv_names.h"

#include <fmt/format.h>

#include <set>

#include "oca/models/table_text.h"

namespace oca::models {

void AppendCsvName(std::string& line, std::string_view name) {
  const bool plain = !name.empty() && name.find_first_of("\",;\t\r\n") == name.npos &&
                     !internal::IsBlank(name.front()) && !internal::IsBlank(name.back()) &&
                     !name.starts_with('#') && !name.starts_with("//") &&
                     !internal::LooksLikeNumber(std::string(name));
  if (plain) {
    line += name;
    return;
  }
  line += '"';
  for (const char c : name) line.append(c == '"' ? 2 : 1, c);
  line += '"';
}

std::vector<std::string> UniqueColumns(std::vector<std::string> names) {
  const std::set<std::string> given(names.begin(), names.end());
  std::set<std::string> used{"time"};
  for (std::string& name : names) {
    const std::string plain = name;
    for (int i = 2; used.contains(name) || (name != plain && given.contains(name)); ++i) {
      name = fmt::format("{}_{}", plain, i);
    }
    used.insert(name);
  }
  return names;
}

}  // namespace oca::models
