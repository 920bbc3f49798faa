// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/record_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "oca/diagrams/files/document.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/record/yaml_writer.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/opened_files.h"
#include "oca/models/robot/mesh_path.h"
#include "oca/models/robot/urdf_meshes.h"

namespace oca::record {
namespace {

namespace fs = std::filesystem;

const std::string kScheme = "package://";

std::string ReadBytes(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) throw ConfigError(fmt::format("{}: cannot be read", file.string()));
  return bytes;
}

fs::path FolderOf(const Location& location) {
  return location.file && location.line > 0 ? fs::path(*location.file).parent_path() : fs::path();
}

bool NamesFile(const std::string& key) { return key == "urdf" || key == "srdf" || key == "file"; }

/// Whether a tree has a file's name in it.
bool HoldsFile(const Value& value) {
  if (value.list() != nullptr) {
    return std::any_of(value.list()->begin(), value.list()->end(), HoldsFile);
  }
  return value.map() != nullptr &&
         std::any_of(value.map()->begin(), value.map()->end(), [](const Value::Entry& entry) {
           return NamesFile(entry.key) || HoldsFile(entry.value);
         });
}

bool Inside(const fs::path& name) {
  return !name.empty() && name.is_relative() && *name.begin() != "..";
}

class FileCollector {
 public:
  explicit FileCollector(const loading::LoadedDiagram& loaded)
      : base_(fs::absolute(loaded.file).parent_path()),
        opened_(loaded.opened.begin(), loaded.opened.end()) {}

  /// Looks up packages as the file says, too.
  void AddPackagesOf(const Value& resolved) {
    const Value* const packages = resolved.Find("packages");
    if (packages == nullptr || packages->map() == nullptr) return;
    for (const Value::Entry& entry : *packages->map()) {
      const fs::path folder = *entry.value.string();
      packages_[entry.key] =
          folder.is_absolute() ? folder : FolderOf(entry.value.location()) / folder;
    }
  }
  const files::PackageMap& packages() const { return packages_; }
  void SetPackages(files::PackageMap packages) { packages_ = std::move(packages); }

  /// The document with files named as they are attached; `resolved` is the same tree, `${...}`
  /// worked out, of which parameters are left out.
  Value Rewrite(const Value& document, const Value* resolved) {
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
      const bool file = own != nullptr && NamesFile(entry.key) && own->string() != nullptr;
      map.push_back({entry.key, entry.location,
                     file ? Value(Attach(entry.key, *own->string(), FolderOf(own->location())), {})
                          : Rewrite(entry.value, own)});
    }
    return Value(std::move(map), document.location());
  }

  std::vector<McapAttachment> Take() {
    std::vector<McapAttachment> attachments;
    for (auto& [name, data] : files_) {
      attachments.push_back({0, name, "application/octet-stream", std::move(data)});
    }
    return attachments;
  }

