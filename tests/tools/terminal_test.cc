// SPDX-License-Identifier: BSD-3-Clause
#include "tools/simulator/terminal.h"

#include <gtest/gtest.h>

namespace oca::tools {
namespace terminal_test {

using Seconds = TaskProgress::Seconds;

/// What a progress writes when it is shown these shares of tasks "a" and then "b".
std::string Shown(Seconds patience, Seconds interval) {
  testing::internal::CaptureStderr();
  {
    TaskProgress progress(patience, interval);
    for (const double share : {0.25, 0.5, 1.0}) progress.Show("a", share);
    for (const double share : {0.125, 0.25}) progress.Show("b", share);
  }
  return testing::internal::GetCapturedStderr();
}

TEST(TaskProgressTest, WritesALineForEachStepIfItIsToWaitForNothing) {
  EXPECT_EQ(Shown(Seconds(0.0), Seconds(0.0)),
            "a: 25 % after 0 s\na: 50 % after 0 s\nb: 12 % after 0 s\nb: 25 % after 0 s\n");
}

TEST(TaskProgressTest, WritesOnceAnIntervalAndNothingOfTasksThatEndSoon) {
  EXPECT_EQ(Shown(Seconds(0.0), Seconds(1e3)), "a: 25 % after 0 s\nb: 12 % after 0 s\n");
  EXPECT_EQ(Shown(Seconds(1e3), Seconds(0.0)), "");
}

TEST(TerminalTest, CutsLinesOfErrorsThatHaveNoEnd) {
  const std::string long_line = "begin" + std::string(100000, 'x') + "end";
  testing::internal::CaptureStderr();
  WriteError("short\n" + long_line + "\n" + std::string(1999, 'y') + "\nlast");
  const std::string text = testing::internal::GetCapturedStderr();
  EXPECT_TRUE(text.starts_with("short\nbeginxxx")) << text.substr(0, 40);
  EXPECT_TRUE(text.ends_with("yyy\nlast"));
  EXPECT_NE(text.find("xxx [... 98209 characters ...] xxx"), std::string::npos);
  EXPECT_NE(text.find("xxxend\n" + std::string(1999, 'y')), std::string::npos);
  EXPECT_LT(text.size(), 4100u);
}

}  // namespace terminal_test
}  // namespace oca::tools
