// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/mesh_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <string_view>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/file_cache.h"
#include "oca/models/opened_files.h"

namespace oca::robot {
namespace {

constexpr std::string_view kPackage = "package://";

/// NAME of package://NAME/rest; empty for another one.
std::string PackageOf(const std::string& mesh) {
  if (!mesh.starts_with(kPackage)) return {};
  return mesh.substr(kPackage.size(), mesh.find('/', kPackage.size()) - kPackage.size());
}

/// Where a package may lie.
std::vector<std::filesystem::path> FoldersOf(const std::string& package,
                                             const LoadOptions& options) {
  std::vector<std::filesystem::path> folders;
  if (options.find_package) {
    const std::filesystem::path found = options.find_package(package);
    if (!found.empty()) folders.push_back(found);
  }
  for (const auto& folder : options.package_directories) folders.push_back(folder / package);
  return folders;
}

/// A URI with `%20` and its like as the characters that they stand for.
/// source RFC 3986, section 2.1
std::string Decoded(const std::string& uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned byte = 0;
    const char* const end = uri.data() + std::min(i + 3, uri.size());
    if (uri[i] == '%' && end - (uri.data() + i) == 3 &&
        std::from_chars(uri.data() + i + 1, end, byte, 16).ptr == end && byte != 0) {
      text += static_cast<char>(byte);
      i += 2;
    } else {
      text += uri[i];
    }
  }
  return text;
}

std::vector<std::filesystem::path> CandidatesAsWritten(const std::string& name,
                                                       const std::filesystem::path& directory,
                                                       const LoadOptions& options) {
  for (const std::string_view scheme : {"file://localhost", "file://", "file:"}) {
    if (name.starts_with(scheme)) return {directory / name.substr(scheme.size())};
  }
  if (!name.starts_with(kPackage)) return {directory / name};
  const std::string package = PackageOf(name);
  const std::size_t slash = kPackage.size() + package.size();
  const std::string rest = slash < name.size() ? name.substr(slash + 1) : "";
  std::vector<std::filesystem::path> candidates = FoldersOf(package, options);
  for (std::filesystem::path& folder : candidates) folder /= rest;
  return candidates;
}

/// A URI's first as it is meant, then as it is written, for some write paths without escapes.
std::vector<std::filesystem::path> Candidates(const std::string& name,
                                              const std::filesystem::path& directory,
                                              const LoadOptions& options) {
  std::vector<std::filesystem::path> candidates;
  const bool uri = name.starts_with(kPackage) || name.starts_with("file:");
  if (const std::string meant = Decoded(name); uri && meant != name) {
    candidates = CandidatesAsWritten(meant, directory, options);
  }
  const auto written = CandidatesAsWritten(name, directory, options);
  candidates.insert(candidates.end(), written.begin(), written.end());
  return candidates;
}

/// The first of them that is a file.
std::filesystem::path FirstFile(const std::vector<std::filesystem::path>& candidates,
                                const std::string& name, const std::string& where) {
  std::string tried;
  for (const std::filesystem::path& candidate : candidates) {
    std::error_code error;
    if (std::filesystem::is_regular_file(candidate, error)) {
      models::NoteOpened(candidate);  // whoever asks will read or show it
      return candidate;
    }
    tried += (tried.empty() ? "" : " or ") + candidate.string();
  }
  const char* const elsewhere = PackageOf(name).empty() ? "a path" : "a known package";
  throw models::ModelError(fmt::format("{}: missing mesh file; got '{}'; expected a file at {}",
                                       where, name, tried.empty() ? elsewhere : tried));
}

/// A message for meshes of a package that lies at none of `folders`.
std::string LostPackage(const std::string& package, const std::vector<NeededMesh>& meshes,
                        const std::vector<std::filesystem::path>& folders,
                        const std::string& advice) {
  constexpr std::size_t kShown = 3;
  std::string names;
  for (std::size_t i = 0; i < std::min(kShown, meshes.size()); ++i) {
    names += (i == 0 ? "" : ", ") + fmt::format("'{}'", meshes[i].name);
    if (i > 0) names += fmt::format(" ({})", meshes[i].where);
  }
  if (meshes.size() > kShown) names += fmt::format(" and {} more", meshes.size() - kShown);
  std::string places;
  for (const auto& folder : folders) places += (places.empty() ? "" : " or ") + folder.string();
  return fmt::format("{}: missing mesh file, for there is no package '{}'; got {}; expected {}{}",
                     meshes.front().where, package, names,
                     places.empty() ? "a known package" : "its folder at " + places, advice);
}

}  // namespace

std::filesystem::path FindMesh(const std::string& name, const std::filesystem::path& directory,
                               const LoadOptions& options, const std::string& where) {
  const std::vector<std::filesystem::path> candidates = Candidates(name, directory, options);
  std::string places;
  for (const std::filesystem::path& candidate : candidates) places += candidate.native() + '\n';
  return *models::ReadOnce<std::filesystem::path>(
      name, places, [&] { return FirstFile(candidates, name, where); });
}

void CheckMeshes(const std::vector<NeededMesh>& meshes, const std::filesystem::path& directory,
                 const LoadOptions& options, models::ModelErrors& errors) {
  std::map<std::string, std::vector<NeededMesh>> lost;  // by the package that is nowhere
  for (const NeededMesh& mesh : meshes) {
    const std::string package = PackageOf(mesh.name);
    const auto is_folder = [](const std::filesystem::path& folder) {
      std::error_code error;
      return std::filesystem::is_directory(folder, error);
    };
    const auto folders = FoldersOf(package, options);
    if (!package.empty() && std::none_of(folders.begin(), folders.end(), is_folder)) {
      lost[package].push_back(mesh);
    } else {
      errors.Try([&] { FindMesh(mesh.name, directory, options, mesh.where); });
    }
  }
  for (const auto& entry : lost) {
    errors.Add(LostPackage(entry.first, entry.second, FoldersOf(entry.first, options),
                           options.package_advice));
  }
}

}  // namespace oca::robot
