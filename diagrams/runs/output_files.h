// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace oca::runs {

/// A file that is about to be written.
struct OutputFile {
  std::string what;  ///< names it in an error: `record`, or the option of a command
  std::filesystem::path path;
  bool folder{false};  ///< which is made if need be
};

/// A file that is read.
struct InputFile {
  std::filesystem::path path;
  std::string role;  ///< `what is run`
};

/// The files of a list in one role.
std::vector<InputFile> InputsOf(const std::vector<std::filesystem::path>& files,
                                const std::string& role);

/// Before anything is written: refuses an output that would replace an input or another output,
/// whatever the names: a link of either kind counts, and files that are yet to be made. Pipes and
/// devices may be written twice. Refuses also what nobody may write, or has no folder to lie in.
/// throws ConfigError `record: mine.yaml is what is run; expected another file to write`,
///        `record: no/a.mcap cannot be written: No such file or directory; expected ...`
void CheckOutputs(const std::vector<OutputFile>& outputs, const std::vector<InputFile>& inputs);

}  // namespace oca::runs
