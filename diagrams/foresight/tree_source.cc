// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/tree_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

#include "oca/diagrams/files/model_section.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/systems/commands/pose_goal.h"

namespace oca::foresight {
namespace {

Value::Map Without(const Value& map, std::initializer_list<std::string_view> keys) {
  Value::Map rest;
  for (const Value::Entry& entry : *map.map()) {
    if (std::find(keys.begin(), keys.end(), entry.key) == keys.end()) rest.push_back(entry);
  }
  return rest;
}

using Around = decltype(systems::PoseGoalParams::around)::value_type;

/// Whether a system of a type says by its parameters where obstacles are: they are what a goal
/// takes as `around`.
bool SaysObstacles(const files::Catalogue& catalogue, const std::string& type) {
  const auto& rows = catalogue.rows();
  return std::any_of(rows.begin(), rows.end(), [&](const files::Catalogue::Row& row) {
    return row->type == type && row->fields == &FieldsOf<Around>;
  });
}

const std::string* TypeNameIn(const Value& system) {
  const Value* const type = system.Find("type");
  return type == nullptr ? nullptr : type->string();
}

Value::List ObstaclesOf(const Value::Map& systems, const files::Catalogue& catalogue) {
  Value::List sources;
  for (const Value::Entry& system : systems) {
    const std::string* const type = TypeNameIn(system.value);
    if (type == nullptr || !SaysObstacles(catalogue, *type)) continue;
    sources.emplace_back(Without(system.value, {"type"}), system.value.location());
  }
  return sources;
}

/// Whether a parameter of a system is a goal with a clearance from nobody knows what.
bool Asks(const Value::Entry& field) {
  return field.key == "goal" && field.value.Find("clearance") != nullptr &&
         field.value.Find("around") == nullptr;
}

/// `params` with its files found by the packages of the tree.
Value Resolved(const Value& root, const Value& params, Problems& problems) {
  Value::Map packages;
  if (const Value* const section = root.Find("packages")) {
    packages.push_back({"packages", section->location(), *section});
  }
  return files::ModelSection(Value(std::move(packages), root.location()), problems)
      .ResolveFiles(params, problems);
}

}  // namespace

const Value* FindEntry(const Value& root, const char* section, const std::string& name,
                       Problems& problems) {
  const Value* const map = root.Find(section);
  const Value* const found = map == nullptr ? nullptr : map->Find(name);
  if (found != nullptr && found->map() != nullptr) return found;
  std::vector<std::string> known;
  if (map != nullptr && map->map() != nullptr) {
    for (const Value::Entry& entry : *map->map()) known.push_back(entry.key);
  }
  problems.Add(root.location(),
               fmt::format("no '{}' in {}{}", name, section, DidYouMean(name, known)));
  return nullptr;
}

std::unique_ptr<Diagram> MakeTreeSource(const Value& root, const std::string& name,
                                        const systems::ModelSet& models,
                                        const files::Catalogue& catalogue, Problems& problems) {
  const Value* const entry = FindEntry(root, "systems", name, problems);
  if (entry == nullptr) return nullptr;
  const std::string where = "systems." + name;
  const std::string* const type = TypeNameIn(*entry);
  if (type == nullptr) {
    problems.Add(entry->location(), where + ".type: missing; expected the name of a system type");
    return nullptr;
  }
  try {
    const Value params(Without(*entry, {"type", "period", "frequency"}), entry->location());
    auto system =
        catalogue.Find(*type)->Make(Resolved(root, params, problems), where, models, problems);
    if (!system) return nullptr;
    DiagramBuilder builder;
    builder.AddSystem(name, std::move(system));
    return builder.Build();
  } catch (const std::exception& error) {
    problems.Add(entry->location(), fmt::format("{}: {}", where, oca::internal::Explain(error)));
  }
  return nullptr;
}

bool AsksForObstacles(const Value::Map& params) {
  return std::any_of(params.begin(), params.end(), Asks);
}

void TellGoal(const Value::Map& systems, const files::Catalogue& catalogue, Value::Map& params) {
  for (Value::Entry& field : params) {
    if (!Asks(field)) continue;
    field.value.map()->push_back(
        {"around", field.location, {ObstaclesOf(systems, catalogue), field.location}});
  }
}

}  // namespace oca::foresight
