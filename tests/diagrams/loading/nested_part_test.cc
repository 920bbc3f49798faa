// SPDX-License-Identifier: BSD-3-Clause
// Ports and metrics of files that others use, by path: in a part, and in `expect`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "oca/diagrams/loading/blueprint.h"
#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/error.h"
#include "tests/diagrams/loading/nested_files.h"

namespace oca::loading {
namespace nested_part_test {

using nested_files::TwoStages;
using testing::ElementsAre;
using testing::HasSubstr;

class NestedPartTest : public nested_files::NestedFiles {};

TEST_F(NestedPartTest, BuildsAPartThatIsInsideOfAUse) {
  const Blueprint blueprint(folder.Write("d.yaml", TwoStages()));
  const auto part = [&](std::vector<std::string> names) {
    const LoadedDiagram loaded = blueprint.Build({}, {.part = std::move(names)});
    std::vector<std::string> inputs;
    for (const auto& input : loaded.diagram->exported_inputs()) {
      inputs.push_back(input.name);
      EXPECT_EQ(loaded.diagram->GetInput<Vector>(input.name).system, loaded.diagram.get());
    }
    for (const auto& block : loaded.systems) {
      EXPECT_NO_THROW(loaded.diagram->GetOutput<Vector>(block.name + ".out"));
    }
    return inputs;
  };
  EXPECT_THAT(part({"second"}), ElementsAre("first.lag.out"));
  EXPECT_THAT(part({"first.lag", "second.gain"}), ElementsAre("first.gain.out"));
  EXPECT_THAT([&] { part({"first.gian"}); },
              testing::ThrowsMessage<ConfigError>(
                  HasSubstr("part: no system 'first.gian'; did you mean 'first.gain'?")));
}

TEST(PartOfTwoArmsTest, EveryPortOfAPartOfTwoArmsKeepsItsPath) {
  const Blueprint blueprint(OCA_SOURCE_DIR "/diagrams/dual_arm.yaml");
  const auto whole = blueprint.Build();
  const auto part = blueprint.Build({}, {.part = InsideOf(*whole.diagram)});
  for (const char* arm : {"left", "right"}) {
    const std::string of = arm;
    const auto measured = part.diagram->GetInput<Vector>(of + ".plant.position");
    EXPECT_EQ(part.diagram->PathOf(measured), of + ".plant.position");
    EXPECT_EQ(part.diagram->SizeOf(measured), 7);
    const auto delta = part.diagram->GetOutput<Vector>(of + ".limiter.limited_delta");
    EXPECT_EQ(part.diagram->PathOf(delta), of + ".limiter.limited_delta");
    EXPECT_THROW(part.diagram->GetInput<Vector>(of + "_plant_position"), WiringError);
    EXPECT_THROW(part.diagram->GetOutput<Vector>(of + "_limiter_limited_delta"), WiringError);
  }
}

TEST_F(NestedPartTest, AMisspeltMetricOfAFileThatIsUsedIsToldTheNearest) {
  const auto refused = [&](const std::string& key) {
    return [this, key] {
      LoadDiagram(folder.Write("d.yaml", "include: [" OCA_SOURCE_DIR "/diagrams/dual_arm.yaml]\n"
                                         "expect: {" +
                                             key + ": {at_least: 0}}\n"));
    };
  };
  using testing::ThrowsMessage;
  EXPECT_THAT(refused("lft.min_distance"),
              ThrowsMessage<ConfigError>(HasSubstr("expect.lft.min_distance: no output "
                                                   "'lft.min_distance'; did you mean "
                                                   "'left.min_distance'?")));
  EXPECT_THAT(refused("left.min_distnce"),
              ThrowsMessage<ConfigError>(HasSubstr("did you mean 'min_distance'?")));
}

}  // namespace nested_part_test
}  // namespace oca::loading
