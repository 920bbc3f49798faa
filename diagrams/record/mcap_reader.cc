// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/mcap_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "oca/diagrams/record/mcap_bytes.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/file_bytes.h"
#include "oca/systems/signals/config_errors.h"

namespace oca::record {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t{4} << 30;  // of a file

/// All chunks of a file together unpack to no more: a record of a run takes a tenth of that, but
/// zeros can be packed to less than a ten thousandth.
std::uint64_t MostUnpacked(std::uint64_t bytes) {
  constexpr std::uint64_t kAlways = std::uint64_t{256} << 20, kRatio = 64;
  return kAlways + kRatio * bytes;
}

}  // namespace

class McapParser {
 public:
  McapParser(McapFile& file, std::string_view bytes)
      : file_(file), bytes_(bytes), left_(MostUnpacked(bytes.size())) {}

  void Parse() {
    ByteReader reader(bytes_);
    reader.Take(kMcapMagic.size());
    while (true) {
      const std::size_t start = reader.position();
      try {
        const auto opcode = reader.Number<Opcode>();
        const auto length = reader.Number<std::uint64_t>();
        const std::string_view content = reader.Take(length);
        Handle(opcode, content);
        if (opcode == Opcode::kDataEnd) {
          CheckDataEnd(content, start);
          CheckSummary(reader.position());
          return;
        }
      } catch (const ConfigError& error) {
        file_.problem_ = fmt::format("breaks off at byte {}: {}", start, error.what());
        return;
      }
    }
  }

 private:
  void Handle(Opcode opcode, std::string_view content) {
    ByteReader reader(content);
    switch (opcode) {
      case Opcode::kHeader:
        reader.Text();
        file_.library_ = reader.Text();
        break;
      case Opcode::kSchema:
        return AddSchema(reader);
      case Opcode::kChannel:
        return AddChannel(reader);
      case Opcode::kMessage:
        return AddMessage(reader);
      case Opcode::kChunk:
        return AddChunk(reader);
      case Opcode::kAttachment:
        return AddAttachment(reader, content);
      case Opcode::kMetadata: {
        Metadata metadata;
        metadata.name = reader.Text();
        metadata.values = reader.TextMap();
        file_.metadata_.push_back(std::move(metadata));
        break;
      }
      default:
        break;  // indexes; and records of a later version, which readers skip
    }
  }

  /// Each is looked up among the others.
  static void CheckNumber(const char* what, std::size_t before) {
    constexpr std::size_t kMost = 10'000;
    if (before < kMost) return;
    throw ConfigError(fmt::format("{}: got more than {}; expected fewer", what, kMost));
  }

  void AddSchema(ByteReader& reader) {
    McapSchema schema;
    schema.id = reader.Number<std::uint16_t>();
    schema.name = reader.Text();
    schema.encoding = reader.Text();
    schema.data = reader.Text();
    if (file_.FindSchema(schema.id) != nullptr) return;
    CheckNumber("schemas", file_.schemas_.size());
    file_.schemas_.push_back(std::move(schema));
  }

  void AddChannel(ByteReader& reader) {
    McapChannel channel;
    channel.id = reader.Number<std::uint16_t>();
    channel.schema = reader.Number<std::uint16_t>();
    channel.topic = reader.Text();
    channel.encoding = reader.Text();
    channel.metadata = reader.TextMap();
    if (known_[channel.id]) return;
    CheckNumber("channels", file_.channels_.size());
    known_[channel.id] = true;
    file_.channels_.push_back(std::move(channel));
  }

  void AddMessage(ByteReader& reader) {
    McapMessage message;
    message.channel = reader.Number<std::uint16_t>();
    message.sequence = reader.Number<std::uint32_t>();
    message.log_time = reader.Number<std::uint64_t>();
    message.publish_time = reader.Number<std::uint64_t>();
    message.data = reader.Take(reader.left());
    if (!known_[message.channel]) {
      throw ConfigError(
          fmt::format("message: got channel {}; expected a known one", message.channel));
    }
    file_.messages_.push_back(message);
  }

  /// All of a chunk or nothing.
  void AddChunk(ByteReader& reader) {
    reader.Take(16);  // first and last time
    const auto size = reader.Number<std::uint64_t>();
    const auto crc = reader.Number<std::uint32_t>();
    const std::string_view compression = reader.Text();
    const std::string_view packed = reader.Take(reader.Number<std::uint64_t>());
    if (size > left_) {
      throw ConfigError(fmt::format(
          "chunk: got {} bytes after those before it; expected at most {}", size, left_));
    }
    left_ -= size;
    std::string records = Decompress(compression, packed, size);
    if (crc != 0 && crc != Crc32(0, records)) throw ConfigError("chunk: wrong CRC");
    file_.memory_.push_back(std::move(records));
    const std::size_t messages = file_.messages_.size();
    try {
      ByteReader inner(file_.memory_.back());
      while (inner.left() > 0) {
        const auto opcode = inner.Number<Opcode>();
        const std::string_view content = inner.Take(inner.Number<std::uint64_t>());
        if (opcode == Opcode::kChunk) throw ConfigError("chunk: lies in a chunk");
        Handle(opcode, content);
      }
    } catch (const ConfigError&) {
      file_.messages_.resize(messages);
      throw;
    }
  }

