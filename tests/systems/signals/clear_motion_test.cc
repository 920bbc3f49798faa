// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/clear_motion.h"

#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/error.h"

namespace oca::systems {
namespace clear_motion_test {

TEST(ClearMotionTest, KnowsWhatItWasPlannedWithAndNothingElse) {
  ClearMotion motion{.clear_for = 1.0, .bodies = {models::Name("box"), models::Name("ball")}};
  EXPECT_TRUE(motion.ClearFor(models::Name("ball"), false) > 0.0);
  EXPECT_FALSE(motion.ClearFor(models::Name("wall"), false) > 0.0);
  EXPECT_FALSE(motion.ClearFor(models::Name("elbow"), true) > 0.0);
  motion.own_links = true;
  EXPECT_TRUE(motion.ClearFor(models::Name("elbow"), true) > 0.0);
}

TEST(ClearMotionTest, KnowsWhatStandsByItself) {
  ClearMotion motion{.clear_for = 0.5,
                     .bodies = {models::Name("box"), models::Name("ball")},
                     .standing_for = 2.0,
                     .standing = {models::Name("box")}};
  EXPECT_EQ(motion.ClearFor(models::Name("box"), false), 2.0);
  EXPECT_EQ(motion.ClearFor(models::Name("ball"), false), 0.5);
  EXPECT_EQ(motion.ClearFor(models::Name("elbow"), true), 0.0);
  motion.own_links = true;
  EXPECT_EQ(motion.ClearFor(models::Name("elbow"), true), 2.0);
  std::string text;
  Signal<ClearMotion>::WriteJson(motion, text);
  const ClearMotion back = Signal<ClearMotion>::ReadJson(text);
  EXPECT_EQ(back.standing_for, 2.0);
  EXPECT_EQ(back.standing, motion.standing);
}

TEST(ClearMotionTest, IsWrittenAndRead) {
  const ClearMotion motion{.clear_for = 0.25, .bodies = {models::Name("box")}, .own_links = true};
  std::string text;
  Signal<ClearMotion>::WriteJson(motion, text);
  EXPECT_EQ(
      text,
      R"({"clear_for":0.25,"bodies":["box"],"own_links":true,"standing_for":0.0,"standing":[]})");
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
                           R"({"clear_for": 1, "bodies": [], "own_links": 1})",
                           R"({"clear_for": 1, "bodies": [], "own_links": true, "standing": 1})"}) {
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
