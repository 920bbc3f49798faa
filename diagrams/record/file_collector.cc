// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/file_collector.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/params.h"
#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/foreign_text.h"
#include "oca/models/opened_files.h"
#include "oca/models/robot/mesh_path.h"
#include "oca/models/robot/urdf_meshes.h"
#include "oca/systems/signals/config_errors.h"

namespace oca::record {
namespace {

namespace fs = std::filesystem;

const std::string kScheme = "package://";

fs::path FolderOf(const Location& location) {
  return location.file && location.line > 0 ? fs::path(*location.file).parent_path() : fs::path();
}

bool NamesFile(const std::string& key) {
  return key == "urdf" || key == "xacro" || key == "srdf" || key == "joint_limits" || key == "file";
}

constexpr const char* kArguments = "arguments";

/// Whether the entries of a key of a model are no files of the diagram, whatever their names.
bool NamesNone(const std::string& key) { return key == kArguments || key == "held"; }

/// Whether a tree has a file's name in it.
bool HoldsFile(const Value& value) {
  if (value.list() != nullptr) {
    return std::any_of(value.list()->begin(), value.list()->end(), HoldsFile);
  }
  return value.map() != nullptr &&
         std::any_of(value.map()->begin(), value.map()->end(), [](const Value::Entry& entry) {
           return !NamesNone(entry.key) && (NamesFile(entry.key) || HoldsFile(entry.value));
         });
}

}  // namespace

std::string ReadBytes(const fs::path& file) {
  return systems::WithConfigErrors([&] { return models::ReadUnnoted(file); });
}

bool Inside(const fs::path& name) {
  return !name.empty() && name.is_relative() && *name.begin() != "..";
}

FileCollector::FileCollector(const loading::LoadedDiagram& loaded)
    : base_(fs::absolute(loaded.file).parent_path()),
      opened_(loaded.opened.begin(), loaded.opened.end()) {}

/// Looks up packages as the file says, too.
void FileCollector::AddPackagesOf(const Value& resolved) {
  const Value* const packages = resolved.Find("packages");
  if (packages == nullptr || packages->map() == nullptr) return;
  for (const Value::Entry& entry : *packages->map()) {
    const fs::path folder = *entry.value.string();
    packages_[entry.key] =
        folder.is_absolute() ? folder : FolderOf(entry.value.location()) / folder;
  }
}

/// The document with files named as they are attached; `resolved` is the same tree, `${...}`
/// worked out, of which parameters are left out.
Value FileCollector::Rewrite(const Value& document, const Value* resolved) {
  if (resolved == nullptr) return document;
  if (document.string() != nullptr && HoldsFile(*resolved)) return Rewrite(*resolved, resolved);
  if (document.list() != nullptr && resolved->list() != nullptr) {
    Value::List list;
    for (std::size_t i = 0; i < document.list()->size(); ++i) {
      list.push_back(Rewrite((*document.list())[i], &(*resolved->list())[i]));
    }
    return Value(std::move(list), document.location());
  }
  if (document.map() == nullptr || resolved->map() == nullptr) return document;
  Value::Map map;
  for (const Value::Entry& entry : *document.map()) {
    const Value* const own = resolved->Find(entry.key);
    if (NamesNone(entry.key)) {
      map.push_back(entry);
      continue;
    }
    const bool file = own != nullptr && NamesFile(entry.key) && own->string() != nullptr;
    map.push_back(
        {entry.key, entry.location,
         file ? Value(Attach(entry.key, *own, *resolved), {}) : Rewrite(entry.value, own)});
  }
  return Value(std::move(map), document.location());
}

std::vector<Attachment> FileCollector::Take() {
  std::vector<Attachment> attachments;
  for (auto& [name, data] : files_) {
    attachments.push_back({0, name, "application/octet-stream", std::move(data)});
  }
  return attachments;
}

/// `packages` of the rewritten document.
Value FileCollector::Packages() const {
  Value::Map map;
  for (const auto& [name, data] : files_) {
    const fs::path path(name);
    if (*path.begin() != "packages") continue;
    const std::string package = std::next(path.begin())->string();
    const bool known = std::any_of(map.begin(), map.end(),
                                   [&](const auto& entry) { return entry.key == package; });
    if (!known) map.push_back({package, {}, Value("packages/" + package, {})});
  }
  return Value(std::move(map), {});
}

/// Attaches a file that an entry of the diagram names, if the run was made from it; returns its new
/// name there.
std::string FileCollector::Attach(const std::string& key, const Value& named, const Value& entry) {
  const std::string& name = *named.string();
  if (name.empty()) return name;
  const fs::path path = files::ResolvePath(name, FolderOf(named.location()), packages_);
  if (!Opened(path)) return name;
  const auto [as, new_name] = NamesOf(name, path);
  const bool fresh = !files_.contains(as.string());
  AttachAt(as, path);
  if (fresh && key == "urdf") AttachMeshes(as, path);
  if (key == "xacro") AttachXacro(name, path, entry);  // each time, for its arguments choose files
  return new_name;
}

void FileCollector::AttachAt(const fs::path& as, const fs::path& path) {
  if (!files_.contains(as.string())) files_[as.string()] = ReadBytes(path);
}

robot::LoadOptions FileCollector::OptionsOfRobot() const {
  robot::LoadOptions options;
  options.find_package = [this](const std::string& package) -> fs::path {
    const auto found = packages_.find(package);
    return found == packages_.end() ? fs::path() : found->second;
  };
  options.package_directories = files::PackageFolders();
  return options;
}

bool FileCollector::Opened(const fs::path& path) const {
  return opened_.contains(models::PlainPath(path));
}

/// The attachment for a file and the name by which the diagram finds it there: below `packages/`
/// what stays within its package.
std::pair<fs::path, std::string> FileCollector::NamesOf(const std::string& name,
                                                        const fs::path& path) const {
  if (name.starts_with(kScheme)) {
    const fs::path rest = name.substr(kScheme.size());
    const fs::path as = (fs::path("packages") / rest).lexically_normal();
    if (Inside(as.lexically_relative(fs::path("packages") / *rest.begin()))) return {as, name};
  }
  const fs::path place = PlaceOf(path);
  return {place, place.string()};
}

/// Below `files/`, as it lies to the diagram; without the folders above what lies elsewhere.
fs::path FileCollector::PlaceOf(const fs::path& path) const {
  const fs::path relative = fs::absolute(path).lexically_normal().lexically_relative(base_);
  fs::path place;
  // What comes from a record lies below `files/` already.
  if (relative.empty() || *relative.begin() != "files") place = "files";
  for (const fs::path& part : relative) place /= part == ".." ? fs::path("up") : part;
  return models::internal::SpeltAsUtf8(place.native());
}

/// The meshes of a URDF's links. What it finds by an absolute path it is given a relative one
/// for.
void FileCollector::AttachMeshes(const fs::path& urdf, const fs::path& path) {
  std::string& text = files_.at(urdf.string());
  text = robot::RenameMeshes(text, path.string(),
                             [&](const std::string& name) { return AttachMesh(name, urdf, path); });
}

std::string FileCollector::AttachMesh(const std::string& name, const fs::path& urdf,
                                      const fs::path& path) {
  fs::path mesh;
  try {
    mesh = robot::FindMesh(name, path.parent_path(), OptionsOfRobot(), path.string());
  } catch (const models::ModelError&) {
    return name;  // the run did not need it
  }
  if (!Opened(mesh)) return name;
  auto [as, new_name] = NamesOf(name, mesh);
  if (new_name != name) {
    const fs::path beside = (urdf.parent_path() / name).lexically_normal();
    const bool stays =
        fs::path(name).is_relative() && name.find("://") == std::string::npos && Inside(beside);
    if (stays) as = beside;
    new_name = stays ? name : as.lexically_relative(urdf.parent_path()).string();
  }
  AttachAt(as, mesh);
  return new_name;
}

/// What a xacro file includes, loads and names, once below `packages/` for each package that it was
/// looked up in, and where it lies to the file itself, so that either way of naming it is right.
void FileCollector::AttachXacro(const std::string& name, const fs::path& path, const Value& entry) {
  std::map<std::string, fs::path> asked;
  robot::LoadOptions options = OptionsOfRobot();
  const auto find = options.find_package;
  const std::vector<fs::path> folders = std::exchange(options.package_directories, {});
  options.find_package = [&](const std::string& package) -> fs::path {
    fs::path folder = find(package);
    for (std::size_t i = 0; folder.empty() && i < folders.size(); ++i) {
      std::error_code error;
      if (fs::is_directory(folders[i] / package, error)) folder = folders[i] / package;
    }
    if (!folder.empty()) asked[package] = fs::absolute(folder).lexically_normal();
    return folder;
  };
  files::ModelParams params;
  Problems problems;
  if (const Value* const arguments = entry.Find(kArguments)) {
    ParamTypeOf<files::XacroArguments>().Read(*arguments, {}, kArguments, &params.arguments,
                                              problems);
  }
  options.xacro_arguments = params.arguments.texts;
  const models::OpenedFiles opened(models::OpenedFiles::Elder::kNotesNot);
  robot::RenameMeshes(robot::ExpandXacro(path, robot::ForXacro(options)).urdf, path.string(),
                      [&](const std::string& mesh) {
                        try {
                          robot::FindMesh(mesh, path.parent_path(), options, path.string());
                        } catch (const models::ModelError&) {
                          // the run did not need it
                        }
                        return mesh;
                      });
  const fs::path place = NamesOf(name, path).first.parent_path();
  for (const fs::path& file : opened.files()) {
    if (!Opened(file)) continue;
    const fs::path absolute = fs::absolute(file).lexically_normal();
    for (const auto& [package, folder] : asked) {
      const fs::path rest = absolute.lexically_relative(folder);
      if (Inside(rest)) AttachAt(fs::path("packages") / package / rest, file);
    }
    const fs::path beside =
        (place / absolute.lexically_relative(fs::absolute(path).parent_path().lexically_normal()))
            .lexically_normal();
    const bool within =
        Inside(beside) && (*beside.begin() == "files" || *beside.begin() == "packages");
    if (within) AttachAt(beside, file);
  }
}

}  // namespace oca::record
