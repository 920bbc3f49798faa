// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/mcap_writer.h"

#include <algorithm>
#include <cassert>
#include <ostream>

#include "oca/diagrams/record/mcap_bytes.h"

namespace oca::record {

McapWriter::McapWriter(std::ostream& stream, Compression compression, std::size_t chunk_size,
                       int level)
    : stream_(stream), compression_(compression), chunk_size_(chunk_size), level_(level) {
  std::string content;
  AppendText(content, "");  // profile
  AppendText(content, "oca");
  std::string header(kMcapMagic);
  AppendRecord(header, Opcode::kHeader, content);
  Emit(header);
}

McapWriter::~McapWriter() { Close(); }

void McapWriter::Emit(std::string_view bytes) {
  stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  position_ += bytes.size();
  crc_ = Crc32(crc_, bytes);
}

std::uint16_t McapWriter::AddSchema(const std::string& name, const std::string& encoding,
                                    const std::string& data) {
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  schemas_.push_back({id, name, encoding, data});
  schema_declared_.push_back(false);
  return id;
}

std::uint16_t McapWriter::AddChannel(const std::string& topic, const std::string& encoding,
                                     std::uint16_t schema, const Texts& metadata) {
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  Channel channel;
  channel.info = {id, schema, topic, encoding, metadata};
  channels_.push_back(std::move(channel));
  return id;
}

void McapWriter::Declare(Channel& channel) {
  const std::uint16_t schema = channel.info.schema;
  if (schema != 0 && !schema_declared_[schema - 1]) {
    AppendSchema(chunk_, schemas_[schema - 1]);
    schema_declared_[schema - 1] = true;
  }
  AppendChannel(chunk_, channel.info);
  channel.declared = true;
}

void McapWriter::Write(std::uint16_t id, std::uint64_t log_time, std::string_view data) {
  assert(id >= 1 && id <= channels_.size() && !closed_);
  Channel& channel = channels_[id - 1];
  if (!channel.declared) Declare(channel);
  channel.index.emplace_back(log_time, chunk_.size());
  AppendNumber(chunk_, Opcode::kMessage);
  AppendNumber(chunk_, std::uint64_t{22} + data.size());
  AppendNumber(chunk_, id);
  AppendNumber(chunk_, channel.sequence++);
  AppendNumber(chunk_, log_time);
  AppendNumber(chunk_, log_time);
  chunk_ += data;
  ++channel.count;
  chunk_first_ = chunk_messages_ == 0 ? log_time : std::min(chunk_first_, log_time);
  chunk_last_ = chunk_messages_ == 0 ? log_time : std::max(chunk_last_, log_time);
  first_time_ = messages_ == 0 ? log_time : std::min(first_time_, log_time);
  last_time_ = messages_ == 0 ? log_time : std::max(last_time_, log_time);
  ++chunk_messages_;
  ++messages_;
  if (chunk_.size() >= chunk_size_) WriteChunk();
}

void McapWriter::WriteChunk() {
  if (chunk_messages_ == 0) return;
  packed_.clear();
  Compress(compression_, level_, chunk_, packed_);
  std::string& content = record_;
  content.clear();
  AppendNumber(content, chunk_first_);
  AppendNumber(content, chunk_last_);
  AppendNumber(content, static_cast<std::uint64_t>(chunk_.size()));
  AppendNumber(content, Crc32(0, chunk_));
  AppendText(content, CompressionName(compression_));
  AppendNumber(content, static_cast<std::uint64_t>(packed_.size()));
  content += packed_;
  const std::uint64_t start = position_;
  std::string head;
  AppendNumber(head, Opcode::kChunk);
  AppendNumber(head, static_cast<std::uint64_t>(content.size()));
  Emit(head);
  Emit(content);
  WriteIndexes(start, position_ - start, packed_.size());
  ++chunks_;
  chunk_.clear();
  chunk_messages_ = 0;
}

void McapWriter::WriteIndexes(std::uint64_t chunk_start, std::uint64_t chunk_length,
                              std::uint64_t packed_size) {
  const std::uint64_t start = position_;
  std::string offsets;
  for (Channel& channel : channels_) {
    if (channel.index.empty()) continue;
    AppendNumber(offsets, channel.info.id);
    AppendNumber(offsets, position_);
    std::string content;
    AppendNumber(content, channel.info.id);
    AppendNumber(content, static_cast<std::uint32_t>(16 * channel.index.size()));
    for (const auto& [time, offset] : channel.index) {
      AppendNumber(content, time);
      AppendNumber(content, offset);
    }
    std::string bytes;
    AppendRecord(bytes, Opcode::kMessageIndex, content);
    Emit(bytes);
    channel.index.clear();
  }
  std::string content;
  AppendNumber(content, chunk_first_);
  AppendNumber(content, chunk_last_);
  AppendNumber(content, chunk_start);
  AppendNumber(content, chunk_length);
  AppendText(content, offsets);
  AppendNumber(content, position_ - start);
  AppendText(content, CompressionName(compression_));
  AppendNumber(content, packed_size);
  AppendNumber(content, static_cast<std::uint64_t>(chunk_.size()));
  AppendRecord(chunk_indexes_, Opcode::kChunkIndex, content);
}

void McapWriter::AddAttachment(const Attachment& attachment) {
  std::string content;
  AppendNumber(content, attachment.log_time);
  AppendNumber(content, attachment.log_time);
  AppendText(content, attachment.name);
  AppendText(content, attachment.media_type);
  AppendNumber(content, static_cast<std::uint64_t>(attachment.data.size()));
  content += attachment.data;
  AppendNumber(content, Crc32(0, content));
  const std::uint64_t start = position_;
  std::string bytes;
  AppendRecord(bytes, Opcode::kAttachment, content);
  Emit(bytes);
  ++attachments_;

  content.clear();
  AppendNumber(content, start);
  AppendNumber(content, position_ - start);
  AppendNumber(content, attachment.log_time);
  AppendNumber(content, attachment.log_time);
  AppendNumber(content, static_cast<std::uint64_t>(attachment.data.size()));
  AppendText(content, attachment.name);
  AppendText(content, attachment.media_type);
  AppendRecord(attachment_indexes_, Opcode::kAttachmentIndex, content);
}

void McapWriter::AddMetadata(const Metadata& metadata) {
  std::string content;
  AppendText(content, metadata.name);
  AppendTexts(content, metadata.values);
  const std::uint64_t start = position_;
  std::string bytes;
  AppendRecord(bytes, Opcode::kMetadata, content);
  Emit(bytes);
  ++metadata_;

  content.clear();
  AppendNumber(content, start);
  AppendNumber(content, position_ - start);
  AppendText(content, metadata.name);
  AppendRecord(metadata_indexes_, Opcode::kMetadataIndex, content);
}

void McapWriter::Flush() {
  WriteChunk();
  stream_.flush();
}

std::string McapWriter::Statistics() const {
  std::string counts;
  for (const Channel& channel : channels_) {
    AppendNumber(counts, channel.info.id);
    AppendNumber(counts, channel.count);
  }
  std::string content;
  AppendNumber(content, messages_);
  AppendNumber(content, static_cast<std::uint16_t>(schemas_.size()));
  AppendNumber(content, static_cast<std::uint32_t>(channels_.size()));
  AppendNumber(content, attachments_);
  AppendNumber(content, metadata_);
  AppendNumber(content, chunks_);
  AppendNumber(content, first_time_);
  AppendNumber(content, last_time_);
  AppendText(content, counts);
  return content;
}

void McapWriter::Close() {
  if (closed_) return;
  WriteChunk();
  closed_ = true;
  std::string content;
  AppendNumber(content, crc_);
  std::string bytes;
  AppendRecord(bytes, Opcode::kDataEnd, content);
  Emit(bytes);
  WriteSummary();
  stream_.flush();
}

void McapWriter::WriteSummary() {
  const std::uint64_t start = position_;
  std::string summary, offsets;
  const auto group = [&](Opcode opcode, const std::string& records) {
    if (records.empty()) return;
    std::string content;
    AppendNumber(content, opcode);
    AppendNumber(content, start + summary.size());
    AppendNumber(content, static_cast<std::uint64_t>(records.size()));
    AppendRecord(offsets, Opcode::kSummaryOffset, content);
    summary += records;
  };
  std::string schemas, channels, statistics;
  for (const McapSchema& schema : schemas_) AppendSchema(schemas, schema);
  for (const Channel& channel : channels_) AppendChannel(channels, channel.info);
  AppendRecord(statistics, Opcode::kStatistics, Statistics());
  group(Opcode::kSchema, schemas);
  group(Opcode::kChannel, channels);
  group(Opcode::kStatistics, statistics);
  group(Opcode::kChunkIndex, chunk_indexes_);
  group(Opcode::kAttachmentIndex, attachment_indexes_);
  group(Opcode::kMetadataIndex, metadata_indexes_);
  const std::uint64_t offsets_start = start + summary.size();
  summary += offsets;

  // The CRC of the summary goes on up to its own place in the footer.
  AppendNumber(summary, Opcode::kFooter);
  AppendNumber(summary, std::uint64_t{20});
  AppendNumber(summary, start);
  AppendNumber(summary, offsets_start);
  AppendNumber(summary, Crc32(0, summary));
  summary += kMcapMagic;
  Emit(summary);
}

}  // namespace oca::record
