// SPDX-License-Identifier: BSD-3-Clause
// An arm whose forearm stands 5 mm from its base by design: what it is asked for, and what is told.
#include "oca/diagrams/runs/own_links_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "oca/diagrams/loading/loader.h"
#include "oca/diagrams/runs/run.h"
#include "tests/temporary_folder.h"

namespace oca::runs {
namespace own_links_check_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A base, an upper link that turns about z, and a fore link that turns about y 0.2 m above; `gap`
/// (m) is between the fore link's ball and the disc of the base below it, whatever the joints do.
std::string Arm(double gap) {
  return R"xml(<robot name="near">
  <link name="base"><collision><geometry><cylinder radius="0.3" length="0.1"/></geometry></collision></link>
  <link name="upper"><collision><origin xyz="0 0 0.7"/><geometry><sphere radius="0.05"/></geometry></collision></link>
  <link name="fore">
    <collision><geometry><sphere radius="0.1"/></geometry></collision>
    <collision><origin xyz="0.25 0 0"/><geometry><box size="0.3 0.06 0.06"/></geometry></collision>
  </link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" velocity="2" effort="9"/></joint>
  <joint name="bend" type="revolute"><parent link="upper"/><child link="fore"/>
    <origin xyz="0 0 )xml" +
         std::to_string(0.15 + gap) + R"xml("/><axis xyz="0 1 0"/>
    <limit lower="-1.5" upper="0.2" velocity="2" effort="9"/></joint>
</robot>
)xml";
}

class OwnLinksCheckTest : public testing::Test {
 protected:
  loading::LoadedDiagram Load(double gap, std::vector<files::Override> overrides = {}) {
    folder_.Write("near.urdf", Arm(gap));
    folder_.Write("near.yaml",
                  "name: near\n"
                  "include: [\"" OCA_SOURCE_DIR
                  "/diagrams/parts/avoidance.yaml\"]\n"
                  "parameters: {self_collision: true, relaxation_time: 0.4}\n"
                  "simulator: {duration: 12}\n"
                  "models: {arm: {urdf: near.urdf}}\n"
                  "systems:\n"
                  "  obstacles: {type: ObstacleSource, obstacles: []}\n"
                  "  spline:\n"
                  "    type: SplineGenerator\n"
                  "    period: ${1 / rate}\n"
                  "    key_points: [{time: 0.5, position: [0, -0.3]}, {time: 6, position: [2.5, "
                  "-0.3]}]\n"
                  "  plant: {initial_position: [0, -0.3]}\n");
    return loading::LoadDiagram(folder_.path() / "near.yaml", overrides);
  }

  test::TemporaryFolder folder_;
};

TEST_F(OwnLinksCheckTest, NamesEachPairThatStandsNearerThanItIsToKeep) {
  EXPECT_THAT(OwnLinkWarnings(Load(0.005)),
              ElementsAre(AllOf(HasSubstr("warning: systems.distance: own links"),
                                HasSubstr("nearer at the start than self_distance, 0.01 m: fore "
                                          "and base 0.005 m"))));
  EXPECT_THAT(OwnLinkWarnings(Load(-0.001)),
              ElementsAre(HasSubstr("in contact at the start: fore and base")));
  EXPECT_THAT(OwnLinkWarnings(Load(0.011)), IsEmpty());
  EXPECT_THAT(OwnLinkWarnings(Load(0.005, {{"parameters.self_collision", "false"}})), IsEmpty());
  EXPECT_THAT(OwnLinkWarnings(Load(0.005, {{"parameters.self_distance", "0.004"}})), IsEmpty());
}

// What no joint changes must not hold an arm back.
TEST_F(OwnLinksCheckTest, AnArmThatStandsNearItselfByDesignArrivesClear) {
  for (const char* const method :
       {"report", "report_limited", "relaxed", "velocity_aware", "vortex", "task_priority",
        "flacco", "safety_filter", "recommended"}) {
    const auto loaded = Load(0.005, {{"parameters.avoidance", method}});
    const RunResult result = runs::Run(loaded, {});
    ASSERT_TRUE(result.metrics.has_value()) << method;
    EXPECT_LT(result.metrics->final_error.value_or(1.0), 0.01) << method;
    EXPECT_NEAR(result.metrics->min_distance.value_or(0.0), 0.005, 1e-6) << method;
  }
}

}  // namespace own_links_check_test
}  // namespace oca::runs
