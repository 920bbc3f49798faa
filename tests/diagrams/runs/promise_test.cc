// SPDX-License-Identifier: BSD-3-Clause
// The two methods that promise a distance meet what every file expects that leaves the method open.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run.h"

namespace oca::runs {
namespace promise_test {

namespace fs = std::filesystem;

const fs::path kFolder = OCA_SOURCE_DIR "/diagrams";

/// What is not met, and why; if it is met after all, that is an error too.
struct Unmet {
  const char* method;
  const char* file;
  const char* expectation;
  const char* reason;
};
constexpr Unmet kUnmet[] = {
    {"safety_filter", "ur5e_arm", "final_error",
     "stops in front of the box: the filter has no plan, and the task needs nearly all six joints"},
    {"safety_filter", "first", "final_error", "the same arm and box"},
    {"safety_filter", "scenarios/random_jaws", "min_distance",
     "between four jaws that close only a plan finds the way out"},
};

struct Case {
  std::string method;
  std::string file;
};

/// All but a pure potential field.
std::vector<Case> Cases() {
  std::vector<Case> cases;
  for (const fs::path& folder : {kFolder, kFolder / "scenarios"}) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      fs::path name = entry.path().lexically_relative(kFolder);
      if (name.extension() != ".yaml") continue;
      const std::string file = name.replace_extension().string();
      if (file == "attractive_goal") continue;
      for (const char* method : {"recommended", "safety_filter"}) cases.push_back({method, file});
    }
  }
  return cases;
}

class PromiseTest : public testing::TestWithParam<Case> {};

TEST_P(PromiseTest, IsMetWithoutAWarningOrTheReasonIsNamed) {
  const Case& of = GetParam();
  const loading::LoadedDiagram loaded =
      loading::LoadDiagram(kFolder / (of.file + ".yaml"), {{"parameters.avoidance", of.method}});
  EXPECT_THAT(loaded.warnings, testing::IsEmpty());
  const RunResult result = runs::Run(loaded, {});
  EXPECT_FALSE(result.failure) << result.failure->message;
  for (const ExpectationResult& expectation : result.expectations) {
    const bool met = std::none_of(std::begin(kUnmet), std::end(kUnmet), [&](const Unmet& unmet) {
      return unmet.method == of.method && unmet.file == of.file &&
             unmet.expectation == expectation.name;
    });
    EXPECT_EQ(expectation.ok, met) << expectation.name << " " << expectation.bound << ", got "
                                   << expectation.value.value_or(-1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, PromiseTest, testing::ValuesIn(Cases()), [](const auto& of) {
  std::string name = of.param.method + "_" + of.param.file;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
});

}  // namespace promise_test
}  // namespace oca::runs
