// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/model_section.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/load_models.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/files/section.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/explain.h"
#include "oca/models/error.h"
#include "oca/models/file_cache.h"

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

/// Where a model's description is named: an entry may be begun in a file that its user did not
/// write.
Location PlaceOf(const Value::Entry& entry) {
  for (const char* key : {"urdf", "xacro"}) {
    if (const Value* const file = entry.value.Find(key)) return file->location();
  }
  return entry.location;
}

/// What of an entry a line of an error speaks of: a file other than the description, or a value;
/// nullptr: none.
const Value* SpokenOf(const Value& entry, const ModelParams& params, std::string line) {
  const auto begins = [&](const std::string& file, const char* end) {
    return !file.empty() && line.starts_with(file + end);
  };
  if (begins(params.srdf, ":")) return entry.Find("srdf");
  if (begins(params.joint_limits, ":")) return entry.Find("joint_limits");
  for (const std::string* const file : {&params.urdf, &params.xacro}) {
    if (begins(*file, ": ")) line.erase(0, file->size() + 2);
  }
  return FindSpokenOf(entry, line);
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
  models_.AddOuter(given.outer.models_, given.lets_in);
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

/// What comes of an entry of `models`.
struct ModelSection::Read {
  Value entry;  // whose FormOf is that of no other while it is here
  ModelParams params{};
  std::shared_ptr<const robot::RobotModel> model{};  // null: the entry is wrong
  Problems problems{};
  std::vector<std::string> warnings{};
};

void ModelSection::ReadEntry(const std::string& where, Read& read) const {
  Problems own;
  ReadFields(ResolveFiles(read.entry, read.problems), FieldsOf<ModelParams>(), where, &read.params,
             own);
  read.problems.Add(own);
  if (!own.empty()) return;
  ModelParams& params = read.params;
  DescriptionOf(params);
  params.srdf = Resolve(params.srdf, LocationOf(read.entry, "srdf")).string();
  params.urdf = Resolve(params.urdf, LocationOf(read.entry, "urdf")).string();
  params.xacro = Resolve(params.xacro, LocationOf(read.entry, "xacro")).string();
  params.joint_limits =
      Resolve(params.joint_limits, LocationOf(read.entry, "joint_limits")).string();
  const Warn warn = [&](const std::string& line) { read.warnings.push_back(line); };
  read.model = LoadModel(where, params, packages_, warn);
}

void ModelSection::ReadModel(const Value::Entry& entry, const std::string& full_name) {
  const std::string where = "models." + entry.key;
  Read fresh{entry.value};
  std::shared_ptr<const Read> read;
  Problems thrown;
  try {
    read = models::MakeOnce<Read>("models." + full_name, FormOf(entry.value), [&] {
      ReadEntry(where, fresh);
      return fresh;
    });
    if (read->model != nullptr) {
      models_.Add(entry.key, read->model, full_name);
      sources_[entry.key] = {where, read->params, packages_};
    }
  } catch (const std::exception& error) {
    const std::string text = oca::internal::Explain(error);
    for (std::size_t from = 0, end = 0; end != std::string::npos; from = end + 1) {
      end = text.find('\n', from);
      const std::string line = text.substr(from, end - from);
      const Value* const at = SpokenOf(entry.value, fresh.params, line);
      const Location place = read == nullptr ? PlaceOf(entry) : entry.location;
      thrown.Add(at == nullptr ? place : at->location(), fmt::format("{}: {}", where, line));
    }
  }
  const Read& found = read == nullptr ? fresh : *read;
  failed_ = failed_ || found.model == nullptr || !thrown.empty();
  problems_.Add(found.problems);
  problems_.Add(thrown);
  for (const std::string& line : found.warnings) {
    warnings_.push_back({PlaceOf(entry), line, Diagnostic::Kind::kWarning});
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
  } catch (const std::exception& error) {
    failed_ = true;
    const std::string text = oca::internal::Explain(error);
    const Value* const at = own == nullptr ? nullptr : SpokenOf(*own, taken.params, text);
    problems_.Add(at != nullptr    ? at->location()
                  : own != nullptr ? own->location()
                                   : given.location,
                  fmt::format("models.{}: {}", given.key, text));
  }
}

std::string ModelSection::FormOf(const Value& entry) const {
  const Location& at = entry.location();
  const std::array<std::uintptr_t, 4> numbers{reinterpret_cast<std::uintptr_t>(entry.map()),
                                              reinterpret_cast<std::uintptr_t>(at.file.get()),
                                              static_cast<std::uintptr_t>(at.line),
                                              static_cast<std::uintptr_t>(at.column)};
  std::string form = files::FormOf(packages_);
  return form.append(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
}

Value ModelSection::ResolveFiles(const Value& value, Problems& problems) const {
  Value resolved = value;  // shared, until a file is named in it
  if (const Value::List* const list = value.list()) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      Value item = ResolveFiles((*list)[i], problems);
      if (IsOther(item, (*list)[i])) (*resolved.list())[i] = std::move(item);
    }
  } else if (const Value::Map* const map = value.map()) {
    for (std::size_t i = 0; i < map->size(); ++i) {
      const Value::Entry& entry = (*map)[i];
      // What arguments mean the xacro file knows; what is held are joints.
      if (entry.key == "arguments" || entry.key == "held") continue;
      if (entry.key == "file" && entry.value.string() != nullptr) {
        (*resolved.map())[i].value = ResolveName(entry.value, problems);
        continue;
      }
      Value inner = ResolveFiles(entry.value, problems);
      if (IsOther(inner, entry.value)) (*resolved.map())[i].value = std::move(inner);
    }
  }
  return resolved;
}

Value ModelSection::ResolveName(const Value& name, Problems& problems) const {
  try {
    return Value(Resolve(*name.string(), name.location()).string(), name.location());
  } catch (const ConfigError& error) {
    problems.Add(name.location(), error.what());
    return name;
  }
}

}  // namespace oca::files
