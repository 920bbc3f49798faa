// SPDX-License-Identifier: BSD-3-Clause
// What fuzzing starts from and what it once found, read by every build: corpus/READER/*.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/fuzz/readers.h"

namespace oca::test {
namespace {

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

INSTANTIATE_TEST_SUITE_P(All, FuzzReplayTest, testing::ValuesIn(Readers().begin(), Readers().end()),
                         NameOf);

}  // namespace
}  // namespace oca::test
