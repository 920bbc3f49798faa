// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "oca/diagrams/record/attachment.h"

namespace oca::record {

// What an MCAP file consists of. source https://mcap.dev/spec

enum class Compression { kNone, kLz4, kZstd };

/// throws ConfigError unless `name` is none, lz4 or zstd.
Compression ParseCompression(const std::string& name);

/// How the messages of a channel are laid out; JSON Schema here.
struct McapSchema {
  std::uint16_t id{0};  ///< from 1
  std::string name{};
  std::string encoding{};
  std::string data{};
};

/// A stream of messages under one topic. `schema` 0: none.
struct McapChannel {
  std::uint16_t id{0};
  std::uint16_t schema{0};
  std::string topic{};
  std::string encoding{};
  Texts metadata{};
};

/// One message; `data` lies in what it was read from. Times are ns since the epoch.
struct McapMessage {
  std::uint16_t channel{0};
  std::uint32_t sequence{0};
  std::uint64_t log_time{0};
  std::uint64_t publish_time{0};
  std::string_view data{};
};

}  // namespace oca::record
