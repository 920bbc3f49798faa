// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "oca/diagrams/record/mcap_bytes.h"
#include "oca/diagrams/record/mcap_reader.h"
#include "oca/diagrams/record/mcap_writer.h"
#include "oca/framework/dataflow/error.h"

namespace oca::record {
namespace mcap_test {

using testing::HasSubstr;
using testing::Not;

constexpr std::uint64_t kEpoch = 1'700'000'000'000'000'000;

/// Two channels, ten messages each; a flush, and so a chunk, after every fourth pair.
std::string SmallFile(Compression compression) {
  std::ostringstream stream;
  McapWriter writer(stream, compression);
  writer.AddAttachment({kEpoch, "diagram.yaml", "application/yaml", "systems: {}\n"});
  writer.AddMetadata({"oca", {{"outcome", "running"}}});
  const auto schema = writer.AddSchema("numbers", "jsonschema", R"({"type":"object"})");
  const auto one = writer.AddChannel("/one", "json", schema, {{"unit", "rad"}});
  const auto two = writer.AddChannel("/two", "json", 0);
  for (int i = 0; i < 10; ++i) {
    const std::uint64_t time = kEpoch + 1000 * static_cast<std::uint64_t>(i);
    writer.Write(one, time, "{\"value\":" + std::to_string(i) + "}");
    writer.Write(two, time, "{\"square\":" + std::to_string(i * i) + "}");
    if (i % 4 == 3) writer.Flush();
  }
  writer.AddMetadata({"oca", {{"outcome", "done"}}});
  writer.Close();
  return stream.str();
}

class EachCompression : public testing::TestWithParam<Compression> {};
INSTANTIATE_TEST_SUITE_P(McapTest, EachCompression,
                         testing::Values(Compression::kNone, Compression::kLz4, Compression::kZstd),
                         [](const auto& tested) {
                           const auto name = CompressionName(tested.param);
                           return name.empty() ? std::string("none") : std::string(name);
                         });

TEST_P(EachCompression, ReadsBackWhatItWrote) {
  const McapFile file = McapFile::Parse(SmallFile(GetParam()), "small");
  EXPECT_TRUE(file.complete()) << file.problem();
  EXPECT_EQ(file.library(), "oca");
  ASSERT_EQ(file.channels().size(), 2u);
  EXPECT_EQ(file.channels()[0].topic, "/one");
  EXPECT_EQ(file.channels()[0].metadata.at("unit"), "rad");
  ASSERT_NE(file.FindSchema(file.channels()[0].schema), nullptr);
  EXPECT_EQ(file.FindSchema(file.channels()[0].schema)->data, R"({"type":"object"})");
  ASSERT_EQ(file.messages().size(), 20u);
  EXPECT_EQ(file.messages()[15].data, R"({"square":49})");
  EXPECT_EQ(file.messages()[15].log_time, kEpoch + 7000);
  EXPECT_EQ(file.messages()[15].sequence, 7u);
  ASSERT_NE(file.FindAttachment("diagram.yaml"), nullptr);
  EXPECT_EQ(file.FindAttachment("diagram.yaml")->data, "systems: {}\n");
  EXPECT_EQ(file.FindMetadata("oca")->at("outcome"), "done");
  EXPECT_EQ(file.MessagesOf("/two").size(), 10u);
}

/// What a cut leaves must be a beginning of what was there, and a whole number of chunks.
TEST_P(EachCompression, IsReadableUpToTheLastChunkWhereverItIsCut) {
  const std::string bytes = SmallFile(GetParam());
  const McapFile whole = McapFile::Parse(bytes, "whole");
  std::size_t most = 0;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::string cut = bytes.substr(0, size);
    if (size < kMcapMagic.size()) {
      EXPECT_THROW(McapFile::Parse(cut, "cut"), ConfigError);
      continue;
    }
    const McapFile file = McapFile::Parse(cut, "cut");
    EXPECT_FALSE(file.complete()) << size;
    EXPECT_THAT(file.problem(), HasSubstr("breaks off at byte"));
    const std::size_t count = file.messages().size();
    ASSERT_TRUE(count == 0 || count == 8 || count == 16 || count == 20) << size;
    EXPECT_GE(count, most) << "a longer file tells less, at " << size;
    most = count;
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(file.messages()[i].data, whole.messages()[i].data);
    }
  }
  EXPECT_EQ(most, 20u);
}

/// Every byte that is not in a summary is under a CRC.
TEST_P(EachCompression, NoticesADamagedByteWhereverItIs) {
  const std::string bytes = SmallFile(GetParam());
  for (std::size_t at = kMcapMagic.size(); at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x20);
    EXPECT_FALSE(McapFile::Parse(damaged, "damaged").complete()) << "byte " << at;
  }
}

