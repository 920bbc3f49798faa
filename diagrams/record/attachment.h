// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace oca::record {

// What a record holds beside the samples of its channels, whatever its format.

using Texts = std::map<std::string, std::string>;

/// A file that belongs to it.
struct Attachment {
  std::uint64_t log_time{0};  ///< ns since the epoch
  std::string name{};
  std::string media_type{};
  std::string data{};
};

/// Texts by key, together under a name.
struct Metadata {
  std::string name{};
  Texts values{};
};

}  // namespace oca::record
