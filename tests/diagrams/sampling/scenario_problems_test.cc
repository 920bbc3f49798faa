// SPDX-License-Identifier: BSD-3-Clause
// What a file gets wrong about scenarios.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/error.h"
#include "tests/temporary_folder.h"

namespace oca::sampling {
namespace scenario_problems_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kFile = R"(name: small
description: d
parameters: {x: 0.0}
simulator: {duration: 1, seed: 1}
models:
  arm: {urdf: package://planar2/planar2.urdf, srdf: package://planar2/planar2.srdf}
systems:
  obstacles:
    type: ObstacleSource
    obstacles:
      - {id: ball, shape: {type: sphere, radius: 0.1}, pose: {xyz: ["${x}", 0.5, 0]}}
  spline:
    type: SplineGenerator
    key_points: [{time: 0, position: [0, 0]}, {time: 1, position: [1.5, 0]}]
)";

std::string ErrorOf(const std::string& sampling) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "small.yaml";
  std::ofstream(file) << kFile << sampling;
  try {
    loading::LoadDiagram(file);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(ScenarioProblemsTest, OfASmallFileLoads) {
  EXPECT_EQ(ErrorOf("sampling: {draw: {x: {uniform: [0.6, 0.7]}}}\n"), "none");
}

TEST(ScenarioProblemsTest, SaysWhatRefusedAScenarioThatCannotBe) {
  const std::string error = ErrorOf(
      "sampling:\n  draw: {x: {uniform: [0.6, 0.7]}}\n  tries: 20\n"
      "  accept: {home_distance: {at_least: 50}}\n");
  EXPECT_THAT(error, HasSubstr(".yaml:18:11: error: sampling.accept: no scenario of seed 1 in 20 "
                               "tries; refused: home_distance 20; expected"));
}

TEST(ScenarioProblemsTest, TellsWhereAMistakeStands) {
  EXPECT_THAT(ErrorOf("sampling: {draww: {}}\n"),
              HasSubstr(".yaml:15:12: error: sampling.draww: unknown key; did you mean 'draw'?"));
  EXPECT_THAT(ErrorOf("sampling: {draw: {y: {uniform: [0, 1]}}}\n"),
              HasSubstr(".yaml:15:19: error: sampling.draw.y: no parameter 'y'"));
  EXPECT_THAT(ErrorOf("sampling: {draw: {x: {uniform: [1, 0]}}}\n"),
              HasSubstr("sampling.draw.x.uniform: got [1, 0]; expected two numbers, the lower one "
                        "first"));
  EXPECT_THAT(ErrorOf("sampling: {draw: {x: {uniform: [0, 1], choose: [1]}}}\n"),
              HasSubstr("sampling.draw.x: got 2 of uniform, integers and choose; expected one"));
  EXPECT_THAT(ErrorOf("sampling: {draw: {x: {integers: [0.5, 1]}}}\n"),
              HasSubstr("expected whole numbers"));
  EXPECT_THAT(
      ErrorOf("sampling: {accept: {home_distanse: {at_least: 1}}}\n"),
      HasSubstr("sampling.accept.home_distanse: unknown key; did you mean 'home_distance'"));
  EXPECT_THAT(ErrorOf("sampling: {accept: {request: splin}}\n"),
              HasSubstr("did you mean 'spline'"));
  EXPECT_THAT(ErrorOf("sampling: {tries: 0}\n"), HasSubstr("sampling.tries: got 0; expected"));
  EXPECT_THAT(ErrorOf("sampling: [1]\n"), HasSubstr("sampling: got a list; expected a map"));
  EXPECT_THAT(
      ErrorOf("sampling: {obstacles: {count: [1, 2], shapes: [box], extent: [0.1, 0.2]}}\n"),
      HasSubstr("expected either shell or approach"));
  const auto approach = [](const std::string& more) {
    return ErrorOf(
        "sampling: {obstacles: {count: [1, 2], shapes: [box], extent: [0.1, 0.2], approach: "
        "{speed: [1, 2], distance: [1, 2], start: [0, 1]" +
        more + "}}}\n");
  };
  EXPECT_THAT(approach(", manner: turning"),
              HasSubstr("approach.bend: got none; expected one with manner turning alone"));
  EXPECT_THAT(approach(", sight: [0, 1]"),
              HasSubstr("approach.sight: got one; expected one with manner behind alone"));
  EXPECT_THAT(approach(", manner: turn"), HasSubstr("manner"));
}

}  // namespace scenario_problems_test
}  // namespace oca::sampling
