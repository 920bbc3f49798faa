// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/system_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "oca/diagrams/files/section.h"
#include "oca/diagrams/foresight/tree_source.h"
#include "oca/framework/dataflow/error.h"
#include "oca/systems/signals/roles.h"

namespace oca::loading {

SystemSection::SystemSection(const Value& root, const Part& part, const files::Catalogue& catalogue,
                             files::ModelSection& models, DiagramBuilder& builder,
                             Problems& problems)
    : root_(root),
      part_(part),
      catalogue_(catalogue),
      models_(models),
      builder_(builder),
      problems_(problems) {
  if (root.Find("systems") == nullptr) {
    problems.Add(root.location(), "systems: missing; expected a map of named systems");
  } else if (Entries().empty() && problems.empty()) {
    problems.Add(root.Find("systems")->location(), "systems: got none; expected at least one");
  }
  for (const Value::Entry& entry : Entries()) Read(entry);
}

const Value::Map& SystemSection::Entries() const {
  return files::SectionOf(root_, "systems", problems_);
}

bool SystemSection::Names(const std::string& name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

const System* SystemSection::Find(const std::string& name) const {
  const auto found = made_.find(name);
  return found == made_.end() ? nullptr : found->second.system;
}

const Location* SystemSection::LocationOf(const std::string& name) const {
  const auto found = made_.find(name);
  return found == made_.end() ? nullptr : &found->second.location;
}

files::NamedOutputs SystemSection::Outputs() const {
  files::NamedOutputs outputs;
  for (const LoadedDiagram::Block& block : blocks_) {
    const System& system = *Find(block.name);
    for (const System::OutputInfo& output : system.outputs()) {
      outputs.emplace_back(block.name + "." + output.name, system.FindOutput(output.name));
    }
  }
  return outputs;
}

void SystemSection::Read(const Value::Entry& entry) {
  const std::string where = "systems." + entry.key;
  names_.push_back(entry.key);
  const Value* const type = TypeOf(entry, where);
  if (type == nullptr) return;
  try {
    Make(entry, *type, where);
  } catch (const WiringError& error) {
    problems_.Add(entry.location, fmt::format("{}: {}", where, error.what()));
  } catch (const ConfigError& error) {
    problems_.Add(type->location(), fmt::format("{}.type: {}", where, error.what()));
  }
}

const Value* SystemSection::TypeOf(const Value::Entry& entry, const std::string& where) {
  if (entry.value.map() == nullptr) {
    if (entry.value.null()) return nullptr;
    problems_.Add(entry.value.location(),
                  fmt::format("{}: got {}; expected a map with a type", where, entry.value.Show()));
    return nullptr;
  }
  const Value* const type = entry.value.Find("type");
  if (type != nullptr && type->string() != nullptr) return type;
  if (type == nullptr || !type->null()) {
    problems_.Add(entry.location,
                  fmt::format("{}.type: {}; expected the name of a system type", where,
                              type == nullptr ? "missing" : "got " + type->Show()));
  }
  return nullptr;
}

void SystemSection::Make(const Value::Entry& entry, const Value& type, const std::string& where) {
  Value::Map rest;
  rest.reserve(entry.value.map()->size());
  for (const Value::Entry& field : *entry.value.map()) {
    if (field.key != "type") rest.push_back(field);
  }
  foresight::TellGoal(Entries(), catalogue_, rest);
  const files::Catalogue::Row& row = catalogue_.Find(*type.string());
  Value params = models_.ResolveFiles(Value(std::move(rest), entry.value.location()));
  // A model that did not load has been reported; its users would only repeat it.
  if (models_.failed() && row->needs_models) return;
  auto system = row->Make(params, where, models_.models(), problems_);
  if (!system) return;
  Made& made = made_[entry.key] = {system.get(), entry.location};
  KeepWarnings(*system, where, entry.location);
  if (!part_.Has(entry.key)) {
    outside_.push_back(std::move(system));
    return;
  }
  made.system = nullptr;  // until the builder has taken it
  made.system = &builder_.AddSystem(entry.key, std::move(system));
  blocks_.push_back({entry.key, row->type, std::move(params), row});
}

void SystemSection::KeepWarnings(const System& system, const std::string& where,
                                 const Location& location) {
  for (const auto* const remarks : system.roles<systems::Remarks>()) {
    for (const std::string& line : remarks->warnings) {
      warnings_.push_back(fmt::format("{}: warning: {}: {}", location.ToString(), where, line));
    }
  }
}

}  // namespace oca::loading
