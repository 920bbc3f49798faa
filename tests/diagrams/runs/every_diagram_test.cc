// SPDX-License-Identifier: BSD-3-Clause
// Each diagram file that comes with OCA loads, runs to its end and meets what it expects.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run.h"

namespace oca::runs {
namespace every_diagram_test {

namespace fs = std::filesystem;

const fs::path kFolder = OCA_SOURCE_DIR "/diagrams";

/// Files in parts/ are pieces that others include.
std::vector<std::string> DiagramFiles() {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(kFolder)) {
    const fs::path name = entry.path().lexically_relative(kFolder);
    if (name.extension() == ".yaml" && *name.begin() != "parts") files.push_back(name.string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

class EveryDiagramTest : public testing::TestWithParam<std::string> {};

TEST_P(EveryDiagramTest, LoadsRunsToItsEndAndMeetsItsExpectations) {
  const loading::LoadedDiagram loaded = loading::LoadDiagram(kFolder / GetParam());
  EXPECT_FALSE(loaded.description.empty());
  EXPECT_FALSE(loaded.expectations.empty());
  EXPECT_EQ(loaded.name, fs::path(GetParam()).stem().string());
  const RunResult result = runs::Run(loaded, {});
  EXPECT_FALSE(result.failure) << result.failure->message;
  EXPECT_FALSE(result.interrupted);
  EXPECT_DOUBLE_EQ(result.duration, loaded.simulator.duration);
  for (const ExpectationResult& expectation : result.expectations) {
    EXPECT_TRUE(expectation.ok) << expectation.name << " " << expectation.bound << ", got "
                                << (expectation.value ? std::to_string(*expectation.value)
                                                      : "none");
  }
}

INSTANTIATE_TEST_SUITE_P(Diagrams, EveryDiagramTest, testing::ValuesIn(DiagramFiles()),
                         [](const auto& file) {
                           std::string name = fs::path(file.param).replace_extension().string();
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

}  // namespace every_diagram_test
}  // namespace oca::runs
