// SPDX-License-Identifier: BSD-3-Clause
// What readers of the fuzzers share.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "oca/framework/dataflow/error_base.h"
#include "oca/models/opened_files.h"
#include "tests/fuzz/readers.h"
#include "tests/temporary_folder.h"

namespace oca::test {

/// What the readers of one source file are.
std::vector<Reader> ShapeReaders();
std::vector<Reader> RobotReaders();
std::vector<Reader> DiagramReaders();
std::vector<Reader> RecordReaders();
std::vector<Reader> NetworkReaders();

/// Of this process.
inline const std::filesystem::path& FuzzFolder() {
  static const TemporaryFolder folder;
  return folder.path();
}

/// The file of that name there, with these bytes.
inline std::filesystem::path FileOf(const char* name, std::string_view bytes) {
  const std::filesystem::path file = FuzzFolder() / name;
  std::filesystem::remove(file);  // made anew: to cut one short waits for the disk
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

/// Calls `read`, which finds no files but those of FuzzFolder and of OCA, and returns whether it
/// did not refuse.
template <class Read>
bool Accepts(Read read) {
  const models::OpenedFiles within(
      std::vector<std::filesystem::path>{FuzzFolder(), OCA_SOURCE_DIR});
  try {
    read();
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace oca::test
