// SPDX-License-Identifier: BSD-3-Clause
// The parameters `scale` and `time_scale` of the parts: all distances of a method, all times of its
// plans, and nothing else.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "oca/diagrams/loading/loader.h"

namespace oca::loading {
namespace scale_test {

namespace fs = std::filesystem;

/// Numbers that differ, each expected to be half of what it was; how many there are.
int ExpectHalved(const Value& whole, const Value& half, const std::string& path) {
  int halved = 0;
  if (whole.map() != nullptr) {
    for (const Value::Entry& entry : *whole.map()) {
      const Value* const other = half.Find(entry.key);
      EXPECT_NE(other, nullptr) << path << "." << entry.key;
      if (other != nullptr) halved += ExpectHalved(entry.value, *other, path + "." + entry.key);
    }
  }
  double was = 0.0, is = 0.0;
  if (!whole.number(was) || !half.number(is) || was == is) return halved;
  EXPECT_EQ(is, 0.5 * was) << path;
  return halved + 1;
}

TEST(ScaleTest, HalvesTheDistancesOfEachMethodAndNothingElse) {
  int methods = 0;
  for (const auto& entry : fs::directory_iterator(OCA_SOURCE_DIR "/diagrams/parts")) {
    const std::string file = entry.path().stem().string();
    if (!file.starts_with("avoidance_")) continue;
    ++methods;
    const auto load = [&](const char* scale) {
      return LoadDiagram(OCA_SOURCE_DIR "/diagrams/static_test.yaml",
                         {{"parameters.avoidance", file.substr(file.find('_') + 1)},
                          {"parameters.sensing_distance", "2"},
                          {"parameters.scale", scale}});
    };
    const LoadedDiagram whole = load("1"), half = load("0.5");
    // Of `distance` self_distance is one, of the method one at least.
    EXPECT_GE(ExpectHalved(*whole.resolved.Find("systems"), *half.resolved.Find("systems"), file),
              2)
        << file;
  }
  EXPECT_GE(methods, 9);
}

TEST(TimeScaleTest, StretchesWhatPlansTakeAndHowFarTheyLookAndNothingElse) {
  const auto load = [](const char* scale) {
    return LoadDiagram(OCA_SOURCE_DIR "/diagrams/static_test.yaml",
                       {{"parameters.avoidance", "recommended"}, {"parameters.time_scale", scale}});
  };
  const LoadedDiagram usual = load("1"), slow = load("2");
  // plan_period, most_horizon, stuck_time
  EXPECT_EQ(
      ExpectHalved(*slow.resolved.Find("systems"), *usual.resolved.Find("systems"), "systems"), 3);
}

}  // namespace scale_test
}  // namespace oca::loading
