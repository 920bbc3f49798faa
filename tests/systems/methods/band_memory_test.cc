// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/band_memory.h"

#include <gtest/gtest.h>

namespace oca::systems {
namespace band_memory_test {

planning::BandCurve Curve(double start) {
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
  memory.change = 1.0;
  EXPECT_EQ(&memory.At(0.999), &memory.held);
  EXPECT_EQ(&memory.At(1.0), &memory.next);
}

TEST(BandMemoryTest, WritesWhatThePlanCameTo) {
  BandMemory memory;
  memory.plans = 3;
  memory.start = planning::BandStart::kDetour;
  memory.stuck = true;
  memory.nearest = 0.0625;
  memory.link = models::Name("wrist");
  memory.obstacle = models::Name("box");
  std::string text;
  Signal<BandMemory>::WriteJson(memory, text);
  EXPECT_EQ(text, R"({"plans":3,"start":"detour","clear":true,"stuck":true,"nearest":0.0625,)"
                  R"("link":"wrist","obstacle":"box","time":0.0,"cost":0.0,"evaluations":0})");
}

TEST(BandMemoryTest, ABandThatIsNotFiniteIsNoSignal) {
  BandMemory memory;
  EXPECT_TRUE(Signal<BandMemory>::Check(memory, Look::kFinite).ok());
  memory.next = Curve(0.0);
  memory.next.controls()(0, 0) = std::nan("");
  EXPECT_FALSE(Signal<BandMemory>::Check(memory, Look::kFinite).ok());
}

}  // namespace band_memory_test
}  // namespace oca::systems
