// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "oca/diagrams/record/mcap.h"

namespace oca::record {

/// Writes an MCAP file as a stream: messages gather in a chunk, which is compressed, checksummed
/// and written with its indexes when it is large enough or Flush says so. What was flushed can be
/// read even if nothing follows. Close adds the summary: schemas, channels, statistics, indexes.
///
/// Schemas and channels stand in the chunk before the first message that needs them. All CRCs are
/// written. source https://mcap.dev/spec, version 0
class McapWriter {
 public:
  /// Writes the header. The stream must outlive the writer.
  /// `level` of zstd: 1 fast to 19 small.
  McapWriter(std::ostream& stream, Compression compression,
             std::size_t chunk_size = kDefaultChunkSize, int level = 1);
  /// Closes.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  std::uint16_t AddSchema(const std::string& name, const std::string& encoding,
                          const std::string& data);
  std::uint16_t AddChannel(const std::string& topic, const std::string& encoding,
                           std::uint16_t schema, const Texts& metadata = {});
  /// `log_time` ns since the epoch. The channel must have been added.
  void Write(std::uint16_t channel, std::uint64_t log_time, std::string_view data);
  void AddAttachment(const Attachment& attachment);
  void AddMetadata(const Metadata& metadata);
  /// Writes the chunk so far and flushes the stream.
  void Flush();
  void Close();

  /// Small enough that a run does not wait for the last one.
  static constexpr std::size_t kDefaultChunkSize = std::size_t{256} << 10;

 private:
  struct Channel {
    McapChannel info;
    std::uint32_t sequence{0};
    std::uint64_t count{0};
    bool declared{false};                                        ///< in a chunk
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  ///< time, offset; of this chunk
  };

  void Emit(std::string_view bytes);
  void Declare(Channel& channel);
  void WriteChunk();
  void WriteIndexes(std::uint64_t chunk_start, std::uint64_t chunk_length,
                    std::uint64_t packed_size);
  void WriteSummary();
  std::string Statistics() const;

  std::ostream& stream_;
  const Compression compression_;
  const std::size_t chunk_size_;
  const int level_;
  std::uint64_t position_{0};
  std::uint32_t crc_{0};  ///< of all that was written
  std::vector<McapSchema> schemas_;
  std::vector<bool> schema_declared_;
  std::vector<Channel> channels_;
  std::string chunk_, packed_, record_;
  std::uint64_t chunk_first_{0}, chunk_last_{0}, chunk_messages_{0};
  std::uint64_t first_time_{0}, last_time_{0}, messages_{0};
  std::uint32_t chunks_{0}, attachments_{0}, metadata_{0};
  std::string chunk_indexes_, attachment_indexes_, metadata_indexes_;
  bool closed_{false};
};

}  // namespace oca::record
