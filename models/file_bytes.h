// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

namespace oca::models {

inline constexpr std::uintmax_t kMostFileBytes = 100'000'000;  ///< of a file that is read

/// The one door by which bytes of files come in. A file is opened once, without waiting for whoever
/// writes to a pipe; only a regular file of at most `most` bytes is read, and what it holds then:
/// it may grow meanwhile. OpenedFiles notes it first.
/// throws ModelError `file: cannot be read; got no such file; expected a file`,
///        `file: not a regular file; got a folder, pipe or device; ...`, `file: too large; ...`
std::string ReadFile(const std::filesystem::path& file, std::uintmax_t most = kMostFileBytes);
/// The same of a file that no run is made from, which nobody notes.
std::string ReadUnnoted(const std::filesystem::path& file, std::uintmax_t most = kMostFileBytes);
/// The first `count` bytes of a regular file, fewer if there are no more; none of what cannot be
/// read.
std::string BeginningOf(const std::filesystem::path& file, std::size_t count);

}  // namespace oca::models
