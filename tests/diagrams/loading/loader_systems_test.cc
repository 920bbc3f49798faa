// SPDX-License-Identifier: BSD-3-Clause
// Systems of a file, their parameters and connections, and what is wrong of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/diagrams/loading/chain_file.h"

namespace oca::loading {
namespace loader_systems_test {

using chain_file::Chain;
using chain_file::kArm;
using testing::AllOf;
using testing::HasSubstr;

class LoaderSystemsTest : public chain_file::ChainFile {};

TEST_F(LoaderSystemsTest, NamesAnUnknownSystemTypeAndTheNearest) {
  EXPECT_THAT(
      Refusal(Chain("type: Gain", "type: Gian")),
      HasSubstr("d.yaml:5:16: error: systems.gain.type: no system type 'Gian'; did you mean "
                "'Gain'?"));
}

TEST_F(LoaderSystemsTest, NamesAnUnknownParameterAndTheNearest) {
  EXPECT_THAT(
      Refusal(Chain("gain: 3", "gian: 3")),
      HasSubstr("d.yaml:5:22: error: systems.gain.gian: unknown key; did you mean 'gain'?"));
}

TEST_F(LoaderSystemsTest, NamesUnknownPortsAndTheNearest) {
  EXPECT_THAT(Refusal(Chain("gain.out ->", "gain.oot ->")),
              AllOf(HasSubstr("d.yaml:9:5: error: connections: gain: "), HasSubstr("oot"),
                    HasSubstr("did you mean 'out'?")));
  EXPECT_THAT(Refusal(Chain("-> lag.in", "-> lag.input")),
              AllOf(HasSubstr("d.yaml:9:5: error: connections: lag: "), HasSubstr("input")));
}

TEST_F(LoaderSystemsTest, NamesUnknownSystemsInConnectionsAndTheNearest) {
  EXPECT_THAT(Refusal(Chain("gain.out ->", "gian.out ->")),
              HasSubstr("d.yaml:9:5: error: connections: no system 'gian'; did you mean 'gain'?"));
}

TEST_F(LoaderSystemsTest, ConnectionsThatAreNoneAreRefused) {
  for (const char* line : {"gain.out lag.in", "gain.out ->", "-> lag.in", "gain -> lag", "3",
                           "{gain.out: lag.in}", "gain.out -> lag.in -> lag.in", "[a]"}) {
    EXPECT_THAT(Refusal(Chain("gain.out -> lag.in", line)), HasSubstr("d.yaml:9:")) << line;
  }
  EXPECT_THAT(Refusal(Chain("connections:\n  - source.value -> gain.in\n  - gain.out -> lag.in\n",
                            "connections: {a: b}\n")),
              HasSubstr("connections: got a map; expected a list"));
}

TEST_F(LoaderSystemsTest, SizesThatDifferAreNamedWithBothSides) {
  EXPECT_THAT(Refusal(Chain("gain: 3", "gain: [1, 2, 3]")),
              AllOf(HasSubstr("d.yaml:8:5: error: "), HasSubstr("2"), HasSubstr("3"),
                    HasSubstr("gain.in"), HasSubstr("source.value")));
}

TEST_F(LoaderSystemsTest, UnitsThatDifferAreNamedWithBothSides) {
  const std::string text =
      "systems:\n"
      "  source: {type: Constant, value: [0, 0, 0, 0, 0, 0, 0], unit: m}\n"
      "  kinematics: {type: RobotKinematics, model: arm}\n"
      "connections: [source.value -> kinematics.position]\n";
  EXPECT_THAT(Refusal(kArm + text), AllOf(HasSubstr("d.yaml:5:15: error: "), HasSubstr("unit"),
                                          HasSubstr("rad"), HasSubstr(" m")));
}

TEST_F(LoaderSystemsTest, SixJointsAgainstSevenAreRefused) {
  const std::string text =
      "systems:\n"
      "  source: {type: Constant, value: [0, 0, 0, 0, 0, 0], unit: rad}\n"
      "  kinematics: {type: RobotKinematics, model: arm}\n"
      "connections: [source.value -> kinematics.position]\n";
  EXPECT_THAT(Refusal(kArm + text), AllOf(HasSubstr("size"), HasSubstr("6"), HasSubstr("7")));
}

TEST_F(LoaderSystemsTest, TypesThatDifferAreNamedWithBothSides) {
  const std::string text =
      "systems:\n"
      "  source: {type: ObstacleSource}\n"
      "  gain: {type: Gain, gain: 1}\n"
      "connections: [source.obstacles -> gain.in]\n";
  EXPECT_THAT(Refusal(text), AllOf(HasSubstr("d.yaml:4:15: error: "), HasSubstr("ObstacleSet"),
                                   HasSubstr("Vector")));
}

TEST_F(LoaderSystemsTest, TwoDriversOfOneInputAreRefused) {
  EXPECT_THAT(Refusal(Chain() + "  - source.value -> lag.in\n"),
              AllOf(HasSubstr("d.yaml:10:5: error: "), HasSubstr("lag.in")));
}

TEST_F(LoaderSystemsTest, AnUnconnectedInputIsNamed) {
  EXPECT_THAT(Refusal(Chain("  - source.value -> gain.in\n", "")),
              AllOf(HasSubstr("d.yaml:5:3: error: gain.in"), HasSubstr("not connected")));
}

TEST_F(LoaderSystemsTest, AnAlgebraicLoopIsShownAsAPath) {
  const std::string text =
      "systems:\n"
      "  a: {type: Gain, gain: 1}\n"
      "  b: {type: Gain, gain: 1}\n"
      "connections: [a.out -> b.in, b.out -> a.in]\n";
  EXPECT_THAT(Refusal(text),
              AllOf(HasSubstr("d.yaml:"), HasSubstr("algebraic loop"), HasSubstr("a.out"),
                    HasSubstr("b.in"), HasSubstr("b.out"), HasSubstr("a.in")));
}

TEST_F(LoaderSystemsTest, SystemsThatShareANameAreRefused) {
  EXPECT_THAT(Refusal(Chain("  gain:", "  source:")),
              HasSubstr("d.yaml:5:3: error: source: duplicate key; the first is at d.yaml:4:3"));
}

TEST_F(LoaderSystemsTest, NamesThatAreNoneAreRefused) {
  EXPECT_THAT(Refusal(Chain("  gain:", "  my gain:")),
              HasSubstr("d.yaml:5:3: error: systems.my gain"));
}

TEST_F(LoaderSystemsTest, ADiagramWithoutSystemsIsRefused) {
  EXPECT_THAT(Refusal("name: x\n"), HasSubstr("systems: missing; expected a map of named systems"));
  EXPECT_THAT(Refusal("systems: {}\n"), HasSubstr("systems: got none; expected at least one"));
  EXPECT_THAT(Refusal("systems: [1]\n"), HasSubstr("systems: got a list; expected a map"));
  EXPECT_THAT(Refusal("systems:\n"), HasSubstr("systems: no value"));
  EXPECT_THAT(Refusal("systems: {a: 3}\n"), HasSubstr("systems.a: got 3; expected a map"));
  EXPECT_THAT(Refusal("systems: {a: {gain: 3}}\n"), HasSubstr("systems.a.type: missing"));
  EXPECT_THAT(Refusal("systems: {a: {type: 3}}\n"), HasSubstr("systems.a.type: got 3"));
}

TEST_F(LoaderSystemsTest, APeriodOfZeroIsRefusedAndAFrequencyTaken) {
  const auto with = [&](const std::string& period) {
    return Chain("{type: Gain, gain: 3}", "{type: ZeroOrderHold, " + period + "}");
  };
  EXPECT_THAT(Refusal(with("period: 0")), HasSubstr("d.yaml:5:39: error: systems.gain.period"));
  EXPECT_THAT(Refusal(with("period: -0.01")), HasSubstr("systems.gain.period"));
  EXPECT_THAT(Refusal(with("frequency: 0")), HasSubstr("systems.gain.frequency: got 0 Hz"));
  EXPECT_THAT(Refusal(with("frequency: 100, period: 0.01")), HasSubstr("frequency"));
  EXPECT_EQ(Refusal(with("frequency: 60")), "");
  EXPECT_EQ(Refusal(with("period: \"${1 / 60}\"")), "");
}

TEST_F(LoaderSystemsTest, AnInitialPositionOfTheWrongLengthIsRefused) {
  const std::string text =
      "systems:\n"
      "  source: {type: Constant, value: [0, 0, 0], unit: rad/s}\n"
      "  plant: {type: IntegratorPlant, initial_position: [0, 0]}\n"
      "connections: [source.value -> plant.command]\n";
  EXPECT_THAT(Refusal(text), AllOf(HasSubstr("d.yaml:4:15: error: "), HasSubstr("size"),
                                   HasSubstr("2"), HasSubstr("3")));
}

TEST_F(LoaderSystemsTest, AListWithAnItemThatDoesNotExistIsNotMistakenForZero) {
  EXPECT_THAT(Refusal(Chain("value: [1, 2]", "value: [1, two]")),
              HasSubstr("systems.source.value[1]: got 'two'"));
  EXPECT_THAT(Refusal(Chain("value: [1, 2]", "value: []")), HasSubstr("systems.source.value"));
  EXPECT_THAT(Refusal(Chain("value: [1, 2]", "value: [.nan, 2]")), HasSubstr("got '.nan'"));
}

}  // namespace loader_systems_test
}  // namespace oca::loading