TEST(McapTest, ChecksumIsThatOfTheStandard) {
  EXPECT_EQ(Crc32(0, ""), 0u);
  EXPECT_EQ(Crc32(0, "123456789"), 0xCBF43926u);  // the check value of CRC-32/ISO-HDLC
  const std::string text(1000, 'x');
  EXPECT_EQ(Crc32(Crc32(0, text.substr(0, 333)), text.substr(333)), Crc32(0, text));
}

TEST(McapTest, StartsAChunkWhenOneIsLargeEnough) {
  std::ostringstream stream;
  McapWriter writer(stream, Compression::kNone, 1000);
  const auto channel = writer.AddChannel("/a", "json", 0);
  const std::size_t empty = stream.str().size();
  writer.Write(channel, 1, std::string(500, ' '));
  EXPECT_EQ(stream.str().size(), empty);
  writer.Write(channel, 2, std::string(500, ' '));
  EXPECT_GT(stream.str().size(), empty + 1000);
}

TEST(McapTest, AFileWithoutMessagesIsComplete) {
  std::ostringstream stream;
  McapWriter(stream, Compression::kZstd).Close();
  const McapFile file = McapFile::Parse(stream.str(), "empty");
  EXPECT_TRUE(file.complete()) << file.problem();
  EXPECT_TRUE(file.messages().empty());
}

TEST(McapTest, RefusesWhatIsNoMcapFile) {
  EXPECT_THROW(McapFile::Parse("name: a diagram\n", "x"), ConfigError);
  EXPECT_THROW(McapFile::Read("/nowhere/x.mcap"), ConfigError);
}

TEST(McapTest, RefusesALengthThatNoMemoryHolds) {
  EXPECT_THROW(Decompress("zstd", "abc", std::size_t{1} << 60), ConfigError);
  EXPECT_THROW(Decompress("rar", "abc", 3), ConfigError);
  EXPECT_THROW(Decompress("", "abc", 4), ConfigError);
}

TEST(McapTest, RefusesAnUnknownCompression) {
  EXPECT_EQ(ParseCompression("lz4"), Compression::kLz4);
  EXPECT_THROW(ParseCompression("gzip"), ConfigError);
}

/// A zstd frame of blocks of one zero byte each that is repeated; 131072 zeros take four bytes.
/// source RFC 8878, 3.1.1
std::string FrameOfZeros(std::uint32_t blocks) {
  constexpr std::uint32_t kBlock = 128 * 1024, kRepeats = 1;
  std::string frame("\x28\xB5\x2F\xFD\xE0", 5);
  AppendNumber(frame, std::uint64_t{kBlock} * blocks);
  for (std::uint32_t i = 0; i < blocks; ++i) {
    const std::uint32_t header = (i + 1 == blocks ? 1 : 0) | kRepeats << 1 | kBlock << 3;
    frame += std::string_view(reinterpret_cast<const char*>(&header), 3);
    frame += '\0';
  }
  return frame;
}

TEST(McapTest, UnpacksNoMoreThanAMultipleOfItsSize) {
  constexpr std::uint32_t kBlocks = 639;  // 80 MiB a chunk, of whole records, 9 bytes each
  const std::string frame = FrameOfZeros(kBlocks);
  std::string chunk;
  AppendNumber(chunk, std::uint64_t{0});
  AppendNumber(chunk, std::uint64_t{0});
  AppendNumber(chunk, std::uint64_t{kBlocks} * 128 * 1024);
  AppendNumber(chunk, std::uint32_t{0});
  AppendText(chunk, "zstd");
  AppendNumber(chunk, std::uint64_t{frame.size()});
  chunk += frame;
  std::string bytes(kMcapMagic);
  for (int i = 0; i < 3; ++i) AppendRecord(bytes, Opcode::kChunk, chunk);
  EXPECT_THAT(McapFile::Parse(bytes, "zeros").problem(), Not(HasSubstr("chunk")));
  AppendRecord(bytes, Opcode::kChunk, chunk);
  EXPECT_THAT(McapFile::Parse(bytes, "zeros").problem(), HasSubstr("after those before it"));
}

TEST(McapTest, TakesTenThousandChannels) {
  std::string bytes(kMcapMagic);
  for (std::uint16_t id = 0; id <= 10'000; ++id) {
    AppendChannel(bytes, {id, 0, "/a/" + std::to_string(id), "json", {}});
  }
  const McapFile file = McapFile::Parse(bytes, "many");
  EXPECT_EQ(file.channels().size(), 10'000u);
  EXPECT_THAT(file.problem(), HasSubstr("channels: got more than 10000"));
}

TEST(McapTest, HoldsOnlyUtf8) {
  std::string bytes;
  AppendTexts(bytes, {{"caf\xE9", "\x1b\xFF"}});
  ByteReader reader(bytes);
  EXPECT_THAT(reader.TextMap(),
              testing::ElementsAre(testing::Pair("caf\xEF\xBF\xBD", "\x1b\xEF\xBF\xBD")));
}

}  // namespace mcap_test
}  // namespace oca::record
