// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "oca/models/error.h"

namespace oca::models {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // as the kernel follows
constexpr int kMostNames = 1000;

// What a handler of signals reads: names that stand still as long as they are here. Beyond so many
// at once nobody removes them for us.
std::array<std::atomic<const char*>, 1024> unfinished{};
static_assert(std::atomic<const char*>::is_always_lock_free);

int TakeSlot(const char* name) {
  for (std::size_t i = 0; i < unfinished.size(); ++i) {
    const char* none = nullptr;
    if (unfinished[i].compare_exchange_strong(none, name)) return static_cast<int>(i);
  }
  return -1;
}

/// Made with the rights that the user's mask leaves; false, and errno, if it is not.
bool MakeEmpty(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor >= 0) ::close(descriptor);
  return descriptor >= 0;
}

fs::path FolderOfPath(const fs::path& file) {
  const fs::path folder = file.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

fs::path BehindLinks(fs::path file) {
  std::error_code error;
  for (int links = 0; links < kMostLinks && fs::is_symlink(file, error); ++links) {
    file = file.parent_path() / fs::read_symlink(file, error);
  }
  return file;
}

/// Whether a file is to be written where it is: a pipe, a device, or one whose folder is closed.
bool WrittenInPlace(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return false;
  return !fs::is_regular_file(file, error) ||
         ::access(FolderOfPath(file).c_str(), W_OK | X_OK) != 0;
}

std::string WhyNotWritten(int error) {
  return error == 0 ? "less room than it takes" : std::strerror(error);
}

}  // namespace

UnfinishedFile::UnfinishedFile(const fs::path& folder) {
  const int why = Make(folder);
  if (why == 0) return;
  throw ModelError(fmt::format("{}: a file in it; got {}; expected a folder that can be written",
                               folder.string(), WhyNotWritten(why)));
}

int UnfinishedFile::Make(const fs::path& folder) {
  static std::atomic<int> made{0};
  int why = EEXIST;
  for (int tries = 0; why == EEXIST && tries < kMostNames; ++tries) {
    path_ = folder / fmt::format(".oca-{}-{}", ::getpid(), made++);
    // First the slot, lest a signal between the two leaves the file.
    slot_ = TakeSlot(path_.c_str());
    if (MakeEmpty(path_)) return 0;
    why = errno;
    Forget();
  }
  return why;
}

UnfinishedFile::~UnfinishedFile() {
  if (path_.empty()) return;
  ::unlink(path_.c_str());
  Forget();
}

void UnfinishedFile::Forget() {
  if (slot_ >= 0) unfinished[static_cast<std::size_t>(slot_)] = nullptr;
  slot_ = -1;
  path_.clear();
}

WholeFile::WholeFile(const fs::path& file) : file_(file), target_(BehindLinks(file)) {
  if (!WrittenInPlace(target_)) {
    part_.reset(new UnfinishedFile);
    if (const int why = part_->Make(FolderOfPath(target_)); why != 0) Refuse(WhyNotWritten(why));
  }
  errno = 0;
  stream_.open(part(), std::ios::binary | std::ios::trunc);
  if (!stream_) Refuse(WhyNotWritten(errno));
}

WholeFile::~WholeFile() = default;

const fs::path& WholeFile::part() const { return part_ ? part_->path() : target_; }

void WholeFile::Commit() {
  errno = 0;
  stream_.close();
  if (!stream_) Refuse(WhyNotWritten(errno));
  if (!part_) return;
  std::error_code error;
  if (fs::exists(target_, error)) {
    fs::permissions(part(), fs::status(target_, error).permissions(), error);
  }
  error.clear();
  fs::rename(part(), target_, error);
  if (error) Refuse(error.message());
  part_->Forget();
  part_.reset();
}

void WholeFile::Refuse(const std::string& reason) const {
  throw ModelError(fmt::format(
      "{}: cannot be written; got {}; expected a file, and a folder with room, that can be written",
      file_.string(), reason));
}

void WriteWhole(const fs::path& file, std::string_view bytes) {
  WholeFile whole(file);
  whole.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  whole.Commit();
}

void RemoveUnfinished() noexcept {
  for (const auto& name : unfinished) {
    if (const char* const path = name.load()) ::unlink(path);
  }
}

}  // namespace oca::models
