// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/ignored_pairs.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"

namespace oca::systems {
namespace ignored_pairs_test {

TEST(IgnoredPairsTest, AreWrittenAndRead) {
  IgnoredPairs ignored;
  ignored.pairs.emplace_back(models::Name("hand"), models::Name("table"));
  ignored.pairs.emplace_back(models::Name("hand"), models::Name("arm/base"));
  std::string text;
  Signal<IgnoredPairs>::WriteJson(ignored, text);
  EXPECT_EQ(text, R"({"pairs":[["hand","table"],["hand","arm/base"]]})");
  EXPECT_EQ(Signal<IgnoredPairs>::ReadJson(text).pairs, ignored.pairs);
}

TEST(IgnoredPairsTest, RefuseWhatIsNoPair) {
  for (const char* text : {R"({"pairs": [["hand"]]})", R"({"pairs": [["a", "b", "c"]]})",
                           R"({"pairs": ["hand"]})", R"({})", R"({"pairs": [[1, 2]]})"}) {
    EXPECT_THROW(Signal<IgnoredPairs>::ReadJson(text), ConfigError) << text;
  }
}

}  // namespace ignored_pairs_test
}  // namespace oca::systems
