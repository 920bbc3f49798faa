// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/band_memory.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"

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

TEST(BandMemoryTest, WritesAndReadsWhatThePlanCameTo) {
  BandMemory memory;
  memory.plans = 3;
  memory.start = planning::BandStart::kDetour;
  memory.stuck = true;
  memory.nearest = 0.0625;
  memory.link = models::Name("wrist");
  memory.obstacle = models::Name("box");
  std::string text;
  Signal<BandMemory>::WriteJson(memory, text);
  EXPECT_NE(text.find(R"("start":"detour")"), std::string::npos) << text;
  const BandMemory back = Signal<BandMemory>::ReadJson(text);
  std::string again;
  Signal<BandMemory>::WriteJson(back, again);
  EXPECT_EQ(again, text);
}

TEST(BandMemoryTest, RefusesAStartThatThereIsNot) {
  std::string text;
  Signal<BandMemory>::WriteJson({}, text);
  text.replace(text.find("request"), 7, "nothing");
  EXPECT_THROW(Signal<BandMemory>::ReadJson(text), ConfigError);
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
