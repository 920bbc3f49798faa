// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/output_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "oca/framework/dataflow/error.h"

namespace oca::runs {
namespace {

namespace fs = std::filesystem;

bool Same(const fs::path& one, const fs::path& other) {
  std::error_code error;
  if (fs::exists(one, error) && fs::exists(other, error)) {
    return fs::equivalent(one, other, error) && !error && !fs::is_other(one, error);
  }
  const fs::path place = fs::weakly_canonical(fs::absolute(one), error);
  return !error && place == fs::weakly_canonical(fs::absolute(other), error) && !error;
}

[[noreturn]] void Refuse(const OutputFile& output, const std::string& role) {
  throw ConfigError(fmt::format("{}: {} is {}; expected another file to write", output.what,
                                output.path.string(), role));
}

[[noreturn]] void RefuseToWrite(const OutputFile& output, int error) {
  throw ConfigError(fmt::format("{}: {} cannot be written: {}; expected a {} that can", output.what,
                                output.path.string(), std::strerror(error),
                                output.folder ? "folder" : "file"));
}

/// The folder that something is made in: `.` for a bare name.
fs::path FolderOf(const fs::path& path) {
  const fs::path folder = path.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

/// A look beforehand, which opens and makes nothing.
void RequireWritable(const OutputFile& output, const std::vector<OutputFile>& all) {
  std::error_code ignored;
  fs::path path = output.path;
  if (fs::exists(path, ignored)) {
    if (fs::is_directory(path, ignored) != output.folder) {
      RefuseToWrite(output, output.folder ? ENOTDIR : EISDIR);
    }
  } else {
    const bool made = output.folder || std::any_of(all.begin(), all.end(), [&](const auto& other) {
                        return other.folder && other.path == FolderOf(path);
                      });
    path = FolderOf(path);
    while (made && !fs::exists(path, ignored)) path = FolderOf(path);
  }
  const bool folder = path != output.path || output.folder;
  if (folder && fs::exists(path, ignored) && !fs::is_directory(path, ignored)) {
    RefuseToWrite(output, ENOTDIR);
  }
  if (access(path.c_str(), folder ? W_OK | X_OK : W_OK) != 0) RefuseToWrite(output, errno);
}

}  // namespace

std::vector<InputFile> InputsOf(const std::vector<fs::path>& files, const std::string& role) {
  std::vector<InputFile> inputs;
  for (const fs::path& file : files) inputs.push_back({file, role});
  return inputs;
}

void CheckOutputs(const std::vector<OutputFile>& outputs, const std::vector<InputFile>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].path.empty()) continue;
    for (const InputFile& input : inputs) {
      if (Same(outputs[i].path, input.path)) Refuse(outputs[i], input.role);
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (outputs[j].path.empty() || !Same(outputs[i].path, outputs[j].path)) continue;
      Refuse(outputs[i], "what " + outputs[j].what + " writes");
    }
    RequireWritable(outputs[i], outputs);
  }
}

}  // namespace oca::runs
