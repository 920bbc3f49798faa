// SPDX-License-Identifier: BSD-3-Clause
#include "diagrams/live/live_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "diagrams/catalogue.h"
#include "framework/error.h"
#include "systems/roles.h"

namespace oca::live {
namespace {

using diagrams::LoadedDiagram;
using diagrams::Override;

std::string Yaml(const LiveParameter::Value& value) {
  if (const bool* const flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const double* const number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* const text = std::get_if<std::string>(&value)) return *text;
  std::string list;
  for (const double number : std::get<std::vector<double>>(value)) {
    list += fmt::format("{}{}", list.empty() ? "" : ", ", number);
  }
  return "[" + list + "]";
}

struct Range {
  double lower{-std::numeric_limits<double>::infinity()};
  double upper{std::numeric_limits<double>::infinity()};
};

/// The bounds of a field; one that is excluded is within all the same, for a slider.
Range RangeOf(const nlohmann::json& field) {
  Range range;
  for (const char* key : {"minimum", "exclusiveMinimum"}) {
    if (field.contains(key)) range.lower = std::max(range.lower, field[key].get<double>());
  }
  if (field.contains("maximum")) range.upper = field["maximum"].get<double>();
  return range;
}

/// The parameter that a value is, whole; empty if it is another value.
std::string ParameterIn(const Value& value) {
  const std::string* const text = value.string();
  if (text == nullptr || !text->starts_with("${") || !text->ends_with("}")) return "";
  return text->substr(2, text->size() - 3);
}

}  // namespace

record::McapTexts RangesOf(const LoadedDiagram& loaded) {
  std::map<std::string, Range> ranges;
  const Value* const systems = loaded.document.Find("systems");
  for (const LoadedDiagram::Block& block : loaded.systems) {
    const Value* const given = systems == nullptr ? nullptr : systems->Find(block.name);
    if (given == nullptr || given->map() == nullptr) continue;
    const auto schema = nlohmann::json::parse(diagrams::FindRow(block.type).schema());
    for (const Value::Entry& entry : *given->map()) {
      const std::string name = ParameterIn(entry.value);
      if (name.empty() || !schema["properties"].contains(entry.key)) continue;
      const Range range = RangeOf(schema["properties"][entry.key]);
      Range& all = ranges[name];
      all = {std::max(all.lower, range.lower), std::min(all.upper, range.upper)};
    }
  }
  record::McapTexts texts;
  for (const auto& [name, range] : ranges) {
    // JSON has no infinity: nlohmann writes null.
    texts[name] = nlohmann::json{range.lower, range.upper}.dump();
  }
  return texts;
}

std::string PositionName(const std::string& id) { return "obstacles." + id + ".position"; }

std::vector<std::pair<std::string, Standing>> StandingObstacles(const LoadedDiagram& loaded) {
  std::vector<std::pair<std::string, Standing>> found;
  const Diagram& diagram = *loaded.diagram;
  for (const auto& [path, system, holds] : diagram.FindRoles<systems::HoldsObstacles>()) {
    const bool movable = holds->offsets.system != nullptr;
    for (const auto& standing : holds->standing) {
      found.emplace_back(
          standing.id,
          Standing{fmt::format("systems.{}.{}", path, standing.parameter), standing.position,
                   movable ? diagrams::ExportedName(diagram.PathOf(holds->offsets)) : "",
                   static_cast<std::size_t>(standing.first)});
    }
  }
  return found;
}

std::vector<LiveParameter> LiveParametersOf(const LoadedDiagram& loaded) {
  std::vector<LiveParameter> parameters;
  const Value* const section = loaded.document.Find("parameters");
  if (section != nullptr && section->map() != nullptr) {
    for (const Value::Entry& entry : *section->map()) {
      double number = 0.0;
      if (entry.value.boolean() != nullptr) {
        parameters.push_back({entry.key, *entry.value.boolean()});
      } else if (entry.value.number(number)) {
        parameters.push_back({entry.key, number});
      }
    }
  }
  for (const auto& [id, standing] : StandingObstacles(loaded)) {
    parameters.push_back({PositionName(id), standing.position});
  }
  return parameters;
}

Override OverrideOf(const LoadedDiagram& loaded, const LiveParameter& change) {
  for (const auto& [id, standing] : StandingObstacles(loaded)) {
    if (change.name == PositionName(id)) return {standing.path, Yaml(change.value)};
  }
  const Value* const section = loaded.document.Find("parameters");
  if (section == nullptr || section->Find(change.name) == nullptr) {
    throw ConfigError(
        fmt::format("live: parameter; got '{}'; expected one of the diagram's, or "
                    "obstacles.ID.position",
                    change.name));
  }
  return {"parameters." + change.name, Yaml(change.value)};
}

}  // namespace oca::live
