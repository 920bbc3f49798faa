// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/loading/told_once.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

namespace oca::loading {
namespace told_once_test {

using testing::ElementsAre;

const auto kFile = std::make_shared<const std::string>("used: error: .yaml");

Diagnostic At(int line, const std::string& what) {
  Diagnostic diagnostic;
  diagnostic.location = {kFile, line, 2};
  diagnostic.what = what;
  return diagnostic;
}

std::vector<std::string> LinesOf(const ToldOnce& told) {
  std::vector<std::string> lines;
  for (const Diagnostic& one : told.all()) lines.push_back(one.ToString());
  return lines;
}

// Whatever the name of the file, or the text, says of errors.
TEST(ToldOnceTest, TellsWhatUsesHaveInCommonOnceWithAllOfThem) {
  ToldOnce told;
  const Diagnostic same = At(1, "what: warning: of it");
  told.Add("left", same);
  told.Add("right", At(3, "other"));
  told.Add("right", same);
  told.Add("right", same);
  EXPECT_THAT(LinesOf(told),
              ElementsAre("used: error: .yaml:1:2: error: in left and right: what: warning: of it",
                          "used: error: .yaml:3:2: error: in right: other"));
}

TEST(ToldOnceTest, TellsOfTheFileThatIsBuiltWithoutAUse) {
  ToldOnce told;
  Diagnostic warning = At(1, "what");
  warning.kind = Diagnostic::Kind::kWarning;
  told.Add("", warning);
  told.Add("", At(1, "what"));
  EXPECT_THAT(LinesOf(told), ElementsAre("used: error: .yaml:1:2: warning: what",
                                         "used: error: .yaml:1:2: error: what"));
}

}  // namespace told_once_test
}  // namespace oca::loading
