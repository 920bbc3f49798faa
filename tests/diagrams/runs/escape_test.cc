// SPDX-License-Identifier: BSD-3-Clause
// Jaws that close on an arm which stands among them: seeds in which it once was caught though there
// was a way out.
#include <gtest/gtest.h>

#include <string>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run.h"

namespace oca::runs {
namespace escape_test {

class EscapeTest : public testing::TestWithParam<int> {};

TEST_P(EscapeTest, GetsOutBeforeTheJawsClose) {
  const loading::LoadedDiagram loaded =
      loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/scenarios/random_jaws.yaml",
                           {{"simulator.seed", std::to_string(GetParam())}});
  const RunResult result = runs::Run(loaded, {});
  EXPECT_FALSE(result.failure) << result.failure->message;
  for (const ExpectationResult& expectation : result.expectations) {
    EXPECT_TRUE(expectation.ok) << expectation.name << ", got " << expectation.value.value_or(-1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, EscapeTest,
                         testing::Values(757714819, 1819503266, 190796036, 217445686, 822574627));

}  // namespace escape_test
}  // namespace oca::runs
