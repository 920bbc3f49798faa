// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/model_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/load_models.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/files/section.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"

namespace oca::files {
namespace {

namespace fs = std::filesystem;

fs::path FolderOf(const Location& location) {
  return location.file && location.line > 0 ? fs::path(*location.file).parent_path() : fs::path();
}

Location LocationOf(const Value& map, const char* key) {
  const Value* const value = map.Find(key);
  return value == nullptr ? map.location() : value->location();
}

/// Of a list or map: whether something in it was made anew.
bool IsOther(const Value& made, const Value& from) {
  return (from.list() != nullptr || from.map() != nullptr) && !made.Shares(from);
}

}  // namespace

ModelSection::ModelSection(const Value& root, Problems& problems) : problems_(problems) {
  ReadPackages(root);
  for (const Value::Entry& entry : SectionOf(root, "models", problems_)) {
    ReadModel(entry, entry.key);
  }
}

ModelSection::ModelSection(const Value& root, const Given& given, Problems& problems)
    : problems_(problems), packages_(given.outer.packages_) {
  ReadPackages(root);
  const Value::Map& own = SectionOf(root, "models", problems_);
  for (const Value::Entry& entry : own) {
    if (given.models != nullptr && given.models->Find(entry.key) != nullptr) continue;
    ReadModel(entry, given.path + "." + entry.key);
  }
  if (given.models != nullptr) {
    for (const Value::Entry& entry : *given.models->map()) {
      const auto same = std::find_if(own.begin(), own.end(), [&](const Value::Entry& other) {
        return other.key == entry.key;
      });
      Take(entry, same == own.end() ? nullptr : &same->value, given.outer);
    }
  }
  models_.AddOuter(given.outer.models_);
}

void ModelSection::ReadPackages(const Value& root) {
  for (const Value::Entry& entry : SectionOf(root, "packages", problems_)) {
    if (entry.value.string() == nullptr) {
      problems_.Add(entry.value.location(), fmt::format("packages.{}: got {}; expected a folder",
                                                        entry.key, entry.value.Show()));
      continue;
    }
    const fs::path folder = *entry.value.string();
    packages_[entry.key] =
        folder.is_absolute() ? folder : FolderOf(entry.value.location()) / folder;
  }
}

fs::path ModelSection::Resolve(const std::string& name, const Location& location) const {
  return name.empty() ? fs::path() : ResolvePath(name, FolderOf(location), packages_);
}

void ModelSection::ReadModel(const Value::Entry& entry, const std::string& full_name) {
  const std::string where = "models." + entry.key;
  ModelParams params;
  Problems own;
  ReadFields(ResolveFiles(entry.value), FieldsOf<ModelParams>(), where, &params, own);
  if (!own.empty()) {
    problems_.Add(own);
    failed_ = true;
    return;
  }
  try {
    DescriptionOf(params, where);
  } catch (const ConfigError& error) {
    failed_ = true;
    return problems_.Add(entry.location, error.what());
  }
  std::vector<std::string> warnings;
  try {
    params.srdf = Resolve(params.srdf, LocationOf(entry.value, "srdf")).string();
    params.urdf = Resolve(params.urdf, LocationOf(entry.value, "urdf")).string();
    params.xacro = Resolve(params.xacro, LocationOf(entry.value, "xacro")).string();
    const Warn warn = [&](const std::string& line) { warnings.push_back(line); };
    models_.Add(entry.key, LoadModel(where, params, packages_, warn), full_name);
    sources_[entry.key] = {where, params, packages_};
  } catch (const std::runtime_error& error) {
    failed_ = true;
    problems_.Add(entry.location, fmt::format("{}: {}", where, error.what()));
  }
  for (const std::string& line : warnings) {
    warnings_.push_back(fmt::format("{}: warning: {}", entry.location.ToString(), line));
  }
}

void ModelSection::Take(const Value::Entry& given, const Value* own, const ModelSection& outer) {
  const auto source = outer.sources_.find(*given.value.string());
  if (source == outer.sources_.end()) {  // the other file's models are known to be complete
    failed_ = true;
    return;
  }
  Source taken = source->second;
  if (own != nullptr && own->map() != nullptr) {
    ModelParams params;
    ReadFields(*own, FieldsOf<ModelParams>(), "models." + given.key, &params, problems_);
    const auto fill = [](auto& limits, const auto& from) {
      if (!limits) limits = from;
    };
    fill(taken.params.acceleration_limits, params.acceleration_limits);
    fill(taken.params.jerk_limits, params.jerk_limits);
  }
  try {
    models_.Add(given.key, LoadModel(taken.where, taken.params, taken.packages, {}),
                outer.models_.FullName(*given.value.string()));
    sources_[given.key] = std::move(taken);
  } catch (const std::runtime_error& error) {
    failed_ = true;
    problems_.Add(own == nullptr ? given.location : own->location(),
                  fmt::format("models.{}: {}", given.key, error.what()));
  }
}

Value ModelSection::ResolveFiles(const Value& value) {
  Value resolved = value;  // shared, until a file is named in it
  if (const Value::List* const list = value.list()) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      Value item = ResolveFiles((*list)[i]);
      if (IsOther(item, (*list)[i])) (*resolved.list())[i] = std::move(item);
    }
  } else if (const Value::Map* const map = value.map()) {
    for (std::size_t i = 0; i < map->size(); ++i) {
      const Value::Entry& entry = (*map)[i];
      if (entry.key == "arguments") continue;  // what they mean the xacro file knows
      if (entry.key == "file" && entry.value.string() != nullptr) {
        (*resolved.map())[i].value = ResolveName(entry.value);
        continue;
      }
      Value inner = ResolveFiles(entry.value);
      if (IsOther(inner, entry.value)) (*resolved.map())[i].value = std::move(inner);
    }
  }
  return resolved;
}

Value ModelSection::ResolveName(const Value& name) {
  try {
    return Value(Resolve(*name.string(), name.location()).string(), name.location());
  } catch (const ConfigError& error) {
    problems_.Add(name.location(), error.what());
    return name;
  }
}

}  // namespace oca::files
