// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/system_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/section.h"
#include "oca/diagrams/foresight/tree_source.h"
#include "oca/diagrams/loading/assembly.h"
#include "oca/diagrams/loading/used_file.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/file_cache.h"
#include "oca/models/robot/posture.h"
#include "oca/systems/signals/roles.h"

namespace oca::loading {

namespace {

struct Numbers {
  std::string where;
  const Value* value;  // a list
};

/// Where an entry says a number a joint.
std::vector<Numbers> NumbersOfJoints(const Value& entry) {
  std::vector<Numbers> found;
  const auto add = [&](const std::string& where, const Value* value) {
    if (value != nullptr && value->list() != nullptr) found.push_back({where, value});
  };
  if (const Value* const points = entry.Find("key_points"); points && points->list()) {
    for (std::size_t i = 0; i < points->list()->size(); ++i) {
      add(fmt::format("key_points[{}].position", i), (*points->list())[i].Find("position"));
    }
  }
  add("initial_position", entry.Find("initial_position"));
  return found;
}

}  // namespace

SystemSection::SystemSection(const Value& root, const Level& level, const SystemSources& sources,
                             Construction& construction, DiagramBuilder& builder,
                             Problems& problems)
    : root_(root),
      level_(level),
      sources_(sources),
      models_(std::make_shared<const systems::ModelSet>(sources.models.models())),
      construction_(construction),
      builder_(builder),
      problems_(problems) {
  if (root.Find("systems") == nullptr) {
    problems.Add(root.location(), "systems: missing; expected a map of named systems");
  } else if (Entries().empty() && problems.empty()) {
    problems.Add(root.Find("systems")->location(), "systems: got none; expected at least one");
  }
  for (const Value::Entry& entry : Entries()) Read(entry);
}

SystemSection::~SystemSection() = default;

const Value::Map& SystemSection::Entries() const {
  return files::SectionOf(root_, "systems", problems_);
}

bool SystemSection::Names(const std::string& name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

files::NamedOutputs SystemSection::Outputs() const {
  files::NamedOutputs outputs;
  for (const Built& built : built_) {
    for (const System::OutputInfo& output : built.system->outputs()) {
      outputs.emplace_back(built.name + "." + output.name, built.system->FindOutput(output.name));
    }
  }
  return outputs;
}

files::NamedOutputs SystemSection::NamedByUsedFiles() const {
  files::NamedOutputs outputs;
  for (const auto& used : used_) {
    for (const auto& [name, output] : used->outputs()) {
      if (output.built) outputs.emplace_back(used->name() + "." + name, output.handle);
    }
  }
  return outputs;
}

void SystemSection::Read(const Value::Entry& entry) {
  const std::string where = "systems." + entry.key;
  names_.push_back(entry.key);
  if (entry.key == "inputs" || entry.key == "outputs") {
    problems_.Add(entry.location, fmt::format("{}: stands for the ports of the file, in "
                                              "connections; expected another name",
                                              where));
    return;
  }
  const Value* const type = TypeOf(entry, where);
  if (type == nullptr) return;
  try {
    if (*type->string() == files::kDiagramType) {
      Use(entry);
    } else {
      Make(entry, *type, where);
    }
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

/// What a system is made from.
struct SystemSection::ReadEntry {
  Value entry;  // whose FormOf is that of no other while it is here
  Value params{};
  Problems of_paths{};
  std::shared_ptr<const void> typed{};  // null: the parameters are wrong
  Problems of_params{};
};

SystemSection::ReadEntry SystemSection::ReadParams(const Value& entry,
                                                   const files::CatalogueRow& row,
                                                   const std::string& where) const {
  ReadEntry read{entry};
  Value::Map params;
  params.reserve(entry.map()->size());
  for (const Value::Entry& field : *entry.map()) {
    if (field.key != "type") params.push_back(field);
  }
  if (foresight::AsksForObstacles(params)) {
    Value::Map systems = sources_.outer_systems;
    systems.insert(systems.end(), Entries().begin(), Entries().end());
    foresight::TellGoal(systems, construction_.catalogue, params);
  }
  read.params =
      sources_.models.ResolveFiles(Value(std::move(params), entry.location()), read.of_paths);
  read.typed = row.Read(read.params, where, read.of_params);
  return read;
}

void SystemSection::Make(const Value::Entry& entry, const Value& type, const std::string& where) {
  const files::Catalogue::Row& row = construction_.catalogue.Find(*type.string());
  const std::string path = level_.Full(entry.key);
  const auto read_now = [&] { return ReadParams(entry.value, *row, where); };
  // What is told to a goal is of other entries.
  const auto read = foresight::AsksForObstacles(*entry.value.map())
                        ? std::make_shared<const ReadEntry>(read_now())
                        : models::MakeOnce<ReadEntry>(
                              "systems." + path, sources_.models.FormOf(entry.value), read_now);
  problems_.Add(read->of_paths);
  problems_.Add(read->of_params);
  // A model that did not load has been reported; its users would only repeat it.
  if (read->typed == nullptr || (sources_.models.failed() && row->needs_models)) return;
  auto system =
      row->Make(read->typed.get(), read->params, where, sources_.models.models(), problems_);
  if (!system) return;
  construction_.systems[path] = {entry.location, level_.path};
  KeepWarnings(*system, where, entry.location);
  const System* made = system.get();
  const bool built = construction_.part.Has(path);
  if (built) {
    made = &builder_.AddSystem(entry.key, std::move(system));
    built_.push_back({entry.key, made});
    blocks_.push_back({path, row->type, read->params, row, models_});
  } else {
    outside_.push_back(std::move(system));
  }
  made_[entry.key] = {.system = made, .built = built};
}

/// Reads another file as a system of this one.
void SystemSection::Use(const Value::Entry& entry) {
  for (const files::Section& section : files::Sections()) {
    if (entry.key != section.key) continue;
    problems_.Add(entry.location, fmt::format("systems.{0}: -s {0}.PATH is of the section '{0}' of "
                                              "the file; expected another name for a used file",
                                              entry.key));
    return;
  }
  SystemSources inner = sources_;
  inner.outer_systems.insert(inner.outer_systems.end(), Entries().begin(), Entries().end());
  auto used = std::make_unique<UsedFile>(entry, level_, inner, construction_, problems_);
  if (!used->read()) return;
  SystemSection& systems = used->assembly().systems();
  for (const std::string& name : systems.names()) names_.push_back(entry.key + "." + name);
  used_.push_back(std::move(used));
  if (used_.back()->failed()) return;
  if (!systems.built().empty()) {
    builder_.AddSystem(entry.key, used_.back()->Build());
    for (const Built& built : systems.built()) {
      built_.push_back({entry.key + "." + built.name, built.system});
    }
    for (LoadedDiagram::Block& block : systems.TakeBlocks()) blocks_.push_back(std::move(block));
  }
  made_[entry.key] = {.file = used_.back().get()};
}

bool SystemSection::TellWrongCounts(Problems& problems) const {
  bool told = false;
  for (const Value::Entry& entry : Entries()) {
    const auto model = ModelOf(entry.value);
    if (model == nullptr) continue;
    for (const auto& [where, value] : NumbersOfJoints(entry.value)) {
      if (std::ssize(*value->list()) == model->num_positions()) continue;
      problems.Add(value->location(),
                   fmt::format("systems.{}.{}: got {} numbers; expected {}", entry.key, where,
                               value->list()->size(), robot::OneAJoint(*model)));
      told = true;
      break;  // the others are as long, or have been told of
    }
  }
  for (const auto& used : used_) {
    if (used->failed()) continue;
    Problems own;
    told = used->assembly().systems().TellWrongCounts(own) || told;
    used->Tell(own);
  }
  return told;
}

std::shared_ptr<const robot::RobotModel> SystemSection::ModelOf(const Value& entry) const {
  const Value* const named = entry.Find("model");
  const std::string name = named != nullptr && named->string() != nullptr ? *named->string() : "";
  if (name.empty() && !models_->HasOnly()) return nullptr;
  const auto model = models_->Get(name);
  return model->num_positions() > 0 ? model : nullptr;
}

void SystemSection::KeepWarnings(const System& system, const std::string& where,
                                 const Location& location) {
  for (const auto* const remarks : system.roles<systems::Remarks>()) {
    for (const std::string& line : remarks->warnings) {
      construction_.warnings.Add(
          level_.path, {location, fmt::format("{}: {}", where, line), Diagnostic::Kind::kWarning});
    }
  }
}

}  // namespace oca::loading
