// SPDX-License-Identifier: BSD-3-Clause
// A Build does not work out again what no override changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "oca/diagrams/loading/blueprint.h"
#include "oca/framework/dataflow/function.h"
#include "tests/temporary_folder.h"

namespace oca::loading {
namespace sharing_test {

using testing::ElementsAre;
using Overrides = std::vector<files::Override>;

const std::filesystem::path kFolder = OCA_SOURCE_DIR "/diagrams";

TEST(SharingTest, SharesWhatIsSaidOfSystemsThatNoOverrideChanges) {
  for (const char* const name : {"static_test.yaml", "dual_arm.yaml"}) {
    const Blueprint blueprint(kFolder / name);
    const bool uses = std::string(name) == "dual_arm.yaml";
    const std::string change = uses ? "left.parameters.start.1" : "parameters.test_obstacle_height";
    const LoadedDiagram one = blueprint.Build({{change, "0.91"}});
    const LoadedDiagram two = blueprint.Build({{change, "0.92"}});
    std::vector<std::string> own;
    for (const LoadedDiagram::Block& block : one.systems) {
      const LoadedDiagram::Block& other = two.BlockOf(*two.diagram->FindSystem(block.name));
      if (!block.params.Shares(other.params)) own.push_back(block.name);
    }
    if (uses) {
      EXPECT_THAT(own, ElementsAre("left.plant", "left.spline"));
    } else {
      EXPECT_THAT(own, ElementsAre("obstacles"));
    }
  }
}

/// Parameters that count how often they are read.
struct CountedParams {
  CountedParams() { ++made; }
  static inline int made{0};
  double value{0.0};
  static void Describe(Fields<CountedParams>& fields) {
    fields.Add("value", &CountedParams::value, "", "that is shown");
  }
};

TEST(SharingTest, ReadsParametersAgainOnlyIfTheyChange) {
  constexpr SystemDoc kDoc{"a number", "out = value", ""};
  auto catalogue = files::Catalogue::Standard();
  catalogue.Add("Counted", kDoc, CountedParams{}, [](const CountedParams& params) {
    return MakeBlock({.output = {"out", 1}}, [value = params.value] { return value; });
  });
  const test::TemporaryFolder folder;
  const Blueprint blueprint(folder.Write("d.yaml",
                                         "parameters: {a: 1, b: 2}\n"
                                         "systems:\n"
                                         "  first: {type: Counted, value: \"${a}\"}\n"
                                         "  second: {type: Counted, value: \"${2 * b}\"}\n"),
                            catalogue);
  const auto values = [&](const Overrides& overrides) {
    const LoadedDiagram loaded = blueprint.Build(overrides);
    const Context context = loaded.diagram->MakeContext();
    const auto value = [&](const char* output) {
      return loaded.diagram->GetOutput<Vector>(output).Eval(context)[0];
    };
    return std::vector<double>{value("first.out"), value("second.out")};
  };
  const int before = CountedParams::made;
  EXPECT_THAT(values({}), ElementsAre(1.0, 4.0));
  EXPECT_EQ(CountedParams::made - before, 2);
  EXPECT_THAT(values({{"simulator.duration", "3"}}), ElementsAre(1.0, 4.0));
  EXPECT_EQ(CountedParams::made - before, 2);
  EXPECT_THAT(values({{"parameters.b", "5"}}), ElementsAre(1.0, 10.0));
  EXPECT_EQ(CountedParams::made - before, 3);
  EXPECT_THAT(values({{"systems.first.value", "7"}}), ElementsAre(7.0, 4.0));
  EXPECT_EQ(CountedParams::made - before, 5);  // b is what it was before the last Build
}

}  // namespace sharing_test
}  // namespace oca::loading
