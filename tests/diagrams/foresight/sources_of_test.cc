// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/sources_of.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "oca/diagrams/loading/loader.h"
#include "tests/temporary_folder.h"

namespace oca::foresight {
namespace sources_of_test {

using testing::ElementsAre;
using testing::IsEmpty;

// Constants behind a gain, behind a delay and behind each other; a loop through the delay.
constexpr char kWiring[] =
    "systems:\n"
    "  far: {type: Constant, value: 1}\n"
    "  first: {type: Gain, gain: 2}\n"
    "  second: {type: Constant, value: 1}\n"
    "  both: {type: Sum, inputs: 2}\n"
    "  delay: {type: Delay, period: 0.1, steps: 1}\n"
    "  back: {type: Sum, inputs: 2}\n"
    "  sink: {type: Gain, gain: 1}\n"
    "  obstacles: {type: ObstacleSource, obstacles: []}\n"
    "  sensor: {type: ObstacleSensor, period: 0.1}\n"
    "connections:\n"
    "  - far.value -> first.in\n"
    "  - first.out -> both.in0\n"
    "  - second.value -> back.in0\n"
    "  - both.out -> back.in1\n"
    "  - back.out -> delay.in\n"
    "  - delay.out -> both.in1\n"
    "  - both.out -> sink.in\n"
    "  - obstacles.obstacles -> sensor.in\n";

class SourcesOfTest : public testing::Test {
 protected:
  SourcesOfTest() : loaded(loading::LoadDiagram(folder.Write("d.yaml", kWiring))) {}

  /// The sources of an input among the systems named.
  std::vector<std::string> Of(const std::string& input, const std::vector<std::string>& systems) {
    const Diagram& diagram = *loaded.diagram;
    std::vector<std::string> sources;
    for (const OutputHandle& source :
         SourcesOf(diagram, diagram.FindInput(input), [&](const System& system) {
           return std::find(systems.begin(), systems.end(), diagram.PathOf(system)) !=
                  systems.end();
         })) {
      sources.push_back(diagram.PathOf(source));
    }
    return sources;
  }

  test::TemporaryFolder folder;
  const loading::LoadedDiagram loaded;
};

TEST_F(SourcesOfTest, AreTheNearestWhateverPassesTheirValuesOn) {
  EXPECT_THAT(Of("sink.in", {"far"}), ElementsAre("far.value"));
  EXPECT_THAT(Of("sink.in", {"far", "first"}), ElementsAre("first.out"));
  EXPECT_THAT(Of("sink.in", {"both"}), ElementsAre("both.out"));
}

TEST_F(SourcesOfTest, CountAtOnceOrLaterAndEachOnce) {
  EXPECT_THAT(Of("sink.in", {"far", "second"}), ElementsAre("far.value", "second.value"));
  EXPECT_THAT(Of("back.in1", {"delay", "far"}), ElementsAre("far.value", "delay.out"));
}

TEST_F(SourcesOfTest, AreNoneIfNoSystemCountsOrNothingDrivesTheInput) {
  EXPECT_THAT(Of("sink.in", {"sink", "obstacles"}), IsEmpty());
  EXPECT_THAT(Of("obstacles.offsets", {"far"}), IsEmpty());
  EXPECT_THAT(SourcesOf(*loaded.diagram, InputHandle{}, [](const System&) { return true; }),
              IsEmpty());
}

TEST_F(SourcesOfTest, AreOfTheTypeOfTheInput) {
  EXPECT_THAT(Of("sensor.in", {"obstacles"}), ElementsAre("obstacles.obstacles"));
}

}  // namespace sources_of_test
}  // namespace oca::foresight
