// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/used_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "oca/diagrams/loading/assembly.h"
#include "oca/diagrams/loading/connection_section.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/nearest.h"
#include "oca/models/file_cache.h"

namespace oca::loading {
namespace {

namespace fs = std::filesystem;

constexpr int kMostUses = 200;

/// Looked up once while a cache is in use.
fs::path Canonical(const fs::path& file) {
  return *models::ReadOnce<fs::path>(file, "canonical", [&] {
    std::error_code ignored;
    return fs::weakly_canonical(file, ignored);
  });
}

/// A map, or a list of maps of which the later ones win; nullopt if it is something else.
std::optional<Value::Map> MergedMaps(const Value& value) {
  if (value.map() != nullptr) return *value.map();
  if (value.list() == nullptr) return std::nullopt;
  Value::Map merged;
  for (const Value& item : *value.list()) {
    if (item.map() == nullptr) return std::nullopt;
    for (const Value::Entry& entry : *item.map()) {
      std::erase_if(merged, [&](const Value::Entry& other) { return other.key == entry.key; });
      merged.push_back(entry);
    }
  }
  return merged;
}

/// Whether a text of the tree is `name`, or begins with it and a slash.
bool Mentions(const Value& value, const std::string& name) {
  if (value.string() != nullptr) {
    return *value.string() == name || value.string()->starts_with(name + "/");
  }
  const auto mentions = [&](const Value& inner) { return Mentions(inner, name); };
  if (value.list() != nullptr) {
    return std::any_of(value.list()->begin(), value.list()->end(), mentions);
  }
  return value.map() != nullptr &&
         std::any_of(value.map()->begin(), value.map()->end(),
                     [&](const Value::Entry& entry) { return mentions(entry.value); });
}

}  // namespace

UsedFile::UsedFile(const Value::Entry& entry, const Level& outer, const SystemSources& sources,
                   Construction& construction, Problems& problems)
    : name_(entry.key),
      outer_(outer.path),
      construction_(construction),
      level_{outer.Full(entry.key), outer.files} {
  const std::optional<Entry> given = ReadEntry(entry, sources, problems);
  if (!given) return;
  file_ = given->file;
  given_ = given->parameters;
  if (!MayBeRead(entry, problems)) return;
  level_.files.push_back(Canonical(file_));
  const auto overrides = sources.inner_overrides.find(name_);
  if (overrides != sources.inner_overrides.end()) overrides_ = overrides->second;
  Read(entry, *given, problems);
  if (document_.root.map() != nullptr) {
    const auto lets_in = [&](const std::string& model) {
      return TakesIn(document_.root, systems::LinksInput(model));
    };
    models_ = std::make_unique<files::ModelSection>(
        document_.root,
        files::ModelSection::Given{sources.models, &given->models, level_.path, lets_in}, own_);
    for (const Diagnostic& warning : models_->warnings()) {
      construction_.warnings.Add(level_.path, warning);
    }
    WarnOfUnusedModels(given->models);
    sources_ = std::make_unique<SystemSources>(
        SystemSources{*models_, document_.inner_overrides, sources.outer_systems});
    assembly_ = std::make_unique<Assembly>(document_.root, level_, *sources_, construction_,
                                           builder_, own_);
    for (const auto& [name, inputs] : assembly_->connections().inputs()) {
      for (const InputAt& input : inputs) {
        construction_.open[input.path] = {{entry.location, outer.path}, name_ + "." + name};
      }
    }
    failed_ = !own_.empty() || !assembly_->systems().complete();
  }
  Tell(own_);
}

UsedFile::~UsedFile() = default;

std::optional<UsedFile::Entry> UsedFile::ReadEntry(const Value::Entry& entry,
                                                   const SystemSources& sources,
                                                   Problems& problems) const {
  const std::string where = "systems." + name_;
  std::vector<std::string> known{"type"};
  for (const files::Section& key : files::DiagramKeys()) known.emplace_back(key.key);
  for (const Value::Entry& field : *entry.value.map()) {
    if (std::find(known.begin(), known.end(), field.key) != known.end()) continue;
    problems.Add(field.location, fmt::format("{}.{}: unknown key{}; known: {}", where, field.key,
                                             DidYouMean(field.key, known), fmt::join(known, ", ")));
  }
  Entry given;
  given.parameters = Value(Value::Map{}, entry.value.location());
  given.models = given.parameters;
  if (const Value* const value = entry.value.Find("parameters"); value && !value->null()) {
    if (auto map = MergedMaps(*value)) {
      given.parameters = Value(std::move(*map), value->location());
    } else {
      problems.Add(value->location(),
                   fmt::format("{}.parameters: got {}; expected a map, or a list of maps", where,
                               value->Show()));
    }
  }
  if (const Value* const value = entry.value.Find("models"); value && !value->null()) {
    given.models = ReadModels(*value, sources.models, problems);
  }
  const Value resolved = sources.models.ResolveFiles(entry.value, problems);
  const Value* const file = resolved.Find("file");
  if (file == nullptr || file->string() == nullptr) {
    if (file != nullptr && file->null()) return std::nullopt;  // has been told
    problems.Add(file == nullptr ? entry.location : file->location(),
                 fmt::format("{}.file: {}; expected a diagram file", where,
                             file == nullptr ? "missing" : "got " + file->Show()));
    return std::nullopt;
  }
  given.file = *file->string();
  return given;
}

/// The entries that lead to a model of the other file; those that do not are told, and lead
/// nowhere.
Value UsedFile::ReadModels(const Value& given, const files::ModelSection& there,
                           Problems& problems) const {
  const std::string where = "systems." + name_ + ".models";
  Value::Map models;
  if (given.map() == nullptr) {
    problems.Add(given.location(),
                 fmt::format("{}: got {}; expected a map from models of that file to models here",
                             where, given.Show()));
    return Value(std::move(models), given.location());
  }
  for (const Value::Entry& entry : *given.map()) {
    std::string target;
    if (entry.value.string() == nullptr || entry.value.string()->empty()) {
      if (!entry.value.null()) {
        problems.Add(entry.value.location(),
                     fmt::format("{}.{}: got {}; expected the name of a model", where, entry.key,
                                 entry.value.Show()));
      }
    } else {
      target = *entry.value.string();
    }
    models.push_back({entry.key, entry.location, Value(target, entry.value.location())});
  }
  for (const Value::Entry& entry : models) {
    if (entry.value.string()->empty() || there.failed()) continue;
    try {
      there.models().Get(*entry.value.string());
    } catch (const ConfigError& error) {
      problems.Add(entry.value.location(),
                   fmt::format("{}.{}: {}", where, entry.key, error.what()));
    }
  }
  return Value(std::move(models), given.location());
}

bool UsedFile::MayBeRead(const Value::Entry& entry, Problems& problems) const {
  const Location place = entry.value.Find("file")->location();
  const auto& files = level_.files;
  const auto same = std::find(files.begin(), files.end(), Canonical(file_));
  if (same != files.end()) {
    std::vector<std::string> chain;
    for (auto at = same; at != files.end(); ++at) chain.push_back(at->filename().string());
    chain.push_back(file_.filename().string());
    problems.Add(place, fmt::format("systems.{}.file: {} uses itself: {}", name_, file_.string(),
                                    fmt::join(chain, " -> ")));
    return false;
  }
  if (++construction_.uses <= kMostUses) return true;
  if (construction_.uses == kMostUses + 1) {
    problems.Add(place, fmt::format("systems.{}.file: the diagram uses more than {} files", name_,
                                    kMostUses));
  }
  return false;
}

void UsedFile::Read(const Value::Entry& entry, const Entry& given, Problems& problems) {
  const GivenParameters parameters{given.parameters, "systems." + name_ + ".parameters", &problems};
  try {
    document_ = ReadResolved(file_, overrides_, construction_, own_, level_.path, &parameters);
  } catch (const ConfigError& error) {
    if (own_.empty()) {  // it is not to be opened
      problems.Add(entry.value.Find("file")->location(),
                   fmt::format("systems.{}.file: {}", name_, error.what()));
    }
  }
  RefuseOverridesOfTheRun();
  for (const Diagnostic& warning : document_.warnings) {
    construction_.warnings.Add(level_.path, warning);
  }
}

/// What is of the run is said by the file that is run.
void UsedFile::RefuseOverridesOfTheRun() {
  for (const files::Override& change : overrides_) {
    for (const std::string key : {"name", "description", "simulator", "record.scene"}) {
      if (change.path != key && !change.path.starts_with(key + ".")) continue;
      own_.Add({std::make_shared<const std::string>(change.Source()), 0, 0},
               fmt::format("{}: is not looked at in a file that another one uses; expected an "
                           "override of that of the file that is run, -s {}",
                           key, change.path));
    }
  }
}

void UsedFile::WarnOfUnusedModels(const Value& models) {
  const Value* const own = document_.root.Find("models");
  const Value* const systems = document_.root.Find("systems");
  for (const Value::Entry& entry : *models.map()) {
    const bool known = own != nullptr && own->Find(entry.key) != nullptr;
    if (known || (systems != nullptr && Mentions(*systems, entry.key))) continue;
    std::vector<std::string> names;
    if (own != nullptr && own->map() != nullptr) {
      for (const Value::Entry& other : *own->map()) names.push_back(other.key);
    }
    construction_.warnings.Add(
        outer_, {entry.location,
                 fmt::format("systems.{}.models.{}: nothing in {} uses it{}", name_, entry.key,
                             file_.string(), DidYouMean(entry.key, names)),
                 Diagnostic::Kind::kWarning});
  }
}

const std::map<std::string, OutputAt>& UsedFile::outputs() const {
  return assembly_->connections().outputs();
}

const std::map<std::string, std::vector<InputAt>>& UsedFile::inputs() const {
  return assembly_->connections().inputs();
}

std::unique_ptr<Diagram> UsedFile::Build() {
  for (const auto& [name, inputs] : inputs()) {
    for (const InputAt& input : inputs) {
      if (input.built) builder_.ExportInput(name, input.handle);
    }
  }
  for (const auto& [name, output] : outputs()) {
    if (output.built) builder_.ExportOutput(name, output.handle);
  }
  return builder_.BuildInner();
}

void UsedFile::Tell(Problems& found) {
  for (const Diagnostic& problem : found.all()) construction_.problems.Add(level_.path, problem);
  found = Problems();
}

}  // namespace oca::loading
