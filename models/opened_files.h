// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

namespace oca::models {

/// Notes the files that are read, on this thread, while it lives: robots, meshes, clouds, maps,
/// tables and diagram files, by whatever way they were named. So a record knows what a run was made
/// from without a second guess at what names a file.
///
///     OpenedFiles opened;
///     LoadUrdf("arm.urdf");
///     Attach(opened.files());
///
/// Of two that live at once both take notes, and what the elder refuses the younger refuses too.
class OpenedFiles {
 public:
  enum class Elder { kNotes, kNotesNot };  ///< what is read while both live

  explicit OpenedFiles(Elder elder = Elder::kNotes);
  /// Refuses files that do not lie below one of `roots`.
  explicit OpenedFiles(std::vector<std::filesystem::path> roots);
  ~OpenedFiles();
  OpenedFiles(const OpenedFiles&) = delete;
  OpenedFiles& operator=(const OpenedFiles&) = delete;

  /// Absolute, each once, in the order in which they were first opened.
  const std::vector<std::filesystem::path>& files() const { return files_; }
  /// Whether a file was opened, by whatever name.
  bool Contains(const std::filesystem::path& file) const;

 private:
  friend void NoteOpened(const std::filesystem::path& file);
  bool Allows(const std::filesystem::path& file) const;
  bool Has(const std::filesystem::path& plain) const;

  OpenedFiles* const outer_;
  const bool apart_{false};  // the outer one does not hear of it
  const bool restricted_{false};
  const std::vector<std::filesystem::path> roots_;
  std::vector<std::filesystem::path> files_;
};

/// To be called by whoever is about to read a file. throws ModelError if it may not be read
void NoteOpened(const std::filesystem::path& file);

/// A path as OpenedFiles has it.
std::filesystem::path PlainPath(const std::filesystem::path& file);

/// Whether a file lies below a folder. A link below it may lead elsewhere, `..` may not.
bool LiesBelow(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace oca::models
