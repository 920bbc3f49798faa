// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/lzf.h"

#include <gtest/gtest.h>

#include <string>

namespace oca::geometry::internal {
namespace lzf_test {

using std::literals::operator""s;

TEST(LzfTest, CopiesWhatIsNewAndRepeatsWhatWas) {
  EXPECT_EQ(DecompressLzf("\x02"
                          "abc"s,
                          3),
            "abc");
  // 3 bytes from 3 back, then 264 from 1 back: they overlap.
  EXPECT_EQ(DecompressLzf("\x02"
                          "abc\x20\x02"s,
                          6),
            "abcabc");
  EXPECT_EQ(DecompressLzf("\x00"
                          "a\xe0\xff\x00"s,
                          265),
            std::string(265, 'a'));
  // From more than 256 back.
  std::string many =
      "\x00"
      "b"s +
      "\x00"
      "a\xe0\xff\x00"s +
      "\x21\x09"s;
  EXPECT_EQ(DecompressLzf(many, 269), "b" + std::string(265, 'a') + "baa");
  EXPECT_EQ(DecompressLzf("", 0), "");
}

TEST(LzfTest, RefusesWhatIsDamaged) {
  EXPECT_FALSE(
      DecompressLzf("\x02"
                    "ab"s,
                    3));  // a byte too few
  EXPECT_FALSE(
      DecompressLzf("\x02"
                    "abc"s,
                    2));  // more than was said
  EXPECT_FALSE(
      DecompressLzf("\x02"
                    "abc"s,
                    4));                        // less
  EXPECT_FALSE(DecompressLzf("\x20\x00"s, 3));  // from before the start
  EXPECT_FALSE(
      DecompressLzf("\x02"
                    "abc\x20\x03"s,
                    6));
  EXPECT_FALSE(
      DecompressLzf("\x02"
                    "abc\x20"s,
                    6));  // half a repetition
  EXPECT_FALSE(
      DecompressLzf("\x02"
                    "abc\xe0\x01"s,
                    13));
  EXPECT_FALSE(
      DecompressLzf("\x02"
                    "abc\x20\x02"s,
                    5));
  EXPECT_FALSE(DecompressLzf("", 1));
}

TEST(LzfTest, TakesNoMemoryForMoreThanTheBytesCanHold) {
  EXPECT_FALSE(
      DecompressLzf("\x00"
                    "a\xe0\xff\x00"s,
                    std::size_t{1} << 60));
}

}  // namespace lzf_test
}  // namespace oca::geometry::internal
