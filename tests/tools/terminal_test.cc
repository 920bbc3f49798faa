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

}  // namespace terminal_test
}  // namespace oca::tools
