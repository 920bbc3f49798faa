// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "oca/diagrams/record/mcap.h"

namespace oca::record {

/// An MCAP file in memory: whatever could be read of it, from its beginning up to the first byte
/// that is missing or damaged. Movable only, messages point into it.
class McapFile {
 public:
  /// Reads the data section from front to back; the summary at the end, which a file that was cut
  /// lacks, is not needed. Every CRC is checked.
  /// throws ConfigError naming `name` if it does not begin as an MCAP file.
  static McapFile Parse(std::string bytes, const std::string& name);
  /// throws ConfigError also if the file cannot be read.
  static McapFile Read(const std::filesystem::path& file);

  McapFile(McapFile&&) = default;
  McapFile& operator=(McapFile&&) = default;

  /// Whether it ended as it should: DataEnd, summary, footer.
  bool complete() const { return problem_.empty(); }
  /// Of the file, for messages.
  const std::string& name() const { return name_; }
  /// What ended the reading, and at which byte; empty if the file is complete.
  const std::string& problem() const { return problem_; }
  const std::string& library() const { return library_; }

  const std::vector<McapSchema>& schemas() const { return schemas_; }
  const std::vector<McapChannel>& channels() const { return channels_; }
  /// In the order of the file.
  const std::vector<McapMessage>& messages() const { return messages_; }
  const std::vector<Attachment>& attachments() const { return attachments_; }
  const std::vector<Metadata>& metadata() const { return metadata_; }

  /// nullptr if there is none.
  const McapChannel* FindChannel(std::string_view topic) const;
  const McapSchema* FindSchema(std::uint16_t id) const;
  const Attachment* FindAttachment(std::string_view name) const;
  /// The last of that name, as it counts; nullptr if there is none.
  const Texts* FindMetadata(std::string_view name) const;
  std::vector<const McapMessage*> MessagesOf(std::string_view topic) const;

 private:
  McapFile() = default;
  friend class McapParser;

  std::string name_;
  std::string problem_;
  std::string library_;
  std::vector<McapSchema> schemas_;
  std::vector<McapChannel> channels_;
  std::vector<McapMessage> messages_;
  std::map<std::uint16_t, std::vector<std::size_t>> by_channel_;  ///< places in messages_
  std::vector<Attachment> attachments_;
  std::vector<Metadata> metadata_;
  std::deque<std::string> memory_;  ///< what messages point into; a deque never moves its items
};

}  // namespace oca::record
