// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/data_folders.h"

#include <algorithm>
#include <system_error>

namespace oca::files {

namespace fs = std::filesystem;

namespace {

/// Where other programs' installations of OCA lie; complete before main.
std::vector<fs::path>& ToldFolders() {
  static std::vector<fs::path> folders;
  return folders;
}

}  // namespace

std::vector<fs::path> DataFolders() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  std::vector<fs::path> folders{program.parent_path().parent_path() / OCA_INSTALLED_DATA};
  folders.insert(folders.end(), ToldFolders().begin(), ToldFolders().end());
  folders.emplace_back(OCA_SOURCE_DATA);
  return folders;
}

void AddDataFolder(const fs::path& folder) {
  std::vector<fs::path>& told = ToldFolders();
  if (std::find(told.begin(), told.end(), folder) == told.end()) told.push_back(folder);
}

}  // namespace oca::files
