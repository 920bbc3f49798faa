// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "oca/diagrams/files/yaml_reader.h"

namespace oca::files {

/// What reading a text named `f.yaml` gives: the tree, and the problems, a line each.
struct YamlText {
  explicit YamlText(std::string_view text) {
    Problems found;
    value = ReadYaml(text, "f.yaml", found);
    for (const Diagnostic& problem : found.all()) problems += problem.ToString() + "\n";
  }
  Value value;
  std::string problems;
};

/// The value at the end of a chain of keys; a null value if there is none.
template <class... Keys>
Value At(const Value& value, const Keys&... keys) {
  const Value* at = &value;
  for (const std::string& key : {std::string(keys)...}) {
    if (at != nullptr) at = at->Find(key);
  }
  return at == nullptr ? Value() : *at;
}

inline double Number(const Value& value) {
  double number = -12345.0;
  value.number(number);
  return number;
}

}  // namespace oca::files
