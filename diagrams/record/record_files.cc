// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/record_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "oca/diagrams/files/document.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/record/file_collector.h"
#include "oca/diagrams/record/yaml_writer.h"
#include "oca/models/foreign_text.h"
#include "oca/models/opened_files.h"

namespace oca::record {
namespace {

namespace fs = std::filesystem;

/// The nearest folder above all files, by their names.
fs::path FolderAbove(const std::vector<fs::path>& files) {
  fs::path folder = models::PlainPath(files.front()).parent_path();
  for (const fs::path& file : files) {
    while (!Inside(models::PlainPath(file).lexically_relative(folder)) &&
           folder != folder.root_path()) {
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
                std::vector<Attachment>& attachments) {
  if (loaded.sources.empty()) return;
  const std::vector<fs::path> sources = SourcesOf(loaded);
  const fs::path folder = FolderAbove(sources);
  const auto name_of = [&](const fs::path& file) {
    return models::internal::SpeltAsUtf8(
        (fs::path("sources") / models::PlainPath(file).lexically_relative(folder)).native());
  };
  for (const fs::path& file : sources) {
    attachments.push_back({0, name_of(file), "application/yaml", ReadBytes(file)});
  }
  std::vector<std::string> changes;
  for (const files::Override& change : loaded.overrides) {
    changes.push_back(change.path + "=" + change.value);
  }
  if (duration != loaded.simulator.duration) {
    changes.push_back(fmt::format("simulator.duration={}", duration));
  }
  Value::Map map;
  map.push_back({"diagram", {}, Value(name_of(loaded.sources.front()), {})});
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
std::string NameOf(const loading::LoadedDiagram::InnerFile& used) {
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
void AddGiven(const loading::LoadedDiagram::InnerFile& used, Value& document) {
  for (const Value::Entry& given : used.given) {
    const Value* const parameters = document.Find("parameters");
    if (parameters != nullptr && parameters->Find(given.key) != nullptr) continue;
    Value::Map all =
        parameters != nullptr && parameters->map() != nullptr ? *parameters->map() : Value::Map{};
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

  std::vector<Attachment> Write(double duration) {
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
    std::vector<Attachment> attachments;
    const Value packages = collector_.Packages();
    for (auto& [name, document] : documents) {
      if (!packages.map()->empty()) Set(*document.map(), "packages", packages);
      attachments.push_back({0, name, "application/yaml", WriteYaml(document)});
    }
    for (Attachment& file : collector_.Take()) attachments.push_back(std::move(file));
    return attachments;
  }

 private:
  Value Rewrite(const std::string& path, const Value& document, const Value& resolved) {
    const Value as_attached = WithUsedFiles(loaded_, path, resolved);
    Value written = collector_.Rewrite(WithUsedFiles(loaded_, path, document), &as_attached);
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

std::vector<Attachment> FilesOf(const loading::LoadedDiagram& loaded, double duration) {
  std::vector<Attachment> attachments = DocumentWriter(loaded).Write(duration);
  AddSources(loaded, duration, attachments);
  return attachments;
}

}  // namespace oca::record
