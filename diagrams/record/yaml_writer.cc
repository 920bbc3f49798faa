// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/yaml_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "oca/models/json_values.h"

namespace oca::record {
namespace {

using models::internal::AppendQuoted;

bool PlainKey(const std::string& key) {
  return !key.empty() && std::isalpha(static_cast<unsigned char>(key.front())) != 0 &&
         std::all_of(key.begin(), key.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; }) &&
         key != "no" && key != "yes" && key != "on" && key != "off" && key != "true" &&
         key != "false" && key != "null" && key != "y" && key != "n";
}

void AppendKey(std::string& out, const std::string& key) {
  if (PlainKey(key)) {
    out += key;
  } else {
    AppendQuoted(out, key);
  }
  out += ": ";
}

void AppendFlow(std::string& out, const Value& value) {
  if (const bool* const truth = value.boolean()) {
    out += *truth ? "true" : "false";
  } else if (const std::int64_t* const integer = value.integer()) {
    out += std::to_string(*integer);
  } else if (double number = 0.0; value.number(number)) {
    const std::string text = fmt::format("{}", number);
    out += text;
    if (text.find_first_of(".en") == std::string::npos) out += ".0";
  } else if (const std::string* const text = value.string()) {
    AppendQuoted(out, *text);
  } else if (value.list() != nullptr) {
    out += '[';
    for (const Value& item : *value.list()) {
      if (&item != &value.list()->front()) out += ", ";
      AppendFlow(out, item);
    }
    out += ']';
  } else if (value.map() != nullptr) {
    out += '{';
    bool first = true;
    for (const Value::Entry& entry : *value.map()) {
      if (entry.value.null()) continue;
      if (!first) out += ", ";
      first = false;
      AppendKey(out, entry.key);
      AppendFlow(out, entry.value);
    }
    out += '}';
  }
}

void AppendBlock(std::string& out, const Value::Map& map, std::size_t indent) {
  for (const Value::Entry& entry : map) {
    if (entry.value.null()) continue;
    out.append(indent, ' ');
    AppendKey(out, entry.key);
    const Value::List* const list = entry.value.list();
    if (entry.value.map() != nullptr && !entry.value.map()->empty()) {
      out += '\n';
      AppendBlock(out, *entry.value.map(), indent + 2);
    } else if (list != nullptr && !list->empty() && list->front().string() != nullptr) {
      out += '\n';
      for (const Value& item : *list) {
        out.append(indent + 2, ' ');
        out += "- ";
        AppendFlow(out, item);
        out += '\n';
      }
    } else {
      AppendFlow(out, entry.value);
      out += '\n';
    }
  }
}

}  // namespace

std::string WriteYaml(const Value& map) {
  std::string out;
  if (map.map() != nullptr) AppendBlock(out, *map.map(), 0);
  return out;
}

std::string WriteYamlValue(const Value& value) {
  std::string out;
  AppendFlow(out, value);
  return out;
}

}  // namespace oca::record
