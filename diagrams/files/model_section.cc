// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/model_section.h"

#include <fmt/format.h>

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
  for (const Value::Entry& entry : SectionOf(root, "models", problems_)) ReadModel(entry);
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

void ModelSection::ReadModel(const Value::Entry& entry) {
  const std::string where = "models." + entry.key;
  ModelParams params;
  Problems own;
  ReadFields(ResolveFiles(entry.value), FieldsOf<ModelParams>(), where, &params, own);
  if (!own.empty()) {
    problems_.Add(own);
    failed_ = true;
    return;
  }
  std::vector<std::string> warnings;
  try {
    params.srdf = Resolve(params.srdf, LocationOf(entry.value, "srdf")).string();
    params.urdf = Resolve(params.urdf, LocationOf(entry.value, "urdf")).string();
    const Warn warn = [&](const std::string& line) { warnings.push_back(line); };
    models_.Add(entry.key, LoadModel(where, params, packages_, warn));
  } catch (const std::runtime_error& error) {
    failed_ = true;
    problems_.Add(entry.location, fmt::format("{}: {}", where, error.what()));
  }
  for (const std::string& line : warnings) {
    warnings_.push_back(fmt::format("{}: warning: {}", entry.location.ToString(), line));
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
