// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "oca/framework/dataflow/value.h"

namespace oca::files {

/// `-s PATH=VALUE`: PATH is dot-separated keys, items of lists by index from 0; VALUE is YAML.
struct Override {
  std::string path{};
  std::string value{};
  /// throws ConfigError if `text` is not PATH=VALUE.
  static Override Parse(const std::string& text);
};

/// The files behind a document.
struct DocumentSources {
  std::vector<std::filesystem::path> files{};  ///< those that were read, first the diagram file
  std::vector<std::filesystem::path> candidates{};  ///< diagram files beside one that was chosen
  std::vector<std::string> choosing{};              ///< parameters that chose files
  std::set<std::string> chosen{};  ///< files, as locations name them, that came by such a choice
  std::vector<std::filesystem::path> alternatives{};  ///< candidates that the same include can name
};

/// A diagram file as one tree: the files it includes first, itself over them, overrides over all.
///
/// Maps are merged key by key, `connections` are appended, everything else is replaced. Included
/// paths are relative to the file that includes; `${name}` in one is replaced by the parameter of
/// that name, a text, as overrides, the including files from the outermost on, or the file itself
/// say first. Problems of all files are added to `problems`; `sources`, if given, is told what was
/// read.
Value LoadDocument(const std::filesystem::path& file, const std::vector<Override>& overrides,
                   Problems& problems, DocumentSources* sources = nullptr);

/// The two halves of it: the merged files, of which overrides only choose; and the overrides.
Value LoadFiles(const std::filesystem::path& file, const std::vector<Override>& overrides,
                Problems& problems, DocumentSources* sources = nullptr);
void ApplyOverrides(const std::vector<Override>& overrides, Value& root, Problems& problems);

}  // namespace oca::files
