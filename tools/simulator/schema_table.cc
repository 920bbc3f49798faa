// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/schema_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/params.h"

namespace oca::tools {
namespace {

using nlohmann::ordered_json;

struct KeyRow {
  std::string key, type, unit, preset, bounds, meaning;
};

std::string SchemaText(const ordered_json& schema, const char* key) {
  const auto found = schema.find(key);
  return found == schema.end() ? "" : found->get<std::string>();
}

constexpr const char* kExpression = "\\$\\{.*\\}";

/// The alternatives of a schema, without that of an expression in place of a value.
std::vector<ordered_json> Alternatives(const ordered_json& schema) {
  std::vector<ordered_json> all;
  if (schema.contains("type") && schema["type"].is_array()) {
    for (const ordered_json& type : schema["type"]) {
      all.push_back(schema);
      all.back()["type"] = type;
      if (type == "array") continue;
      for (const char* const of_lists : {"items", "minItems", "maxItems"})
        all.back().erase(of_lists);
    }
  }
  for (const char* const key : {"anyOf", "oneOf"}) {
    const auto found = schema.find(key);
    if (found == schema.end()) continue;
    for (const ordered_json& item : *found) {
      if (SchemaText(item, "pattern") != kExpression) all.push_back(item);
    }
  }
  return all;
}

/// `schema` without what allows an expression; what it says beside its one alternative is kept.
ordered_json PlainSchema(ordered_json schema) {
  if (schema.contains("type") && schema["type"].is_array() &&
      SchemaText(schema, "pattern") == kExpression) {
    ordered_json types = ordered_json::array();
    for (const ordered_json& type : schema["type"]) {
      if (type != "string") types.push_back(type);
    }
    schema.erase("pattern");
    schema["type"] = types.size() == 1 ? types[0] : types;
  }
  for (auto all = Alternatives(schema); all.size() == 1; all = Alternatives(schema)) {
    ordered_json inner = all.front();
    for (const auto& [key, value] : schema.items()) {
      if (key != "anyOf" && key != "oneOf") inner[key] = value;
    }
    schema = std::move(inner);
  }
  return schema;
}

std::string TypeText(const ordered_json& given, bool plural = false) {
  const ordered_json schema = PlainSchema(given);
  const char* const s = plural ? "s" : "";
  if (const auto names = schema.find("enum"); names != schema.end()) {
    std::string text;
    for (const ordered_json& name : *names) {
      text += fmt::format("{}`{}`", text.empty() ? "" : ", ", name.get<std::string>());
    }
    return text;
  }
  std::string text;
  for (const ordered_json& item : Alternatives(schema)) {
    text += (text.empty() ? "" : " or ") + TypeText(item);
  }
  if (!text.empty()) return text;
  const std::string type = SchemaText(schema, "type");
  if (type == "string") return fmt::format("text{}", s);
  if (type == "boolean") return "true or false";
  if (type == "array") {
    const bool fixed = schema.contains("maxItems") && schema["minItems"] == schema["maxItems"];
    return fmt::format("list{} of {}{}", s,
                       fixed ? fmt::format("{} ", schema["maxItems"].get<int>()) : "",
                       TypeText(schema.value("items", ordered_json::object()), true));
  }
  if (type == "object") return fmt::format("map{}", s);
  return type + s;
}

void ReadBound(const ordered_json& schema, Bounds& bounds) {
  if (schema.contains("minimum")) bounds.lower = schema["minimum"].get<double>();
  if (schema.contains("exclusiveMinimum")) {
    bounds.lower = schema["exclusiveMinimum"].get<double>();
    bounds.above = true;
  }
  if (schema.contains("maximum")) bounds.upper = schema["maximum"].get<double>();
}

/// Of the number, or of the numbers in the list.
std::string BoundsText(const ordered_json& schema) {
  Bounds bounds;
  ReadBound(schema, bounds);
  for (const ordered_json& item : Alternatives(schema)) ReadBound(PlainSchema(item), bounds);
  if (schema.contains("items")) ReadBound(PlainSchema(schema["items"]), bounds);
  return bounds.ToString();
}

void AddKeyRows(const ordered_json& given, const std::string& path, std::vector<KeyRow>& rows);

void AddKeyRow(const ordered_json& given, const std::string& key, bool required,
               std::vector<KeyRow>& rows) {
  const ordered_json schema = PlainSchema(given);
  KeyRow row{key, TypeText(schema), SchemaText(schema, "x-unit"), "", BoundsText(schema), ""};
  row.meaning = SchemaText(schema, "description");
  const std::string suffix = " [" + row.unit + "]";
  if (row.meaning.ends_with(suffix)) row.meaning.resize(row.meaning.size() - suffix.size());
  if (required) row.preset = "required";
  if (schema.contains("default")) row.preset = fmt::format("`{}`", schema["default"].dump());
  rows.push_back(row);
  AddKeyRows(schema, key, rows);
}

/// What is inside of an object, a map or a list of them.
void AddKeyRows(const ordered_json& given, const std::string& path, std::vector<KeyRow>& rows) {
  const ordered_json schema = PlainSchema(given);
  if (schema.contains("items")) return AddKeyRows(schema["items"], path + "[]", rows);
  const std::string prefix = path.empty() ? "" : path + ".";
  const ordered_json required = schema.value("required", ordered_json::array());
  if (schema.contains("properties")) {
    for (const auto& [key, property] : schema["properties"].items()) {
      const bool needed = std::find(required.begin(), required.end(), key) != required.end();
      AddKeyRow(property, prefix + key, needed, rows);
      // The schema requires neither of the two.
      const bool either = key == "period" && schema["properties"].contains("frequency");
      if (either && rows.back().preset.empty()) rows.back().preset = "required, or `frequency`";
    }
  }
  const auto values = schema.find("additionalProperties");
  if (values != schema.end() && values->is_object()) {
    const ordered_json value = PlainSchema(*values);
    if (value.contains("properties")) return AddKeyRows(value, prefix + "NAME", rows);
    AddKeyRow(value, prefix + "NAME", false, rows);
  }
}

}  // namespace

std::string Cell(std::string text) {
  for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) {
    text.insert(at, "\\");
  }
  return text;
}

std::string SchemaTable(const ordered_json& schema) {
  std::vector<KeyRow> rows;
  AddKeyRows(schema, "", rows);
  if (rows.empty()) return "";
  std::string text =
      "| key | type | unit | default | bounds | meaning |\n|---|---|---|---|---|---|\n";
  for (const KeyRow& row : rows) {
    text += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", row.key, Cell(row.type), row.unit,
                        Cell(row.preset), Cell(row.bounds), Cell(row.meaning));
  }
  return text;
}

}  // namespace oca::tools
