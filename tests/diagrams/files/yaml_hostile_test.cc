// SPDX-License-Identifier: BSD-3-Clause
// Files that nobody writes on purpose, or somebody does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "oca/framework/dataflow/error.h"
#include "tests/diagrams/files/yaml_text.h"
#include "tests/temporary_folder.h"

namespace oca::files {
namespace yaml_hostile_test {

using testing::HasSubstr;
namespace fs = std::filesystem;

std::string Repeat(const std::string& text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

/// Of the processor, so that what else runs does not count.
double SecondsOf(const std::function<void()>& action) {
  const std::clock_t start = std::clock();
  action();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

std::string Refusal(const fs::path& file) {
  try {
    ReadTextFile(file);
    return "accepted";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

TEST(YamlHostileTest, AFileLargerThanTheMemoryIsRefusedUnread) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.Write("large.yaml", "a: 1\n");
  fs::resize_file(file, 1'000'000'000'000);  // a hole
  EXPECT_THAT(Refusal(file),
              HasSubstr("large.yaml: error: too large; got 1000000000000 bytes; expected at most"));
}

TEST(YamlHostileTest, TheLargestFileIsReadAndAByteMoreIsNot) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.Write("edge.yaml", std::string(kLargestFile, '#'));
  EXPECT_EQ(ReadTextFile(file).size(), kLargestFile);
  fs::resize_file(file, kLargestFile + 1);
  EXPECT_THAT(Refusal(file), HasSubstr("expected at most"));
}

TEST(YamlHostileTest, WhatIsNoTextFileIsRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(Refusal(folder.path()), HasSubstr("not a regular file; got a folder"));
  EXPECT_THAT(Refusal(folder.path() / "missing.yaml"),
              HasSubstr("cannot be read; got no such file"));
  EXPECT_THAT(Refusal("/dev/zero"), HasSubstr("not a regular file"));
  for (const char control : {'\0', '\1', '\x1b', '\x7f', '\b'}) {
    const fs::path file = folder.Write("junk.yaml", std::string("a: ") + control + "\n");
    EXPECT_THAT(Refusal(file), HasSubstr("control characters")) << static_cast<int>(control);
  }
  EXPECT_EQ(Refusal(folder.Write("white.yaml", "a:\t1\r\n")), "accepted");
}

TEST(YamlHostileTest, DepthBombsOfEveryKindAreRefused) {
  std::string indented, dashes, questions;
  for (int i = 0; i < 2000; ++i) {
    indented += std::string(i, ' ') + "a:\n";
    dashes += std::string(i, ' ') + "-\n";
    questions += std::string(i, ' ') + "?\n";
  }
  const int n = 100000;
  for (const std::string& bomb : {Repeat("[", n),    Repeat("{", n),
                                  Repeat("[{", n),   Repeat("{a: ", n),
                                  Repeat("{? ", n),  Repeat("- ", n),
                                  Repeat("? ", n),   Repeat("- ? ", n),
                                  Repeat(": ", n),   Repeat("? - ", n),
                                  Repeat("[\n", n),  Repeat("a: [", n),
                                  Repeat("- [", n),  Repeat("!x [", n),
                                  Repeat("[a, ", n), Repeat("- a\n- [", n),
                                  indented,          dashes,
                                  questions,         Repeat("-\t", n),
                                  Repeat("!!x ", n), Repeat("&a ", n)}) {
    EXPECT_NE(YamlText(bomb).problems, "") << bomb.substr(0, 20);
  }
}

TEST(YamlHostileTest, SixtyFourLevelsAreReadAndOneMoreIsNot) {
  EXPECT_EQ(YamlText(Repeat("[", 64) + "1" + Repeat("]", 64)).problems, "");
  EXPECT_THAT(YamlText(Repeat("[", 65) + "1" + Repeat("]", 65)).problems,
              HasSubstr("nested deeper than 64 levels"));
}

TEST(YamlHostileTest, AStrayBracketEndsTheReading) {
  for (const char* text : {"]", "}", "a: 1\n]", "a: 1\n}\n", ",", "- a\n]", "{a: 1}}"}) {
    const std::string problems = YamlText(text).problems;
    EXPECT_NE(problems, "") << text;
    EXPECT_LT(problems.size(), 200u) << text;
  }
}

TEST(YamlHostileTest, AMapOfTooManyKeysIsRefused) {
  std::string keys;
  for (int i = 0; i < 500000; ++i) keys += "k" + std::to_string(i) + ": 1\n";
  EXPECT_THAT(YamlText(keys).problems, HasSubstr("keys in one map"));
}

TEST(YamlHostileTest, FourTimesTheListTakesLittleMoreThanFourTimesTheTime) {
  const auto seconds = [](int numbers) {
    const std::string list = "a: [" + Repeat("1.5, ", numbers) + "1]";
    return SecondsOf([&] { EXPECT_EQ(YamlText(list).problems, ""); });
  };
  const double few = seconds(50000);
  EXPECT_LT(seconds(200000), 10.0 * few);  // of the square it would be 16
}

TEST(YamlHostileTest, AFileFullOfErrorsGivesAReportThatAPersonCanRead) {
  const std::string problems = YamlText("a: [" + Repeat("&x 1, ", 50000) + "1]").problems;
  EXPECT_THAT(problems, HasSubstr("an anchor"));
  EXPECT_LT(problems.size(), 20000u);
}

std::string Mutated(std::string text, std::mt19937& random) {
  const std::string alphabet = "{}[]:,-?&*!|>'\"%@`#\n \t\r0aZ~<=\\$.\x80\xff\xc3\xef\x01";
  const auto below = [&](std::size_t n) { return random() % n; };
  const std::size_t edits = 1 + below(8);
  for (std::size_t i = 0; i < edits && !text.empty(); ++i) {
    const std::size_t at = below(text.size());
    switch (below(5)) {
      case 0:
        text[at] = alphabet[below(alphabet.size())];
        break;
      case 1:
        text.insert(at, 1 + below(3), alphabet[below(alphabet.size())]);
        break;
      case 2:
        text.erase(at, 1 + below(20));
        break;
      case 3:
        text.insert(at, text.substr(below(text.size()), below(60)));
        break;
      default:
        text.resize(at);
    }
  }
  return text;
}

TEST(YamlHostileTest, TenThousandMutationsOfRealFilesNeverCrash) {
  std::vector<std::string> originals;
  for (const auto& entry : fs::recursive_directory_iterator(OCA_SOURCE_DIR "/diagrams")) {
    if (entry.path().extension() == ".yaml") originals.push_back(ReadTextFile(entry.path()));
  }
  ASSERT_GE(originals.size(), 3u);
  std::sort(originals.begin(), originals.end());
  std::mt19937 random(20161);
  int refused = 0;
  for (int i = 0; i < 10000; ++i) {
    const std::string text = Mutated(originals[i % originals.size()], random);
    if (!YamlText(text).problems.empty()) ++refused;
  }
  EXPECT_GT(refused, 2000);
  EXPECT_LT(refused, 10000);
}

}  // namespace yaml_hostile_test
}  // namespace oca::files
