// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_memory.h"

#include <gtest/gtest.h>

#include <vector>

namespace oca::planning {
namespace band_memory_test {

BandCurve Curve(double start) {
  std::vector<double> times;
  for (int i = 0; i < 8; ++i) times.push_back(start + 0.25 * i);
  return {2, times};
}

TEST(BandMemoryTest, ChangesToTheNextBandWhenItsTimeHasCome) {
  BandMemory memory;
  EXPECT_TRUE(memory.At(1.0).empty());
  memory.held = Curve(0.0);
  EXPECT_EQ(&memory.At(5.0), &memory.held);
  memory.next = Curve(1.0);
  memory.report.change = 1.0;
  EXPECT_EQ(&memory.At(0.999), &memory.held);
  EXPECT_EQ(&memory.At(1.0), &memory.next);
}

}  // namespace band_memory_test
}  // namespace oca::planning
