// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/override.h"

#include <gmock/gmock.h>

namespace oca::files {
namespace override_test {

using testing::StartsWith;

TEST(OverridePlaceTest, IsTheOneThatWasGivenInMessages) {
  EXPECT_EQ(Override::Parse("a.b=c=1").Source(), "-s a.b");
  EXPECT_EQ((Override{"b", "1", "left.b"}).Source(), "-s left.b");
}

TEST(OverridePlaceTest, OfAProgramIsToldByWhatItWasMadeFor) {
  const Override made{"simulator.duration", "[1", {}, "arm.urdf: its first motion"};
  EXPECT_EQ(made.Source(), "arm.urdf: its first motion: simulator.duration");
  Problems problems;
  made.Read(problems);
  ASSERT_FALSE(problems.empty());
  EXPECT_THAT([&] { problems.Throw(); }, testing::ThrowsMessage<std::exception>(StartsWith(
                                             "arm.urdf: its first motion: simulator.duration:1:")));
}

}  // namespace override_test
}  // namespace oca::files
