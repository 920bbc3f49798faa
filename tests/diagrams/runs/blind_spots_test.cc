// SPDX-License-Identifier: BSD-3-Clause
// What a run did not look at is not clear, and a contact that nobody expects is not met.
#include "oca/diagrams/runs/blind_spots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/runs/result_json.h"
#include "oca/diagrams/runs/run.h"
#include "oca/framework/dataflow/error.h"
#include "oca/systems/signals/signals.h"
#include "tests/temporary_folder.h"

namespace oca::runs {
namespace blind_spots_test {

using systems::ProximitySet;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using testing::ThrowsMessage;

const std::vector<files::Override> kRequestAlone{{"parameters.avoid", "false"}};

/// One joint that turns an arm through a box; its upper link is drawn, its fore link as well.
class BlindSpotsTest : public testing::Test {
 protected:
  loading::LoadedDiagram Load(const std::string& upper, const std::string& fore,
                              std::vector<files::Override> overrides = kRequestAlone,
                              const std::string& expect = "") {
    const std::string box =
        "<geometry><box size=\"0.4 0.1 0.1\"/></geometry><origin xyz=\"0.2 0 0\"/>";
    const auto shape = [&](const std::string& kind) {
      return kind.empty() ? "" : "<" + kind + ">" + box + "</" + kind + ">";
    };
    folder.Write(
        "arm.urdf",
        "<robot name=\"two\"><link name=\"base\"/><link name=\"upper\">" + shape(upper) +
            "</link><link name=\"fore\">" + shape(fore) +
            "</link><joint name=\"j1\" type=\"revolute\"><parent link=\"base\"/><child "
            "link=\"upper\"/><axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" velocity=\"2\" "
            "effort=\"9\"/></joint><joint name=\"j2\" type=\"revolute\"><parent "
            "link=\"upper\"/><child link=\"fore\"/><origin xyz=\"0.4 0 0\"/><axis xyz=\"0 0 1\"/>"
            "<limit lower=\"-3\" upper=\"3\" velocity=\"2\" effort=\"9\"/></joint></robot>");
    const std::string text =
        "include: [" OCA_SOURCE_DIR
        "/diagrams/parts/avoidance.yaml]\n"
        "parameters: {avoidance: safety_filter}\n"
        "simulator: {duration: 4}\n"
        "models: {arm: {urdf: arm.urdf}}\n"
        "systems:\n"
        "  obstacles:\n"
        "    type: ObstacleSource\n"
        "    obstacles:\n"
        "      - {id: box, shape: {type: box, size: [0.2, 0.2, 0.2]}, pose: {xyz: [0, 0.3, 0]}}\n"
        "  spline:\n"
        "    type: SplineGenerator\n"
        "    period: ${1 / rate}\n"
        "    key_points: [{time: 0.5, position: [0, 0]}, {time: 3.5, position: [2.5, 0]}]\n"
        "  plant: {initial_position: [0, 0]}\n";
    return loading::LoadDiagram(folder.Write("d.yaml", text + expect), overrides);
  }
  static nlohmann::json MetricsOf(const RunResult& result) {
    return nlohmann::json::parse(MetricsJson(result.metrics));
  }
  test::TemporaryFolder folder;
};

TEST_F(BlindSpotsTest, ARobotWithoutSolidsIsRefusedAndTheRemedyNamed) {
  EXPECT_THAT([&] { Load("visual", "visual"); },
              ThrowsMessage<ConfigError>(AllOf(
                  HasSubstr("model: got 'arm', which cannot avoid anything"),
                  HasSubstr("no collision shape on any movable link"), HasSubstr("upper, fore"),
                  HasSubstr("models.arm.visual_as_collision: missing"))));
}

TEST_F(BlindSpotsTest, AModelThatNoDistanceUsesIsWarnedOfWhereItStands) {
  folder.Write("frame.urdf",
               "<robot name='frame'><link name='table'><visual><geometry><sphere radius='1'/>"
               "</geometry></visual></link></robot>");
  const auto loaded =
      loading::LoadDiagram(folder.Write("f.yaml",
                                        "models: {frame: {urdf: frame.urdf}}\n"
                                        "systems: {one: {type: Constant, value: 1}}\n"));
  EXPECT_THAT(
      loaded.warnings,
      ElementsAre(AllOf(HasSubstr("f.yaml:1:24: warning: models.frame: robot 'frame' has no "
                                  "collision shape on any link"),
                        HasSubstr("table; visual_as_collision: missing takes what is drawn"))));
}

TEST_F(BlindSpotsTest, OfAHalfBlindRobotTheLinksAreNamed) {
  const loading::LoadedDiagram loaded = Load("collision", "visual");
  EXPECT_THAT(loaded.warnings, ElementsAre(HasSubstr("distances do not see it: fore")));
  EXPECT_THAT(BlindSpots(loaded), ElementsAre("links without a collision shape: fore"));
}

TEST_F(BlindSpotsTest, WhatIsDrawnMayCollide) {
  const loading::LoadedDiagram loaded =
      Load("visual", "visual", {kRequestAlone[0], {"models.arm.visual_as_collision", "missing"}});
  EXPECT_THAT(loaded.warnings, IsEmpty());
  EXPECT_THAT(BlindSpots(loaded), IsEmpty());
  EXPECT_LT(MetricsOf(runs::Run(loaded, {})).at("min_distance").get<double>(), -0.05);
}

TEST_F(BlindSpotsTest, NamesModelsOwnLinksAndPairsThatAreLeftOut) {
  const auto loaded = loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/static_test.yaml");
  EXPECT_THAT(BlindSpots(loaded), ElementsAre("obstacles at links that cannot move: lwr4_base_link",
                                              "own links (self_collision is off)",
                                              "model 'frame' (calculate_link_forces is off)"));
  const auto seeing = loading::LoadDiagram(
      OCA_SOURCE_DIR "/diagrams/static_test.yaml",
      {{"parameters.calculate_link_forces", "true"}, {"parameters.self_collision", "true"}});
  EXPECT_THAT(BlindSpots(seeing),
              ElementsAre(StartsWith("obstacles at links"), "lwr4_link_1 to frame/table (ignore)"));
}

// Each of two uses of a file keeps an arm of its own, which the other one's file knows nothing of.
TEST_F(BlindSpotsTest, NamesModelsThatOnlyAnotherUsedFileKnows) {
  folder.Write("own.yaml",
               "include: [" OCA_SOURCE_DIR
               "/diagrams/parts/arm_loop.yaml]\n"
               "models: {arm: {urdf: package://lwr4/lwr4.urdf, srdf: package://lwr4/lwr4.srdf}}\n");
  const auto loaded =
      loading::LoadDiagram(folder.Write("two.yaml",
                                        "systems:\n"
                                        "  obstacles: {type: ObstacleSource, obstacles: []}\n"
                                        "  a: {type: Diagram, file: own.yaml}\n"
                                        "  b: {type: Diagram, file: own.yaml}\n"
                                        "connections: [obstacles.obstacles -> <arm>.obstacles]\n"));
  const auto spots = BlindSpots(loaded);
  EXPECT_THAT(spots, testing::Contains("model 'b.arm' (not known in the file of a.distance)"));
  EXPECT_THAT(spots, testing::Contains("model 'a.arm' (not known in the file of b.distance)"));
  EXPECT_THAT(spots, testing::Contains("own links of 'a.arm' (self_collision is off)"));
  EXPECT_THAT(spots, testing::Contains("own links of 'b.arm' (self_collision is off)"));
  const auto seeing = BlindSpots(loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/dual_arm.yaml"));
  EXPECT_THAT(seeing, testing::Each(testing::Not(HasSubstr("not known"))));
}

/// Puts together what two blocks see, the first one now, the other one as it was a while ago.
class Fusion final : public System {
 public:
  Fusion()
      : last_(DeclareDiscreteState("last", ProximitySet())),
        now(DeclareInput<ProximitySet>("now")),
        late(DeclareOptionalInput<ProximitySet>("late")),
        out(DeclareOutput<ProximitySet, &Fusion::Calc>("out", {}, now, last_)) {
    DeclareUpdate<&Fusion::Keep>(Every{Period(1, 10)}, Writes(last_), late);
  }

 private:
  void Calc(const ProximitySet& seen, const ProximitySet& last, ProximitySet& all) const {
    all = seen;
    all.proximities.insert(all.proximities.end(), last.proximities.begin(), last.proximities.end());
  }
  void Keep(const ProximitySet* seen, ProximitySet& last) const {
    if (seen != nullptr) last = *seen;
  }
  const DiscreteState<ProximitySet> last_;

 public:
  const Input<ProximitySet> now;
  const OptionalInput<ProximitySet> late;
  const Output<ProximitySet> out;
};

/// Obstacles as they came in.
class Relay final : public System {
 public:
  Relay()
      : in(DeclareInput<systems::ObstacleSet>("in")),
        out(DeclareOutput<systems::ObstacleSet, &Relay::Calc>("out", {}, in)) {}

 private:
  void Calc(const systems::ObstacleSet& from, systems::ObstacleSet& to) const { to = from; }

 public:
  const Input<systems::ObstacleSet> in;
  const Output<systems::ObstacleSet> out;
};

// A block of distances and a sensor stand behind blocks that pass on what they say. What the robot
// is controlled by is none of the judge's.
TEST_F(BlindSpotsTest, LooksBehindBlocksThatPassOnWhatASensorOrADistanceSays) {
  auto catalogue = files::Catalogue::Standard();
  const SystemDoc doc{"passes on", "", ""};
  catalogue.Add("Fusion", doc, [] { return std::make_unique<Fusion>(); });
  catalogue.Add("Relay", doc, [] { return std::make_unique<Relay>(); });
  const auto spots = [&](const std::string& more) {
    return BlindSpots(loading::LoadDiagram(
        folder.Write("fused.yaml",
                     "models: {arm: {urdf: package://lwr4/lwr4.urdf, srdf: "
                     "package://lwr4/lwr4.srdf}}\n"
                     "systems:\n"
                     "  q: {type: Constant, value: [0, 1, 0, 0, 0, 0, 0], unit: rad}\n"
                     "  kinematics: {type: RobotKinematics}\n"
                     "  obstacles: {type: ObstacleSource, obstacles: []}\n"
                     "  sensor: {type: ObstacleSensor, period: 0.1}\n"
                     "  relay: {type: Relay}\n"
                     "  whole: {type: BulletDistance, max_distance: 1}\n"
                     "  sensed: {type: BulletDistance, max_distance: 1, self_collision: true}\n"
                     "  fusion: {type: Fusion}\n"
                     "  metrics: {type: MotionMetrics, period: 0.01}\n"
                     "connections:\n"
                     "  - q.value -> kinematics.position\n"
                     "  - kinematics.links -> whole.links\n"
                     "  - kinematics.links -> sensed.links\n"
                     "  - obstacles.obstacles -> whole.obstacles\n"
                     "  - obstacles.obstacles -> sensor.in\n"
                     "  - sensor.obstacles -> relay.in\n"
                     "  - relay.out -> sensed.obstacles\n"
                     "  - whole.proximities -> fusion.now\n"
                     "  - fusion.out -> metrics.proximities\n" +
                         more),
        {}, catalogue));
  };
  EXPECT_THAT(spots(""), ElementsAre("obstacles at links that cannot move: lwr4_base_link",
                                     "own links (self_collision is off)"));
  EXPECT_THAT(
      spots("  - sensed.proximities -> fusion.late\n"),
      ElementsAre("obstacles at links that cannot move: lwr4_base_link",
                  "own links (self_collision is off)", "obstacles but as 'sensor' reports them"));
}

TEST_F(BlindSpotsTest, NamesASensorThatAJudgeBelieves) {
  const std::string file = OCA_SOURCE_DIR "/diagrams/scenarios/fault_latency.yaml";
  EXPECT_THAT(BlindSpots(loading::LoadDiagram(file)),
              ElementsAre(StartsWith("obstacles at links"), StartsWith("own links")));
  EXPECT_THAT(BlindSpots(loading::LoadDiagram(file, {{"parameters.judge", "distance"}})),
              testing::Contains("obstacles but as 'sensor' reports them"));
}

TEST_F(BlindSpotsTest, WithNothingToCompareNothingIsKnown) {
  const RunResult result = runs::Run(
      Load("collision", "collision", {kRequestAlone[0], {"systems.obstacles.obstacles", "[]"}},
           "expect: {contact_time: {equal: 0}}\n"),
      {});
  const auto metrics = MetricsOf(result);
  for (const char* key : {"min_distance", "certified_min_distance", "contact_time"}) {
    EXPECT_TRUE(metrics.at(key).is_null()) << key;
  }
  EXPECT_FALSE(result.ExpectationsMet());  // who expects no contact wants it looked at
}

TEST_F(BlindSpotsTest, AContactThatNothingAllowsIsAnExpectationNotMet) {
  const RunResult result = runs::Run(Load("collision", "collision"), {});
  ASSERT_EQ(result.expectations.size(), 1u);
  EXPECT_EQ(result.expectations[0].name, "min_distance");
  EXPECT_THAT(result.expectations[0].bound, StartsWith("> 0"));
  EXPECT_LT(result.expectations[0].value.value(), -0.05);
  EXPECT_FALSE(result.ExpectationsMet());
  EXPECT_TRUE(runs::Run(Load("collision", "collision", {}), {}).ExpectationsMet());
}

TEST_F(BlindSpotsTest, ExpectMayAllowAContact) {
  const auto met = [&](const std::string& expect) {
    return runs::Run(Load("collision", "collision", kRequestAlone, "expect: {" + expect + "}\n"),
                     {})
        .ExpectationsMet();
  };
  for (const char* allows :
       {"min_distance: {at_least: -0.2}", "contact_time: {at_least: 0.1}",
        "contact_time: {equal: 0.5, within: 1}", "first_contact_time: {at_least: 0}",
        "min_distance: {at_most: 0}", "metrics.metrics.min_distance: {at_most: -0.01}"}) {
    EXPECT_TRUE(met(allows)) << allows;
  }
  for (const char* not_of_it :
       {"final_error: {at_most: 9}", "min_distance: {at_most: 1}", "contact_time: {at_least: 0}",
        "min_distance: {at_least: 0, at: 0}", "contact_time: {equal: 0, at: 0.5}",
        "contact_time: {at_most: 0, at: 0.5}"}) {
    EXPECT_FALSE(met(not_of_it)) << not_of_it;
  }
}

TEST_F(BlindSpotsTest, ALeastDistanceOutOfReachIsMetByWhatIsProved) {
  const std::vector<files::Override> far{
      kRequestAlone[0],
      {"systems.obstacles.obstacles",
       "[{id: box, shape: {type: box, size: [0.2, 0.2, 0.2]}, pose: {xyz: [0, 3, 0]}}]"}};
  const auto expected = [&](const std::string& bound) {
    return runs::Run(Load("collision", "collision", far, "expect: {min_distance: " + bound + "}\n"),
                     {})
        .expectations.at(0);
  };
  const ExpectationResult met = expected("{at_least: 0.05}");
  EXPECT_TRUE(met.ok);
  EXPECT_EQ(met.bound, ">= 0.05, proved by certified_min_distance");
  EXPECT_GT(met.value.value(), 0.05);
  for (const char* not_proved : {"{at_least: 9}", "{at_most: 9}", "{at_least: 0, at_most: 9}"}) {
    const ExpectationResult result = expected(not_proved);
    EXPECT_FALSE(result.ok) << not_proved;
    EXPECT_FALSE(result.value) << not_proved;
  }
}

TEST_F(BlindSpotsTest, AContactIsToldOnce) {
  const RunResult result = runs::Run(
      Load("collision", "collision", kRequestAlone, "expect: {contact_time: {equal: 0}}\n"), {});
  EXPECT_EQ(result.expectations.size(), 1u);
}

}  // namespace blind_spots_test
}  // namespace oca::runs
