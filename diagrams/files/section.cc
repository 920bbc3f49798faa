// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/section.h"

#include <fmt/format.h>

namespace oca::files {

const Value::Map& SectionOf(const Value& root, const char* key, Problems& problems) {
  static const Value::Map kEmpty;
  const Value* const value = root.Find(key);
  if (value == nullptr || value->null()) return kEmpty;
  if (value->map() != nullptr) return *value->map();
  problems.Add(value->location(), fmt::format("{}: got {}; expected a map", key, value->Show()));
  return kEmpty;
}

}  // namespace oca::files
