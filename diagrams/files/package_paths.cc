// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/package_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <sstream>
#include <string_view>

#include "oca/diagrams/files/data_folders.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/file_cache.h"

namespace oca::files {

namespace fs = std::filesystem;

std::string FormOf(const PackageMap& packages) {
  std::string form;
  for (const auto& [name, folder] : packages) form += '\n' + name + ' ' + folder.native();
  return form;
}

std::vector<fs::path> PackageFolders() {
  std::vector<fs::path> folders;
  if (const char* const list = std::getenv("OCA_PACKAGE_PATH")) {
    std::istringstream stream(list);
    for (std::string folder; std::getline(stream, folder, ':');) {
      if (!folder.empty()) folders.emplace_back(folder);
    }
  }
  for (const fs::path& data : DataFolders()) {
    for (const char* const kind : {"robots", "worlds"}) {
      std::error_code error;
      const fs::path models = data / "models" / kind;
      if (fs::is_directory(models, error)) folders.push_back(models);
    }
  }
  return folders;
}

fs::path KnownPackage(const std::string& package) {
  for (const fs::path& folder : PackageFolders()) {
    std::error_code error;
    if (fs::is_directory(folder / package, error)) return folder / package;
  }
  return {};
}

fs::path PackageFor(const fs::path& file, const std::string& package) {
  if (fs::path known = KnownPackage(package); !known.empty()) return known;
  std::error_code error;
  for (fs::path folder = fs::absolute(file, error).lexically_normal().parent_path();
       folder.has_relative_path(); folder = folder.parent_path()) {
    if (folder.filename() == package) return folder;
    if (fs::is_directory(folder / package, error)) return folder / package;
  }
  return {};
}

namespace {

/// The package that is the diagrams which come with OCA.
constexpr std::string_view kDiagrams = "oca";

/// The folder of a package that a file does not say. `name` is what is looked for in it.
fs::path FindPackage(const std::string& package, const std::string& name) {
  if (package == kDiagrams) {
    for (const fs::path& data : DataFolders()) {
      std::error_code error;
      if (fs::is_directory(data / "diagrams", error)) return data / "diagrams";
    }
  }
  if (fs::path known = KnownPackage(package); !known.empty()) return known;
  std::string places;
  for (const fs::path& place : PackageFolders()) {
    places += (places.empty() ? "" : ", ") + place.string();
  }
  throw ConfigError(fmt::format("{}: no package '{}'; looked in packages, {}", name, package,
                                places.empty() ? "OCA_PACKAGE_PATH" : places));
}

/// A path without the `..` behind a folder, if that leads to the same folder: a link before it
/// would lead elsewhere. What a file is called in messages, and what it names in turn lies from
/// there.
fs::path InShort(const fs::path& file) {
  if (std::find(file.begin(), file.end(), "..") == file.end()) return file;
  const fs::path plain = file.lexically_normal();
  const auto folder = [](const fs::path& of) {
    return of.has_parent_path() ? of.parent_path() : fs::path(".");
  };
  std::error_code error;
  return fs::equivalent(folder(plain), folder(file), error) ? plain : file;
}

}  // namespace

fs::path ResolvePath(const std::string& name, const fs::path& folder, const PackageMap& packages) {
  static const std::string kScheme = "package://";
  if (!name.starts_with(kScheme)) return InShort(folder / name);  // which is name if absolute
  const std::string rest = name.substr(kScheme.size());
  const std::string package = rest.substr(0, rest.find('/'));
  const fs::path inside = rest.size() > package.size() ? rest.substr(package.size() + 1) : "";
  if (const auto found = packages.find(package); found != packages.end()) {
    return found->second / inside;
  }
  return *models::ReadOnce<fs::path>(kScheme + package, "folder", [&] {
    return FindPackage(package, name);
  }) / inside;
}

bool IsPartOfOca(const fs::path& file) {
  constexpr std::string_view kParts = OCA_PARTS;  // their names, each between two |
  if (kParts.find("|" + file.filename().string() + "|") == std::string_view::npos) return false;
  const auto content = [](const fs::path& name) -> std::optional<std::string> {
    try {
      return models::ReadUnnoted(name);
    } catch (const models::ModelError&) {  // there is none
      return std::nullopt;
    }
  };
  const auto own = content(file);
  const auto folders = DataFolders();
  return own && std::any_of(folders.begin(), folders.end(), [&](const fs::path& data) {
           return own == content(data / "diagrams/parts" / file.filename());
         });
}

}  // namespace oca::files
