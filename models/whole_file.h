// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>

namespace oca::models {

/// A file of our own that is not to stay: made empty in a folder, under a name that nobody has, and
/// gone with this; RemoveUnfinished removes it too.
class UnfinishedFile {
 public:
  /// throws ModelError `FOLDER: a file in it; got REASON; expected a folder that can be written`
  explicit UnfinishedFile(const std::filesystem::path& folder);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// It has another name now, and is left alone.
  void Forget();

 private:
  friend class WholeFile;
  UnfinishedFile() = default;
  int Make(const std::filesystem::path& folder);  // 0, or the error's number

  std::filesystem::path path_;
  int slot_{-1};
};

/// The one way in which files of results come about, those aside that a run appends to while it
/// goes on (records): whole, or not at all. It is written beside its place and takes it with
/// Commit, so that what was there stays until then, and stays if anything goes wrong, an interrupt
/// too. A link is followed, permissions of what is replaced are kept. Pipes and devices are written
/// at once, and so is a file in a folder that takes no new ones.
///
///     WholeFile file("page.html");
///     file.stream() << text;
///     file.Commit();
class WholeFile {
 public:
  /// throws ModelError `FILE: cannot be written; got REASON; expected ...`
  explicit WholeFile(const std::filesystem::path& file);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  std::ofstream& stream() { return stream_; }
  /// Where it is until Commit, for another writer than `stream`.
  const std::filesystem::path& part() const;
  /// throws ModelError as above if it could not be written to the end
  void Commit();

 private:
  [[noreturn]] void Refuse(const std::string& reason) const;

  const std::filesystem::path file_;
  std::filesystem::path target_;  // where links lead
  std::unique_ptr<UnfinishedFile> part_;
  std::ofstream stream_;
};

/// A WholeFile of these bytes. throws ModelError as it does
void WriteWhole(const std::filesystem::path& file, std::string_view bytes);

/// Removes all UnfinishedFiles that there are. For handlers of signals that end the program next.
void RemoveUnfinished() noexcept;

}  // namespace oca::models
