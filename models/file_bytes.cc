// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/file_bytes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <new>

#include "oca/models/error.h"
#include "oca/models/opened_files.h"

namespace oca::models {
namespace {

namespace fs = std::filesystem;

/// An open file, or one that errno says why it is not.
class Descriptor {
 public:
  explicit Descriptor(const fs::path& file)
      : number_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  bool open() const { return number_ >= 0; }
  bool Stat(struct stat& status) const { return ::fstat(number_, &status) == 0; }
  /// Fewer than `count` at the end of the file, and after an error.
  std::size_t Read(char* to, std::size_t count) const {
    std::size_t done = 0;
    while (done < count) {
      const ssize_t got = ::read(number_, to + done, count - done);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      done += static_cast<std::size_t>(got);
    }
    return done;
  }

 private:
  const int number_;
};

[[noreturn]] void RefuseFile(const fs::path& file, const std::string& what) {
  throw ModelError(fmt::format("{}: {}", file.string(), what));
}

[[noreturn]] void RefuseUnreadable(const fs::path& file) {
  const std::string why = errno == ENOENT ? "no such file" : std::strerror(errno);
  RefuseFile(file, fmt::format("cannot be read; got {}; expected a file", why));
}

void RequireRegular(const fs::path& file, const struct stat& status) {
  if (S_ISREG(status.st_mode)) return;
  RefuseFile(file, "not a regular file; got a folder, pipe or device; expected a file");
}

bool MakeRoom(std::string& bytes, std::uintmax_t size) {
  try {
    bytes.resize(size);
    return true;
  } catch (const std::exception&) {  // std::bad_alloc, std::length_error
    return false;
  }
}

}  // namespace

std::string ReadFile(const fs::path& file, std::uintmax_t most) {
  NoteOpened(file);
  return ReadUnnoted(file, most);
}

std::string ReadUnnoted(const fs::path& file, std::uintmax_t most) {
  if (file.native().find('\0') != std::string::npos) {
    RefuseFile(file, "cannot be read; got a zero byte in its name; expected a file");
  }
  struct stat status;
  // Devices are not even opened, which may do something.
  if (::stat(file.c_str(), &status) != 0) RefuseUnreadable(file);
  RequireRegular(file, status);
  const Descriptor descriptor(file);
  if (!descriptor.open() || !descriptor.Stat(status)) RefuseUnreadable(file);
  RequireRegular(file, status);
  const auto size = static_cast<std::uintmax_t>(status.st_size);
  if (size > most) {
    RefuseFile(file, fmt::format("too large; got {} bytes; expected at most {}", size, most));
  }
  std::string bytes;
  if (!MakeRoom(bytes, size)) {
    RefuseFile(file,
               fmt::format("too large; got no memory for {} bytes; expected a smaller file", size));
  }
  errno = EIO;
  if (descriptor.Read(bytes.data(), bytes.size()) < bytes.size()) RefuseUnreadable(file);
  return bytes;
}

std::string BeginningOf(const fs::path& file, std::size_t count) {
  struct stat status;
  if (::stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return {};
  const Descriptor descriptor(file);
  if (!descriptor.open()) return {};
  std::string bytes(count, '\0');
  bytes.resize(descriptor.Read(bytes.data(), count));
  return bytes;
}

}  // namespace oca::models
