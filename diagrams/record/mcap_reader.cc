// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/mcap_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "oca/diagrams/record/mcap_bytes.h"
#include "oca/framework/dataflow/error.h"

namespace oca::record {

class McapParser {
 public:
  McapParser(McapFile& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

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
        McapMetadata metadata;
        metadata.name = reader.Text();
        metadata.values = reader.Texts();
        file_.metadata_.push_back(std::move(metadata));
        break;
      }
      default:
        break;  // indexes; and records of a later version, which readers skip
    }
  }

  void AddSchema(ByteReader& reader) {
    McapSchema schema;
    schema.id = reader.Number<std::uint16_t>();
    schema.name = reader.Text();
    schema.encoding = reader.Text();
    schema.data = reader.Text();
    if (file_.FindSchema(schema.id) == nullptr) file_.schemas_.push_back(std::move(schema));
  }

  const McapChannel* ChannelOf(std::uint16_t id) const {
    const auto found = std::find_if(file_.channels_.begin(), file_.channels_.end(),
                                    [id](const auto& channel) { return channel.id == id; });
    return found == file_.channels_.end() ? nullptr : &*found;
  }

  void AddChannel(ByteReader& reader) {
    McapChannel channel;
    channel.id = reader.Number<std::uint16_t>();
    channel.schema = reader.Number<std::uint16_t>();
    channel.topic = reader.Text();
    channel.encoding = reader.Text();
    channel.metadata = reader.Texts();
    if (ChannelOf(channel.id) == nullptr) file_.channels_.push_back(std::move(channel));
  }

  void AddMessage(ByteReader& reader) {
    McapMessage message;
    message.channel = reader.Number<std::uint16_t>();
    message.sequence = reader.Number<std::uint32_t>();
    message.log_time = reader.Number<std::uint64_t>();
    message.publish_time = reader.Number<std::uint64_t>();
    message.data = reader.Take(reader.left());
    if (ChannelOf(message.channel) == nullptr) {
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
    McapAttachment attachment;
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
};

McapFile McapFile::Parse(std::string bytes, const std::string& name) {
  if (!bytes.starts_with(kMcapMagic)) {
    throw ConfigError(fmt::format("{}: is no MCAP file; expected its magic bytes", name));
  }
  McapFile file;
  file.memory_.push_back(std::move(bytes));
  McapParser(file, file.memory_.front()).Parse();
  return file;
}

McapFile McapFile::Read(const std::filesystem::path& path) {
  std::error_code error;
  std::ifstream stream(path, std::ios::binary);
  if (!std::filesystem::is_regular_file(path, error) || !stream) {
    throw ConfigError(fmt::format("{}: cannot be read; expected an MCAP file", path.string()));
  }
  std::string bytes(std::filesystem::file_size(path), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return Parse(std::move(bytes), path.string());
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

const McapAttachment* McapFile::FindAttachment(std::string_view name) const {
  const auto found = std::find_if(attachments_.begin(), attachments_.end(),
                                  [name](const auto& item) { return item.name == name; });
  return found == attachments_.end() ? nullptr : &*found;
}

const McapTexts* McapFile::FindMetadata(std::string_view name) const {
  const auto found = std::find_if(metadata_.rbegin(), metadata_.rend(),
                                  [name](const auto& item) { return item.name == name; });
  return found == metadata_.rend() ? nullptr : &found->values;
}

std::vector<const McapMessage*> McapFile::MessagesOf(std::string_view topic) const {
  std::vector<const McapMessage*> found;
  const McapChannel* const channel = FindChannel(topic);
  if (channel == nullptr) return found;
  for (const McapMessage& message : messages_) {
    if (message.channel == channel->id) found.push_back(&message);
  }
  return found;
}

}  // namespace oca::record
