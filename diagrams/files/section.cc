// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace oca::files {

const Value::Map& SectionOf(const Value& root, const char* key, Problems& problems) {
  static const Value::Map kEmpty;
  const Value* const value = root.Find(key);
  if (value == nullptr || value->null()) return kEmpty;
  if (value->map() != nullptr) return *value->map();
  problems.Add(value->location(), fmt::format("{}: got {}; expected a map", key, value->Show()));
  return kEmpty;
}

const Value* FindSpokenOf(const Value& tree, const std::string& message) {
  std::string_view path = std::string_view(message).substr(0, message.find(": "));
  const Value* found = nullptr;
  for (const Value* at = &tree; at != nullptr && !path.empty();) {
    const Value* next = nullptr;
    if (path.front() == '[') {
      std::size_t item = 0;
      std::from_chars(path.data() + 1, path.data() + path.size(), item);
      if (at->list() != nullptr && item < at->list()->size()) next = &(*at->list())[item];
      path.remove_prefix(std::min(path.find(']'), path.size() - 1) + 1);
      if (path.starts_with('.')) path.remove_prefix(1);
    } else {
      const std::size_t end = std::min(path.find_first_of(".["), path.size());
      next = at->Find(std::string(path.substr(0, end)));
      // The names of joints and links may have dots.
      if (next == nullptr && found != nullptr) next = at->Find(std::string(path));
      path.remove_prefix(end);
      if (path.starts_with('.')) path.remove_prefix(1);
    }
    if (next != nullptr) found = next;
    at = next;
  }
  return found;
}

}  // namespace oca::files
