// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/live/live_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "oca/diagrams/files/expression.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/json_text.h"
#include "oca/systems/signals/roles.h"

namespace oca::live {
namespace {

using files::Override;
using loading::LoadedDiagram;

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

/// Those of a field; nothing if there is no such key.
std::optional<Bounds> BoundsOf(const std::vector<Field>& fields, const std::string& key) {
  for (const Field& field : fields) {
    if (field.key == key) return field.bounds;
  }
  if (key == "frequency") return Bounds{.lower = 0.0};  // that stands for a period
  return std::nullopt;
}

/// The parameter that a value is, whole; empty if it is another value.
std::string ParameterIn(const Value& value) {
  const std::string* const text = value.string();
  if (text == nullptr || !text->starts_with("${") || !text->ends_with("}")) return "";
  return text->substr(2, text->size() - 3);
}

using Ranges = std::map<std::string, Bounds>;  // by parameter

void Narrow(const std::string& parameter, const Bounds& bounds, Ranges& ranges) {
  Bounds& all = ranges[parameter];  // one that is excluded is within all the same, for a slider
  all.lower = std::max(all.lower, bounds.lower);
  all.upper = std::min(all.upper, bounds.upper);
}

/// What an entry of type Diagram gives to parameters there, as it is written; of a parameter of the
/// file that is a map, what is in that.
Value::Map GivenBy(const Value& document, const Value& entry) {
  Value::Map given;
  const auto add = [&](const Value& item) {
    const Value* map = &item;
    if (const std::string name = ParameterIn(item); !name.empty()) {
      const Value* const parameters = document.Find("parameters");
      map = parameters == nullptr ? nullptr : parameters->Find(name);
    }
    if (map == nullptr || map->map() == nullptr) return;
    given.insert(given.end(), map->map()->begin(), map->map()->end());
  };
  const Value* const parameters = entry.Find("parameters");
  if (parameters == nullptr) return given;
  if (parameters->list() == nullptr) {
    add(*parameters);
  } else {
    for (const Value& item : *parameters->list()) add(item);
  }
  return given;
}

/// Of the parameters of the file that is used at `prefix`, whose tree is `document`.
Ranges RangesAt(const LoadedDiagram& loaded, const std::string& prefix, const Value& document) {
  Ranges ranges;
  const Value* const systems = document.Find("systems");
  const auto given = [&](const std::string& path) -> const Value* {
    return systems == nullptr || !path.starts_with(prefix)
               ? nullptr
               : systems->Find(path.substr(prefix.size()));
  };
  for (const LoadedDiagram::Block& block : loaded.systems) {
    const Value* const keys = given(block.name);
    if (keys == nullptr || keys->map() == nullptr) continue;
    for (const Value::Entry& entry : *keys->map()) {
      const std::string name = ParameterIn(entry.value);
      const auto bounds = BoundsOf(block.row->fields(), entry.key);
      if (!name.empty() && bounds) Narrow(name, *bounds, ranges);
    }
  }
  for (const LoadedDiagram::InnerFile& used : loaded.used_files) {
    if (given(used.path) == nullptr) continue;
    const Ranges inner = RangesAt(loaded, used.path + ".", used.document);
    for (const Value::Entry& entry : GivenBy(document, *given(used.path))) {
      const std::string from = ParameterIn(entry.value);
      const auto range = inner.find(entry.key);
      if (!from.empty() && range != inner.end()) Narrow(from, range->second, ranges);
    }
  }
  return ranges;
}

}  // namespace

record::Texts RangesOf(const LoadedDiagram& loaded) {
  record::Texts texts;
  for (const auto& [name, range] : RangesAt(loaded, "", loaded.document)) {
    // JSON has no infinity: nlohmann writes null.
    texts[name] = oca::internal::JsonText(nlohmann::json{range.lower, range.upper});
  }
  return texts;
}

std::vector<std::pair<std::string, Standing>> StandingObstacles(const LoadedDiagram& loaded) {
  std::vector<std::pair<std::string, Standing>> found;
  const Diagram& diagram = *loaded.diagram;
  for (const auto& [path, system, holds] : diagram.FindRoles<systems::HoldsObstacles>()) {
    const bool movable = holds->offsets.system != nullptr;
    for (const auto& standing : holds->standing) {
      found.emplace_back(fmt::format("{}.{}.position", path, standing.id),
                         Standing{loading::OverridePath(path) + "." + standing.parameter,
                                  standing.position, movable ? diagram.PathOf(holds->offsets) : "",
                                  static_cast<std::size_t>(standing.first)});
    }
  }
  return found;
}

std::vector<LiveParameter> LiveParametersOf(const LoadedDiagram& loaded) {
  std::vector<LiveParameter> parameters;
  const Value* const written = loaded.document.Find("parameters");
  if (written != nullptr && written->map() != nullptr) {
    Problems none;  // it was loaded
    const Value section = files::Expressions(*written, none).Resolve(*written);
    for (const Value::Entry& entry : *section.map()) {
      double number = 0.0;
      if (entry.value.boolean() != nullptr) {
        parameters.push_back({entry.key, *entry.value.boolean()});
      } else if (entry.value.number(number)) {
        parameters.push_back({entry.key, number});
      }
    }
  }
  for (const auto& [name, standing] : StandingObstacles(loaded)) {
    parameters.push_back({name, standing.position});
  }
  return parameters;
}

Override OverrideOf(const LoadedDiagram& loaded, const LiveParameter& change) {
  for (const auto& [name, standing] : StandingObstacles(loaded)) {
    if (change.name == name) return {standing.path, Yaml(change.value)};
  }
  const Value* const section = loaded.document.Find("parameters");
  if (section == nullptr || section->Find(change.name) == nullptr) {
    throw ConfigError(
        fmt::format("live: parameter; got '{}'; expected one of the diagram's, or "
                    "PATH.ID.position of an obstacle that stands",
                    change.name));
  }
  return {"parameters." + change.name, Yaml(change.value)};
}

}  // namespace oca::live
