// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/band_signals.h"

#include <gtest/gtest.h>

#include <cmath>

namespace oca::systems {
namespace band_memory_test {

TEST(BandReportSignalTest, WritesWhatThePlanCameTo) {
  BandReport report;
  report.plans = 3;
  report.start = planning::BandStart::kDetour;
  report.stuck = true;
  report.nearest = 0.0625;
  report.link = models::Name("wrist");
  report.obstacle = models::Name("box");
  report.lack = planning::BandLack::kGoal;
  report.block = planning::BandBlock::kContact;
  report.block_link = report.link;
  report.block_body = report.obstacle;
  report.block_amount = 0.25;
  std::string text;
  Signal<BandReport>::WriteJson(report, text);
  EXPECT_EQ(text,
            R"({"plans":3,"start":"detour","clear":true,"reaches":true,"stuck":true,)"
            R"("nearest":0.0625,"link":"wrist","obstacle":"box","distance":0.0,"lack":"goal",)"
            R"("block":"contact","block_link":"wrist","block_body":"box","block_amount":0.25,)"
            R"("time":0.0,"cost":0.0,"evaluations":0,"charged":0.0,"overruns":0})");
}

TEST(BandMemorySignalTest, ABandThatIsNotFiniteIsNoSignal) {
  BandMemory memory;
  EXPECT_TRUE(Signal<BandMemory>::Check(memory, Look::kFinite).ok());
  memory.next = planning::BandCurve(2, {0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75});
  memory.next.controls()(0, 0) = std::nan("");
  EXPECT_FALSE(Signal<BandMemory>::Check(memory, Look::kFinite).ok());
}

}  // namespace band_memory_test
}  // namespace oca::systems
