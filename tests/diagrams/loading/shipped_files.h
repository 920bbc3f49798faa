// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace oca::loading::shipped_files {

inline const std::filesystem::path kFolder = OCA_SOURCE_DIR "/diagrams";

/// Of the diagrams that are files of their own, from kFolder.
inline std::vector<std::string> DiagramFiles() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kFolder)) {
    const std::filesystem::path name = entry.path().lexically_relative(kFolder);
    if (name.extension() == ".yaml" && *name.begin() != "parts") files.push_back(name.string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The name of a test of one of them.
inline std::string TestName(const testing::TestParamInfo<std::string>& file) {
  std::string name = std::filesystem::path(file.param).replace_extension().string();
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

}  // namespace oca::loading::shipped_files
