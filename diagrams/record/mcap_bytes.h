// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "oca/diagrams/record/mcap.h"

namespace oca::record {

// The bytes of an MCAP file: little-endian numbers, strings and maps with their lengths before
// them, and records: opcode, length, content.

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

enum class Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kAttachment = 0x09,
  kAttachmentIndex = 0x0A,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// CRC-32 of ISO 3309 (that of zlib), continued from `crc`; 0 begins.
std::uint32_t Crc32(std::uint32_t crc, std::string_view bytes);

/// The bytes as one lz4 or zstd frame, appended to `out`.
void Compress(Compression compression, int level, std::string_view bytes, std::string& out);
/// throws ConfigError if `name` is unknown or the bytes are no such frame of `size` bytes.
std::string Decompress(std::string_view name, std::string_view bytes, std::size_t size);
/// As MCAP calls it: "", "lz4" or "zstd".
std::string_view CompressionName(Compression compression);

template <class T>
void AppendNumber(std::string& out, T number) {
  out.append(reinterpret_cast<const char*>(&number), sizeof number);
}
void AppendText(std::string& out, std::string_view text);
void AppendTexts(std::string& out, const Texts& texts);
void AppendRecord(std::string& out, Opcode opcode, std::string_view content);
void AppendSchema(std::string& out, const McapSchema& schema);
void AppendChannel(std::string& out, const McapChannel& channel);

/// Reads what the functions above append, and refuses to read past the end.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::size_t position() const { return position_; }
  std::size_t left() const { return bytes_.size() - position_; }
  /// The next `size` bytes. throws ConfigError if there are fewer.
  std::string_view Take(std::uint64_t size);
  template <class T>
  T Number() {
    T number;
    std::memcpy(&number, Take(sizeof number).data(), sizeof number);
    return number;
  }
  std::string_view Text() { return Take(Number<std::uint32_t>()); }
  Texts TextMap();

 private:
  std::string_view bytes_;
  std::size_t position_{0};
};

}  // namespace oca::record