  void AddAttachment(ByteReader& reader, std::string_view content) {
    Attachment attachment;
    attachment.log_time = reader.Number<std::uint64_t>();
    reader.Number<std::uint64_t>();  // time of creation
    attachment.name = reader.Text();
    attachment.media_type = reader.Text();
    attachment.data = reader.Take(reader.Number<std::uint64_t>());
    const std::size_t covered = reader.position();
    const auto crc = reader.Number<std::uint32_t>();
    if (crc != 0 && crc != Crc32(0, content.substr(0, covered))) {
      throw ConfigError("attachment: wrong CRC");
    }
    file_.attachments_.push_back(std::move(attachment));
  }

  void CheckDataEnd(std::string_view content, std::size_t start) {
    const auto crc = ByteReader(content).Number<std::uint32_t>();
    if (crc != 0 && crc != Crc32(0, bytes_.substr(0, start))) {
      throw ConfigError("data: wrong CRC");
    }
  }

  void CheckSummary(std::size_t start) {
    constexpr std::size_t kFooterSize = 1 + 8 + 20;
    const std::size_t end = kFooterSize + kMcapMagic.size();
    if (bytes_.size() < start + end || !bytes_.ends_with(kMcapMagic)) {
      throw ConfigError("summary: cut off");
    }
    const std::size_t crc_at = bytes_.size() - kMcapMagic.size() - 4;
    const auto crc = ByteReader(bytes_.substr(crc_at)).Number<std::uint32_t>();
    if (crc != 0 && crc != Crc32(0, bytes_.substr(start, crc_at - start))) {
      throw ConfigError("summary: wrong CRC");
    }
  }

  McapFile& file_;
  std::string_view bytes_;
  std::uint64_t left_;  ///< that chunks may unpack to
  std::vector<bool> known_ = std::vector<bool>(std::numeric_limits<std::uint16_t>::max() + 1);
};

McapFile McapFile::Parse(std::string bytes, const std::string& name) {
  if (!bytes.starts_with(kMcapMagic)) {
    throw ConfigError(fmt::format("{}: is no MCAP file; expected its magic bytes", name));
  }
  McapFile file;
  file.name_ = name;
  file.memory_.push_back(std::move(bytes));
  McapParser(file, file.memory_.front()).Parse();
  for (std::size_t i = 0; i < file.messages_.size(); ++i) {
    file.by_channel_[file.messages_[i].channel].push_back(i);
  }
  return file;
}

McapFile McapFile::Read(const std::filesystem::path& path) {
  return Parse(systems::WithConfigErrors([&] { return models::ReadUnnoted(path, kMostBytes); }),
               path.string());
}

const McapChannel* McapFile::FindChannel(std::string_view topic) const {
  const auto found = std::find_if(channels_.begin(), channels_.end(),
                                  [topic](const auto& channel) { return channel.topic == topic; });
  return found == channels_.end() ? nullptr : &*found;
}

const McapSchema* McapFile::FindSchema(std::uint16_t id) const {
  const auto found = std::find_if(schemas_.begin(), schemas_.end(),
                                  [id](const auto& schema) { return schema.id == id; });
  return found == schemas_.end() ? nullptr : &*found;
}

const Attachment* McapFile::FindAttachment(std::string_view name) const {
  const auto found = std::find_if(attachments_.begin(), attachments_.end(),
                                  [name](const auto& item) { return item.name == name; });
  return found == attachments_.end() ? nullptr : &*found;
}

const Texts* McapFile::FindMetadata(std::string_view name) const {
  const auto found = std::find_if(metadata_.rbegin(), metadata_.rend(),
                                  [name](const auto& item) { return item.name == name; });
  return found == metadata_.rend() ? nullptr : &found->values;
}

std::vector<const McapMessage*> McapFile::MessagesOf(std::string_view topic) const {
  std::vector<const McapMessage*> found;
  const McapChannel* const channel = FindChannel(topic);
  if (channel == nullptr) return found;
  const auto own = by_channel_.find(channel->id);
  if (own == by_channel_.end()) return found;
  for (const std::size_t i : own->second) found.push_back(&messages_[i]);
  return found;
}

}  // namespace oca::record
