// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "oca/framework/dataflow/value.h"

namespace oca::files {

/// Largest diagram file that is read, bytes.
inline constexpr std::uintmax_t kLargestFile = 8 << 20;

/// Reads strict YAML into a tree whose nodes know file, line and column.
///
/// Strict means: keys are unique; no anchors, aliases, merge keys, tags or second documents; every
/// key has a value; `no`, `010` and their like, which YAML readers take in surprising ways, must be
/// quoted or written plainly; quotes are closed. What is wrong is added to `problems`.
Value ReadYaml(std::string_view text, const std::string& name, Problems& problems);

/// throws ConfigError if the file cannot be read, is too large or no text.
std::string ReadTextFile(const std::filesystem::path& file);

}  // namespace oca::files
