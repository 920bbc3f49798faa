// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/extracted_record.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <utility>

#include "oca/diagrams/files/package_paths.h"
#include "oca/diagrams/files/yaml_reader.h"
#include "oca/diagrams/record/file_collector.h"
#include "oca/diagrams/record/mcap_bytes.h"
#include "oca/diagrams/record/temporary_name.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/foreign_text.h"
#include "oca/models/opened_files.h"

namespace oca::record {
namespace {

namespace fs = std::filesystem;

/// Puts the files that a diagram names by their place to where its sources look for them; false if
/// one would leave the folder.
bool PlaceFiles(const fs::path& folder, const fs::path& beside) {
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder / "files", error), end; !error && at != end;
       at.increment(error)) {
    if (!at->is_regular_file(error)) continue;
    fs::path place = beside;
    for (const fs::path& part : at->path().lexically_relative(folder / "files")) {
      place /= part == "up" ? fs::path("..") : part;
    }
    place = place.lexically_normal();
    if (!Inside(place.lexically_relative(folder))) return false;
    if (fs::exists(place, error)) continue;
    fs::create_directories(place.parent_path(), error);
    fs::create_symlink(at->path(), place, error);
  }
  return true;
}

/// What the copy of a package in a record lacks, from the package of this machine.
void CompletePackage(const fs::path& copy) {
  std::error_code error;
  for (const fs::path& place : files::PackageFolders()) {
    const fs::path package = place / copy.filename();
    if (!fs::is_directory(package, error)) continue;
    for (fs::recursive_directory_iterator at(package, error), end; !error && at != end;
         at.increment(error)) {
      const fs::path to = copy / at->path().lexically_relative(package);
      std::error_code not_there;
      if (!at->is_regular_file(not_there) || fs::exists(to, not_there)) continue;
      fs::create_directories(to.parent_path(), not_there);
      fs::create_symlink(fs::absolute(at->path()), to, not_there);
    }
    return;
  }
}

/// All packages of a record, as a diagram is told of them.
std::vector<files::Override> CompletePackages(const fs::path& folder) {
  std::vector<files::Override> packages;
  std::error_code error;
  for (fs::directory_iterator at(folder / "packages", error), end; !error && at != end;
       at.increment(error)) {
    CompletePackage(at->path());
    packages.push_back({"packages." + at->path().filename().string(), at->path().string()});
  }
  return packages;
}

bool HasSources(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "sources.yaml", error);
}

/// The diagram file as it was written, and the overrides of the run.
std::pair<fs::path, std::vector<files::Override>> ReadSources(const fs::path& folder) {
  const fs::path list = folder / "sources.yaml";
  Problems problems;
  const std::string text = files::ReadTextFile(list);
  const Value sources = files::ReadYaml(text, list.string(), problems);
  const Value* const name = sources.Find("diagram");
  const Value* const recorded = sources.Find("overrides");
  problems.Throw();
  if (name == nullptr || name->string() == nullptr ||
      !Inside(fs::path(*name->string()).lexically_normal())) {
    throw ConfigError(list.string() + ": diagram: got no file of the record; expected its name");
  }
  std::vector<files::Override> overrides;
  if (recorded != nullptr && recorded->list() != nullptr) {
    for (const Value& change : *recorded->list()) {
      const std::string* const written = change.string();
      if (written == nullptr || written->find('=') == written->npos || written->starts_with('=')) {
        throw ConfigError(list.string() + ": overrides: got no change; expected PATH=VALUE");
      }
      overrides.push_back(files::Override::Parse(*written));
    }
  }
  return {folder / *name->string(), overrides};
}

/// The diagram files that came with a record, those that could be chosen too; first `main`.
std::vector<fs::path> SourcesIn(const fs::path& folder, const fs::path& main) {
  std::vector<fs::path> sources;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder / "sources", error), end; !error && at != end;
       at.increment(error)) {
    const bool own = at->is_regular_file(error) && !at->is_symlink(error);  // see PlaceFiles
    if (own && at->path() != main.lexically_normal()) sources.push_back(at->path());
  }
  std::sort(sources.begin(), sources.end());
  sources.insert(sources.begin(), main.lexically_normal());
  return sources;
}

}  // namespace

void ExtractFiles(const McapFile& record, const fs::path& folder) {
  if (record.FindAttachment("diagram.yaml") == nullptr) {
    throw ConfigError(
        record.complete()
            ? record.name() + ": has no attachment diagram.yaml; expected a record of OCA"
            : fmt::format("{}: {}; got no attachment diagram.yaml before it; expected one",
                          record.name(), record.problem()));
  }
  std::set<fs::path> names;
  for (const Attachment& attachment : record.attachments()) {
    const fs::path name = fs::path(attachment.name).lexically_normal();
    const bool text = models::internal::AsUtf8(attachment.name) == attachment.name &&
                      attachment.name.find('\0') == std::string::npos;
    if (!text || !Inside(name) || !name.has_filename()) {
      throw ConfigError(
          fmt::format("{}: attachment; got '{}'; expected a name of a file, in UTF-8, that stays "
                      "below its folder",
                      record.name(), attachment.name));
    }
    if (!names.insert(name).second) {
      throw ConfigError(fmt::format("{}: attachment; got '{}' twice; expected each name once",
                                    record.name(), name.string()));
    }
    const fs::path file = folder / name;
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    std::ofstream stream(file, std::ios::binary);
    stream.write(attachment.data.data(), static_cast<std::streamsize>(attachment.data.size()));
    if (!stream.flush()) throw ConfigError(fmt::format("{}: cannot be written", file.string()));
  }
}

ExtractedRecord::ExtractedRecord(const McapFile& record) {
  std::string name = internal::TemporaryName("oca_record");
  if (mkdtemp(name.data()) == nullptr) {
    throw ConfigError(fmt::format("{}: cannot be made", name));
  }
  folder_ = name;
  try {
    ExtractFiles(record, folder_);
  } catch (...) {
    Remove();
    throw;
  }
}

ExtractedRecord::~ExtractedRecord() { Remove(); }

loading::LoadedDiagram ExtractedRecord::Load(const std::vector<files::Override>& overrides,
                                             const files::Catalogue& catalogue) const {
  std::vector<fs::path> folders = files::PackageFolders();
  folders.push_back(folder_);
  models::OpenedFiles restricted(folders);  // whoever made it knows not what we keep
  if (overrides.empty() && !HasSources(folder_)) {
    return loading::LoadDiagram(diagram(), {}, catalogue);
  }
  std::vector<files::Override> packages;
  if (!overrides.empty()) packages = CompletePackages(folder_);
  if (!HasSources(folder_)) return loading::LoadDiagram(diagram(), overrides, catalogue);
  auto [main, all] = ReadSources(folder_);
  all.insert(all.end(), overrides.begin(), overrides.end());
  loading::LoadedDiagram loaded;
  if (!overrides.empty() && PlaceFiles(folder_, main.parent_path())) {
    std::vector<files::Override> with_packages = all;
    with_packages.insert(with_packages.end(), packages.begin(), packages.end());
    loaded = loading::LoadDiagram(main, with_packages, catalogue);
  } else {
    loaded = loading::LoadDiagram(diagram(), overrides, catalogue);
  }
  loaded.sources = SourcesIn(folder_, main);
  loaded.candidates.clear();
  loaded.overrides = all;
  return loaded;
}

void ExtractedRecord::Remove() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

bool IsRecord(const fs::path& file) {
  return models::BeginningOf(file, kMcapMagic.size()) == kMcapMagic;
}

}  // namespace oca::record
