// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "oca/diagrams/files/override.h"
#include "oca/framework/dataflow/value.h"

namespace oca::files {

/// The files behind a document, absolute, each by the way that led to it: links are not followed.
struct DocumentSources {
  std::vector<std::filesystem::path> files{};  ///< those that were read, first the diagram file
  std::vector<std::filesystem::path> candidates{};  ///< diagram files beside one that was chosen
  std::vector<std::string> choosing{};              ///< parameters that chose files
  std::set<std::string> chosen{};  ///< files, as locations name them, that came by such a choice
  std::vector<std::filesystem::path> alternatives{};  ///< candidates that the same include can name
};

/// Files as one tree.
struct MergedFiles {
  Value root;
  std::shared_ptr<const DocumentSources> sources;
};

/// A diagram file as one tree: the files it includes first, itself over them. Of overrides only
/// those that choose files count here; ApplyOverrides sets all of them in the tree.
///
/// Maps are merged key by key, `connections` are appended, everything else is replaced. Included
/// paths are relative to the file that includes; `${name}` in one is replaced by the parameter of
/// that name, a text, as overrides, the including files from the outermost on, or the file itself
/// say first. Problems of all files are added to `problems`. `parameters`, if given, is a map of
/// values that another file gives to this one, in place of its own. While a models::FileCache is in
/// use, each file is read once.
MergedFiles LoadFiles(const std::filesystem::path& file, const std::vector<Override>& overrides,
                      Problems& problems, const Value* parameters = nullptr);

}  // namespace oca::files
