// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/foreign_text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace oca::models::internal {
namespace {

TEST(ForeignTextTest, KnowsTheSequencesOfUtf8AndBothSidesOfTheirBounds) {
  EXPECT_EQ(Utf8Length("a"), 1u);
  EXPECT_EQ(Utf8Length("\xC2\x80"), 2u);
  EXPECT_EQ(Utf8Length("\xE0\xA0\x80"), 3u);
  EXPECT_EQ(Utf8Length("\xED\x9F\xBF"), 3u);
  EXPECT_EQ(Utf8Length("\xF0\x90\x80\x80"), 4u);
  EXPECT_EQ(Utf8Length("\xF4\x8F\xBF\xBF"), 4u);
  for (const char* const wrong :
       {"\x80", "\xC1\xBF", "\xC2", "\xC2 ", "\xE0\x9F\xBF", "\xE2\x82", "\xED\xA0\x80",
        "\xF0\x8F\xBF\xBF", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xFF"}) {
    EXPECT_EQ(Utf8Length(wrong), 0u) << static_cast<int>(static_cast<unsigned char>(wrong[0]));
  }
}

TEST(ForeignTextTest, WritesACodePointAndReadsItBack) {
  const auto written = [](std::uint32_t code) {
    std::string text;
    AppendUtf8(text, code);
    return text;
  };
  EXPECT_EQ(written(0), std::string(1, '\0'));
  EXPECT_EQ(written(0x41), "A");
  EXPECT_EQ(written(0xe4), "\xC3\xA4");
  EXPECT_EQ(written(0x20ac), "\xE2\x82\xAC");
  EXPECT_EQ(written(0x1f916), "\xF0\x9F\xA4\x96");
  for (const std::uint32_t code : {0x7fu, 0x80u, 0x7ffu, 0x800u, 0xffffu, 0x10000u, 0x10ffffu}) {
    EXPECT_EQ(CodePoint(written(code)), code);
    EXPECT_EQ(Utf8Length(written(code)), written(code).size());
  }
}

TEST(ForeignTextTest, PutsAReplacementInPlaceOfEachByteThatIsNone) {
  EXPECT_EQ(Utf8Prefix("caf\xC3\xA9"), 5u);
  EXPECT_EQ(Utf8Prefix("caf\xE9.yaml"), 3u);
  EXPECT_EQ(AsUtf8("caf\xE9.yaml"), "caf\xEF\xBF\xBD.yaml");
  EXPECT_EQ(AsUtf8("\xE2\x82"), "\xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_EQ(AsUtf8("\xE2\x82\xAC\n\x1b"), "\xE2\x82\xAC\n\x1b");
  EXPECT_EQ(AsUtf8(""), "");
  EXPECT_EQ(SpeltAsUtf8("caf\xE9 \xC3\xA9"),
            "caf\xEF\xBF\xBD"
            "e9 \xC3\xA9");
}

TEST(ForeignTextTest, SpellsWhatATerminalWouldObey) {
  EXPECT_EQ(Harmless("a\x1b[2Jb\rc\a"), "a\\x1b[2Jb\\x0dc\\x07");
  EXPECT_EQ(Harmless("\x7f|\xC2\x9B|\xC2\xA0"), "\\x7f|\\x9b|\xC2\xA0");
  EXPECT_EQ(Harmless("\xE2\x80\xAE|\xE2\x81\xA6"), "\\u202e|\\u2066");
  EXPECT_EQ(Harmless("two\nlines\tand \xC3\xA9 \xE9"), "two\nlines\tand \xC3\xA9 \xEF\xBF\xBD");
  EXPECT_EQ(Harmless(std::string("\0", 1)), "\\x00");
}

}  // namespace
}  // namespace oca::models::internal
