// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/mcap_bytes.h"

#include <fmt/format.h>

#include <array>

#include "oca/framework/dataflow/error.h"
#include "oca/models/foreign_text.h"

namespace oca::record {
namespace {

// Eight bytes a step: table k advances a byte by k further zero bytes.
using CrcTables = std::array<std::array<std::uint32_t, 256>, 8>;

constexpr CrcTables MakeCrcTables() {
  CrcTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320u : 0u);
    tables[0][byte] = crc;
  }
  for (std::size_t k = 1; k < tables.size(); ++k) {
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = tables[k - 1][byte];
      tables[k][byte] = (before >> 8) ^ tables[0][before & 0xff];
    }
  }
  return tables;
}

constexpr CrcTables kCrcTables = MakeCrcTables();

}  // namespace

std::uint32_t Crc32(std::uint32_t crc, std::string_view bytes) {
  crc = ~crc;
  const char* at = bytes.data();
  const char* const end = at + bytes.size();
  for (; end - at >= 8; at += 8) {
    std::uint64_t word;
    std::memcpy(&word, at, sizeof word);
    word ^= crc;
    crc = 0;
#pragma GCC unroll 8
    for (int k = 0; k < 8; ++k) crc ^= kCrcTables[7 - k][(word >> (8 * k)) & 0xff];
  }
  for (; at != end; ++at) {
    crc = (crc >> 8) ^ kCrcTables[0][(crc ^ static_cast<std::uint8_t>(*at)) & 0xff];
  }
  return ~crc;
}

void AppendText(std::string& out, std::string_view text) {
  AppendNumber(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}

void AppendTexts(std::string& out, const Texts& texts) {
  std::string entries;
  for (const auto& [key, value] : texts) {
    AppendText(entries, models::internal::AsUtf8(key));
    AppendText(entries, models::internal::AsUtf8(value));
  }
  AppendText(out, entries);
}

void AppendRecord(std::string& out, Opcode opcode, std::string_view content) {
  AppendNumber(out, opcode);
  AppendNumber(out, static_cast<std::uint64_t>(content.size()));
  out += content;
}

void AppendSchema(std::string& out, const McapSchema& schema) {
  std::string content;
  AppendNumber(content, schema.id);
  AppendText(content, schema.name);
  AppendText(content, schema.encoding);
  AppendText(content, schema.data);
  AppendRecord(out, Opcode::kSchema, content);
}

void AppendChannel(std::string& out, const McapChannel& channel) {
  std::string content;
  AppendNumber(content, channel.id);
  AppendNumber(content, channel.schema);
  AppendText(content, channel.topic);
  AppendText(content, channel.encoding);
  AppendTexts(content, channel.metadata);
  AppendRecord(out, Opcode::kChannel, content);
}

std::string_view ByteReader::Take(std::uint64_t size) {
  if (size > left()) {
    throw ConfigError(fmt::format("got {} bytes; expected {}", left(), size));
  }
  const std::string_view taken = bytes_.substr(position_, size);
  position_ += size;
  return taken;
}

Texts ByteReader::TextMap() {
  ByteReader entries(Text());
  Texts texts;
  while (entries.left() > 0) {
    const std::string key(entries.Text());
    texts[key] = std::string(entries.Text());
  }
  return texts;
}

}  // namespace oca::record
