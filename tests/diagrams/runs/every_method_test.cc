// SPDX-License-Identifier: BSD-3-Clause
// Each diagram file that leaves the method of avoidance open loads and runs with each method.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "oca/diagrams/runs/run.h"
#include "tests/diagrams/runs/method_run.h"

namespace oca::runs {
namespace every_method_test {

namespace fs = std::filesystem;

const fs::path kFolder = OCA_SOURCE_DIR "/diagrams";

std::vector<std::string> Files() {
  std::vector<std::string> files;
  for (const fs::path& folder : {kFolder, kFolder / "scenarios"}) {
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() != ".yaml") continue;
      files.push_back(entry.path().lexically_relative(kFolder).string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Not a pure potential field.
bool LeavesTheMethodOpen(const std::string& file) { return file != "attractive_goal.yaml"; }

class EveryMethodTest : public testing::TestWithParam<std::string> {};

TEST_P(EveryMethodTest, RunsInEveryFile) {
  for (const std::string& file : Files()) {
    if (!LeavesTheMethodOpen(file)) continue;
    SCOPED_TRACE(file);
    try {
      const loading::LoadedDiagram loaded =
          loading::LoadDiagram(kFolder / file, {{"parameters.avoidance", GetParam()}});
      EXPECT_THAT(loaded.warnings, testing::IsEmpty());
      RunOptions options;
      options.duration = 0.05;
      EXPECT_FALSE(runs::Run(loaded, options).failure);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethodTest, testing::ValuesIn(Methods()),
                         [](const auto& method) { return method.param; });

}  // namespace every_method_test
}  // namespace oca::runs
