// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/mesh_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/file_cache.h"
#include "oca/models/opened_files.h"

namespace oca::robot {
namespace {

std::vector<std::filesystem::path> Candidates(const std::string& name,
                                              const std::filesystem::path& directory,
                                              const LoadOptions& options) {
  constexpr std::string_view kPackage = "package://";
  constexpr std::string_view kFile = "file://";
  if (name.starts_with(kFile)) return {directory / name.substr(kFile.size())};
  if (!name.starts_with(kPackage)) return {directory / name};
  const std::size_t slash = std::min(name.find('/', kPackage.size()), name.size());
  const std::string package = name.substr(kPackage.size(), slash - kPackage.size());
  const std::string rest = slash < name.size() ? name.substr(slash + 1) : "";
  std::vector<std::filesystem::path> candidates;
  if (options.find_package) {
    const std::filesystem::path found = options.find_package(package);
    if (!found.empty()) candidates.push_back(found / rest);
  }
  for (const auto& folder : options.package_directories) {
    candidates.push_back(folder / package / rest);
  }
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
  throw models::ModelError(fmt::format("{}: missing mesh file; got '{}'; expected a file at {}",
                                       where, name, tried.empty() ? "a known package" : tried));
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

}  // namespace oca::robot
