// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/in_memory.h"

#include <gmock/gmock.h>

#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "tests/temporary_folder.h"

namespace oca::runs {
namespace in_memory_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr const char* kRamps = R"(
name: ramps
simulator: {duration: 1}
systems:
  ramp: {type: RampSource, slope: [1, -2], unit: rad}
  slow: {type: RampSource, slope: 0.5}
  obstacles: {type: ObstacleSource}
)";

class InMemoryTest : public testing::Test {
 protected:
  const test::TemporaryFolder folder_;
  const loading::LoadedDiagram loaded_{loading::LoadDiagram(folder_.Write("d.yaml", kRamps))};
};

TEST_F(InMemoryTest, KeepsSignalsSideBySideWithNamesAndUnits) {
  InMemory series({"ramp.value", "slow.value"}, Period(1, 2));
  for (int run = 0; run < 2; ++run) {  // the second takes the place of the first
    runs::Run(loaded_, {.outputs = {&series}});
    EXPECT_EQ(series.times(), Eigen::Vector3d(0.0, 0.5, 1.0));
    EXPECT_EQ(series.Matrix(),
              (Eigen::MatrixXd(3, 3) << 0.0, 0.0, 0.0, 0.5, -1.0, 0.25, 1.0, -2.0, 0.5).finished());
    EXPECT_EQ(series.Matrix("slow.value"), Eigen::Vector3d(0.0, 0.25, 0.5));
  }
  EXPECT_THAT(series.names(), ElementsAre("ramp.value[0]", "ramp.value[1]", "slow.value[0]"));
  EXPECT_THAT(series.units(), ElementsAre("rad", "rad", ""));
}

TEST_F(InMemoryTest, SaysWhatItDoesNotHave) {
  InMemory series({"ramp.value"}, Period(1, 2));
  EXPECT_THAT([&] { series.Matrix(); }, ThrowsMessage<ConfigError>(HasSubstr("got none yet")));
  runs::Run(loaded_, {.outputs = {&series}});
  EXPECT_THAT([&] { series.Matrix("slow.value"); },
              ThrowsMessage<ConfigError>(HasSubstr("'slow.value'; expected one of ramp.value")));
}

TEST_F(InMemoryTest, RefusesASignalThatThereIsNotOrThatIsNoVectorBeforeTheRun) {
  InMemory misspelt({"ramp.valu"}, Period(1, 2));
  EXPECT_THAT([&] { runs::Run(loaded_, {.outputs = {&misspelt}}); },
              ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr("series: ramp.valu"), HasSubstr("ports are: value"))));
  InMemory objects({"obstacles.obstacles"}, Period(1, 2));
  EXPECT_THAT(
      [&] { runs::Run(loaded_, {.outputs = {&objects}}); },
      ThrowsMessage<ConfigError>(AllOf(HasSubstr("series: obstacles.obstacles"),
                                       HasSubstr("asked for as Vector; it is ObstacleSet"))));
  InMemory never({"ramp.value"}, Period());
  EXPECT_THROW(runs::Run(loaded_, {.outputs = {&never}}), ConfigError);
}

}  // namespace in_memory_test
}  // namespace oca::runs
