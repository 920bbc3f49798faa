// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/clear_motion.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"

namespace oca::systems {
namespace clear_motion_test {

TEST(ClearMotionTest, KnowsWhatItWasPlannedWithAndNothingElse) {
  ClearMotion motion{.clear_for = 1.0, .bodies = {models::Name("box"), models::Name("ball")}};
  EXPECT_TRUE(motion.Knows(models::Name("ball"), false));
  EXPECT_FALSE(motion.Knows(models::Name("wall"), false));
  EXPECT_FALSE(motion.Knows(models::Name("elbow"), true));
  motion.own_links = true;
  EXPECT_TRUE(motion.Knows(models::Name("elbow"), true));
}

TEST(ClearMotionTest, IsWrittenAndRead) {
  const ClearMotion motion{.clear_for = 0.25, .bodies = {models::Name("box")}, .own_links = true};
  std::string text;
  Signal<ClearMotion>::WriteJson(motion, text);
  EXPECT_EQ(text, R"({"clear_for":0.25,"bodies":["box"],"own_links":true})");
  const ClearMotion back = Signal<ClearMotion>::ReadJson(text);
  EXPECT_EQ(back.clear_for, 0.25);
  EXPECT_EQ(back.bodies, motion.bodies);
  EXPECT_TRUE(back.own_links);
}

TEST(ClearMotionTest, RefusesWhatIsNoSuchText) {
  for (const char* text : {R"({"clear_for": 1, "bodies": []})",
                           R"({"clear_for": "long", "bodies": [], "own_links": true})",
                           R"({"clear_for": 1, "bodies": [3], "own_links": true})",
                           R"({"clear_for": 1, "bodies": "box", "own_links": true})",
                           R"({"clear_for": 1, "bodies": [], "own_links": 1})"}) {
    EXPECT_THROW(Signal<ClearMotion>::ReadJson(text), ConfigError) << text;
  }
}

TEST(ClearMotionTest, TellsNumbersThatAreNone) {
  EXPECT_TRUE(Signal<ClearMotion>::Check({.clear_for = 1.0}, Look::kFinite).ok());
  EXPECT_FALSE(Signal<ClearMotion>::Check({.clear_for = std::numeric_limits<double>::quiet_NaN()},
                                          Look::kFinite)
                   .ok());
}

}  // namespace clear_motion_test
}  // namespace oca::systems
