// SPDX-License-Identifier: BSD-3-Clause
// What fuzzing starts from and what it once found, read by every build: corpus/READER/*; and as it
// is after some random changes, the same in every run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "oca/models/random.h"
#include "tests/fuzz/readers.h"

namespace oca::test {
namespace {

/// How many changed inputs each reader gets: OCA_FUZZ_INPUTS, or 1000.
int ChangedInputs() {
  const char* const text = std::getenv("OCA_FUZZ_INPUTS");
  return text == nullptr ? 1000 : std::atoi(text);
}

/// Up to eight changes: of a byte or a bit, a number or a text that readers trip over put in, a
/// piece left out, doubled, or taken from another input.
std::string Changed(const std::string& bytes, const std::string& other, models::Random& random) {
  static constexpr std::string_view kPieces[]{"-1",
                                              "0",
                                              "1e999",
                                              "nan",
                                              "4294967296",
                                              "18446744073709551616",
                                              "[",
                                              "{",
                                              "<a>",
                                              "\"",
                                              "\xff\xff\xff\xff",
                                              std::string_view("\0\0\0\x80", 4),
                                              "\n",
                                              "\xc3",
                                              "${x}",
                                              "../",
                                              "&",
                                              "1e-320"};
  const auto place = [&](const std::string& text) {
    return static_cast<std::size_t>(random.Below(text.size() + 1));
  };
  std::string text = bytes;
  for (std::uint64_t changes = 1 + random.Below(8); changes > 0; --changes) {
    const std::size_t at = place(text), length = 1 + random.Below(16);
    switch (random.Below(6)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(random.Below(256));
        break;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << random.Below(8)));
        break;
      case 2:
        text.insert(at, kPieces[random.Below(std::size(kPieces))]);
        break;
      case 3:
        text.erase(at, length);
        break;
      case 4:
        text.insert(place(text), text.substr(at, length));
        break;
      default:
        text.insert(at, other.substr(place(other), length));
    }
  }
  return text;
}

std::string BytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string NameOf(const testing::TestParamInfo<Reader>& info) { return info.param.name; }

class FuzzReplayTest : public testing::TestWithParam<Reader> {};

TEST_P(FuzzReplayTest, RefusesOrReadsEveryInputOfItsCorpusAndEveryBeginningOfOne) {
  const std::filesystem::path folder =
      std::filesystem::path(OCA_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name;
  ASSERT_TRUE(std::filesystem::is_directory(folder)) << folder;
  int accepted = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    SCOPED_TRACE(entry.path().string());
    const std::string bytes = BytesOf(entry.path());
    ASSERT_NO_THROW(accepted += GetParam().read(bytes) ? 1 : 0);
    for (std::size_t part = 0; part < 16; ++part) {
      ASSERT_NO_THROW(GetParam().read(bytes.substr(0, bytes.size() * part / 16))) << part;
    }
  }
  EXPECT_GT(accepted, 0);
}

TEST_P(FuzzReplayTest, RefusesOrReadsWhatIsLeftOfThemAfterRandomChanges) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(OCA_SOURCE_DIR) / "tests/fuzz/corpus" / GetParam().name)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> inputs;
  for (const auto& file : files) inputs.push_back(BytesOf(file));
  models::Random random(models::Random::Seed(1, GetParam().name));
  for (int i = 0; i < ChangedInputs(); ++i) {
    const auto& one = inputs[random.Below(inputs.size())];
    const std::string bytes = Changed(one, inputs[random.Below(inputs.size())], random);
    ASSERT_NO_THROW(GetParam().read(bytes)) << "input " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(All, FuzzReplayTest, testing::ValuesIn(Readers().begin(), Readers().end()),
                         NameOf);

}  // namespace
}  // namespace oca::test