  /// `packages` of the rewritten document.
  Value Packages() const {
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

 private:
  /// Attaches a file that the diagram names, if the run was made from it; returns its new name
  /// there.
  std::string Attach(const std::string& key, const std::string& name, const fs::path& folder) {
    if (name.empty()) return name;
    const fs::path path = files::ResolvePath(name, folder, packages_);
    if (!Opened(path)) return name;
    const auto [as, new_name] = NamesOf(name, path);
    const bool fresh = !files_.contains(as.string());
    if (fresh) files_[as.string()] = ReadBytes(path);
    if (fresh && key == "urdf") AttachMeshes(as, path);
    return new_name;
  }

  bool Opened(const fs::path& path) const { return opened_.contains(models::PlainPath(path)); }

  /// The attachment for a file and the name by which the diagram finds it there: below `packages/`
  /// what stays within its package.
  std::pair<fs::path, std::string> NamesOf(const std::string& name, const fs::path& path) const {
    if (name.starts_with(kScheme)) {
      const fs::path rest = name.substr(kScheme.size());
      const fs::path as = (fs::path("packages") / rest).lexically_normal();
      if (Inside(as.lexically_relative(fs::path("packages") / *rest.begin()))) return {as, name};
    }
    const fs::path place = PlaceOf(path);
    return {place, place.string()};
  }

  /// Below `files/`, as it lies to the diagram; without the folders above what lies elsewhere.
  fs::path PlaceOf(const fs::path& path) const {
    const fs::path relative = fs::absolute(path).lexically_normal().lexically_relative(base_);
    fs::path place;
    // What comes from a record lies below `files/` already.
    if (relative.empty() || *relative.begin() != "files") place = "files";
    for (const fs::path& part : relative) place /= part == ".." ? fs::path("up") : part;
    return place;
  }

  /// The meshes of a URDF's links. What it finds by an absolute path it is given a relative one
  /// for.
  void AttachMeshes(const fs::path& urdf, const fs::path& path) {
    std::string& text = files_.at(urdf.string());
    text = robot::RenameMeshes(
        text, path.string(), [&](const std::string& name) { return AttachMesh(name, urdf, path); });
  }

  std::string AttachMesh(const std::string& name, const fs::path& urdf, const fs::path& path) {
    robot::LoadOptions options;
    options.find_package = [this](const std::string& package) -> fs::path {
      const auto found = packages_.find(package);
      return found == packages_.end() ? fs::path() : found->second;
    };
    options.package_directories = files::PackageFolders();
    fs::path mesh;
    try {
      mesh = robot::FindMesh(name, path.parent_path(), options, path.string());
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
    if (!files_.contains(as.string())) files_[as.string()] = ReadBytes(mesh);
    return new_name;
  }

  const fs::path base_;
  const std::set<fs::path> opened_;
  files::PackageMap packages_;
  std::map<std::string, std::string> files_;  ///< by name of the attachment
};

/// The nearest folder above all files.
fs::path FolderAbove(const std::vector<fs::path>& files) {
  fs::path folder = files.front().parent_path();
  for (const fs::path& file : files) {
    while (!Inside(file.lexically_relative(folder)) && folder != folder.root_path()) {
      folder = folder.parent_path();
    }
  }
  return folder;
}

Value ListOf(const std::vector<std::string>& texts) {
  Value::List list;
  for (const std::string& text : texts) list.push_back(Value(text, {}));
  return Value(std::move(list), {});
}

/// The diagram files that were read; and, if a parameter chose one of the parts that come with OCA,
/// the others, which it may choose next time. No other file that it could choose: it may hold
/// anything.
std::vector<fs::path> SourcesOf(const loading::LoadedDiagram& loaded) {
  std::vector<fs::path> sources = loaded.sources;
  for (const fs::path& file : loaded.candidates) {
    const bool there = std::find(sources.begin(), sources.end(), file) != sources.end();
    if (!there && files::IsPartOfOca(file)) sources.push_back(file);
  }
  return sources;
}

void AddSources(const loading::LoadedDiagram& loaded, double duration,
                std::vector<McapAttachment>& attachments) {
  if (loaded.sources.empty()) return;
  const std::vector<fs::path> sources = SourcesOf(loaded);
  const fs::path folder = FolderAbove(sources);
  for (const fs::path& file : sources) {
    const fs::path name = fs::path("sources") / file.lexically_relative(folder);
    attachments.push_back({0, name.string(), "application/yaml", ReadBytes(file)});
  }
  std::vector<std::string> changes;
  for (const files::Override& change : loaded.overrides) {
    changes.push_back(change.path + "=" + change.value);
  }
  if (duration != loaded.simulator.duration) {
    changes.push_back(fmt::format("simulator.duration={}", duration));
  }
  const fs::path main = fs::path("sources") / loaded.sources.front().lexically_relative(folder);
  Value::Map map;
  map.push_back({"diagram", {}, Value(main.string(), {})});
  map.push_back({"overrides", {}, ListOf(changes)});
  attachments.push_back({0, "sources.yaml", "application/yaml", WriteYaml(Value(map, {}))});
}

void Set(Value::Map& map, const std::string& key, Value value) {
  const auto found = std::find_if(map.begin(), map.end(),
                                  [&](const Value::Entry& entry) { return entry.key == key; });
  if (found == map.end()) {
    map.push_back({key, {}, std::move(value)});
  } else {
    found->value = std::move(value);
  }
}

/// The name under which a used file is attached.
std::string NameOf(const loading::LoadedDiagram::UsedFile& used) {
  return "diagram." + used.path + ".yaml";
}

/// A tree with the files that it uses named as they are attached. `path`: of the use, or empty.
Value WithUsedFiles(const loading::LoadedDiagram& loaded, const std::string& path, Value tree) {
  const std::string prefix = path.empty() ? "" : path + ".";
  for (const auto& used : loaded.used_files) {
    if (!used.path.starts_with(prefix)) continue;
    const std::string name = used.path.substr(prefix.size());
    if (name.find('.') != std::string::npos) continue;
    for (Value::Entry& section : *tree.map()) {
      if (section.key != "systems") continue;
      for (Value::Entry& system : *section.value.map()) {
        if (system.key == name) Set(*system.value.map(), "file", Value(NameOf(used), {}));
      }
    }
  }
  return tree;
}

/// A used file that knows all that it is given: what only other parts that could be chosen know is
/// a parameter of its own.
void AddGiven(const loading::LoadedDiagram::UsedFile& used, Value& document) {
  for (const Value::Entry& given : used.given) {
    const Value* const parameters = document.Find("parameters");
    if (parameters != nullptr && parameters->Find(given.key) != nullptr) continue;
    Value::Map all = parameters != nullptr && parameters->map() != nullptr ? *parameters->map()
                                                                           : Value::Map{};
    all.push_back(given);
    Set(*document.map(), "parameters", Value(std::move(all), {}));
  }
}

/// Writes the documents of a run, first the diagram's own, each with its name.
class DocumentWriter {
 public:
  explicit DocumentWriter(const loading::LoadedDiagram& loaded)
      : loaded_(loaded), collector_(loaded) {
    collector_.AddPackagesOf(loaded.resolved);
    own_ = collector_.packages();
  }

  std::vector<McapAttachment> Write(double duration) {
    std::vector<std::pair<std::string, Value>> documents;
    documents.emplace_back("diagram.yaml", Rewrite("", loaded_.document, loaded_.resolved));
    Set(*documents.front().second.map(), "name", Value(loaded_.name, {}));
    if (duration != loaded_.simulator.duration) SetDuration(duration, documents.front().second);
    for (const auto& used : loaded_.used_files) {
      collector_.AddPackagesOf(used.resolved);
      Value document = used.document;
      AddGiven(used, document);
      documents.emplace_back(NameOf(used), Rewrite(used.path, document, used.resolved));
      collector_.SetPackages(own_);
    }
    std::vector<McapAttachment> attachments;
    const Value packages = collector_.Packages();
    for (auto& [name, document] : documents) {
      if (!packages.map()->empty()) Set(*document.map(), "packages", packages);
      attachments.push_back({0, name, "application/yaml", WriteYaml(document)});
    }
    for (McapAttachment& file : collector_.Take()) attachments.push_back(std::move(file));
    return attachments;
  }

 private:
  Value Rewrite(const std::string& path, const Value& document, const Value& resolved) {
    const Value as_attached = WithUsedFiles(loaded_, path, resolved);
    Value written =
        collector_.Rewrite(WithUsedFiles(loaded_, path, document), &as_attached);
    std::erase_if(*written.map(),
                  [](const Value::Entry& entry) { return entry.key == "packages"; });
    return written;
  }

  static void SetDuration(double duration, Value& document) {
    const Value* const section = document.Find("simulator");
    Value simulator =
        section != nullptr && section->map() != nullptr ? *section : Value(Value::Map{}, {});
    Set(*simulator.map(), "duration", Value(duration, {}));
    Set(*document.map(), "simulator", std::move(simulator));
  }

  const loading::LoadedDiagram& loaded_;
  FileCollector collector_;
  files::PackageMap own_;
};

}  // namespace

std::vector<McapAttachment> FilesOf(const loading::LoadedDiagram& loaded, double duration) {
  std::vector<McapAttachment> attachments = DocumentWriter(loaded).Write(duration);
  AddSources(loaded, duration, attachments);
  return attachments;
}

}  // namespace oca::record
