// SPDX-License-Identifier: BSD-3-Clause
// What expressions take over from earlier ones of the same file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/files/expression.h"
#include "oca/diagrams/files/override.h"
#include "tests/diagrams/files/yaml_text.h"

namespace oca::files {
namespace resolution_test {

using testing::HasSubstr;

/// A file with two entries whose parameters an override may change, resolved with what an earlier
/// file came to.
class ResolvedFile {
 public:
  static constexpr const char* kFile =
      "parameters: {a: 1, b: 2, twice: \"${2 * a}\", at: [\"${a}\", 7], rest: 0, none: 0}\n"
      "systems:\n"
      "  first: {gain: \"${twice}\", at: \"${at}\"}\n"
      "  second: {gain: \"${b}\", kept: [1, 2], far: [\"${rest}\"]}\n"
      "  third: {gain: 3}\n"
      "list: [\"${b}\"]\n";

  ResolvedFile(const std::vector<Override>& overrides, Resolution earlier) {
    static const YamlText document(kFile);
    Value root = document.value;
    Problems problems;
    ApplyOverrides(overrides, root, problems);
    Expressions expressions(At(root, "parameters"), problems,
                            std::make_shared<const Resolution>(std::move(earlier)));
    systems = expressions.Resolve(At(root, "systems"));
    list = expressions.Resolve(At(root, "list"));
    for (const Diagnostic& warning : expressions.Unused()) unused.push_back(warning.ToString());
    EXPECT_THAT(problems.all(), testing::IsEmpty());
    resolution = expressions.TakeResolution();
  }
  Value systems, list;
  std::vector<std::string> unused;
  Resolution resolution;
};

TEST(ResolutionTest, TakesOverWhatUsesNoParameterThatHasChanged) {
  ResolvedFile one({}, {});
  EXPECT_THAT(one.unused, testing::ElementsAre(HasSubstr("parameters.none: nothing uses it")));
  const ResolvedFile two({{"parameters.b", "5"}}, std::move(one.resolution));
  EXPECT_TRUE(At(two.systems, "first").Shares(At(one.systems, "first")));
  EXPECT_TRUE(At(two.systems, "third").Shares(At(one.systems, "third")));
  EXPECT_FALSE(At(two.systems, "second").Shares(At(one.systems, "second")));
  EXPECT_EQ(Number(At(two.systems, "second", "gain")), 5.0);
  EXPECT_TRUE(At(two.systems, "second", "kept").Shares(At(one.systems, "second", "kept")));
  EXPECT_TRUE(At(two.systems, "second", "far").Shares(At(one.systems, "second", "far")));
  EXPECT_EQ(Number(two.list.list()->front()), 5.0);
  EXPECT_EQ(two.unused, one.unused);
}

TEST(ResolutionTest, TakesOverNothingThatUsesAChangedParameterThroughOthers) {
  ResolvedFile one({}, {});
  const ResolvedFile two({{"parameters.a", "4"}}, std::move(one.resolution));
  EXPECT_EQ(Number(At(two.systems, "first", "gain")), 8.0);
  EXPECT_EQ(Number(At(two.systems, "first", "at").list()->front()), 4.0);
  EXPECT_TRUE(At(two.systems, "second").Shares(At(one.systems, "second")));
  EXPECT_TRUE(two.list.Shares(one.list));
  EXPECT_EQ(two.unused, one.unused);
}

TEST(ResolutionTest, TakesNothingOverThatAnOverrideSaysAnew) {
  ResolvedFile one({}, {});
  const ResolvedFile two({{"systems.first.gain", "${b}"}, {"parameters.b", "2"}},
                         std::move(one.resolution));
  EXPECT_EQ(Number(At(two.systems, "first", "gain")), 2.0);
  EXPECT_FALSE(At(two.systems, "second").Shares(At(one.systems, "second")));  // b stands elsewhere
  EXPECT_TRUE(At(two.systems, "third").Shares(At(one.systems, "third")));
  EXPECT_THAT(two.unused, testing::UnorderedElementsAre(HasSubstr("parameters.twice"),
                                                        HasSubstr("parameters.none")));
}

TEST(ResolutionTest, TakesNothingOverFromAFileWithOtherParameters) {
  ResolvedFile one({}, {});
  const YamlText other("{a: 1, b: 2, c: 3, rest: 0, twice: \"${2 * a}\", at: [\"${a}\", 7]}");
  Problems problems;
  Expressions expressions(other.value, problems,
                          std::make_shared<const Resolution>(std::move(one.resolution)));
  const Value systems = At(YamlText(ResolvedFile::kFile).value, "systems");
  EXPECT_EQ(Number(At(expressions.Resolve(systems), "first", "gain")), 2.0);
  EXPECT_THAT(expressions.used(), testing::ElementsAre("a", "at", "b", "rest", "twice"));
}

}  // namespace resolution_test
}  // namespace oca::files
