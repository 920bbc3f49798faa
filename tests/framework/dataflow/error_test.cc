// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/error.h"

#include <gtest/gtest.h>

#include <string>

namespace oca::test {
namespace error_test {

TEST(ErrorTest, AZeroByteOfAForeignNameEndsNoMessage) {
  const std::string name("\0a\0", 3);
  EXPECT_STREQ(ConfigError("include: '" + name + "'; got none").what(),
               "include: '\\x00a\\x00'; got none");
  EXPECT_STREQ(WiringError("port '" + name + "'").what(), "port '\\x00a\\x00'");
  EXPECT_NE(std::string(SimulationError("s", name, 1.0, "why").what()).find("why"),
            std::string::npos);
}

TEST(ErrorTest, OtherTextStaysAsItIs) {
  EXPECT_STREQ(Error("").what(), "");
  EXPECT_STREQ(Error("a\\x00\n\x01\xc3\xa4").what(), "a\\x00\n\x01\xc3\xa4");
}

}  // namespace error_test
}  // namespace oca::test
