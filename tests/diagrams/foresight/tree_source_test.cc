// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/tree_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "oca/diagrams/foresight/motion_ahead.h"
#include "oca/diagrams/foresight/obstacles_ahead.h"
#include "oca/systems/sensing/obstacle_source.h"
#include "tests/diagrams/files/yaml_text.h"

namespace oca::foresight {
namespace tree_source_test {

using testing::HasSubstr;

constexpr const char* kTree = R"(
systems:
  spline:
    type: SplineGenerator
    period: 0.1
    key_points: [{time: 0, position: [0, 0]}, {time: 1, position: [2, 0]}]
  obstacles:
    type: ObstacleSource
    period: 0.1
    obstacles:
      - id: ball
        shape: {type: sphere, radius: 0.1}
        pose: {xyz: [0, 0, 0]}
        motion: {type: linear, velocity: [1, 0, 0]}
  gain: {type: Gain, gain: 2}
  wrong: {type: SplineGenerator, key_points: []}
  no_type: {gain: 2}
  no_map: 3
)";

/// A system of the tree alone, and what was wrong.
struct Alone {
  explicit Alone(const std::string& name) {
    const files::YamlText text(kTree);
    EXPECT_EQ(text.problems, "");
    source = MakeTreeSource(text.value, name, {}, files::Catalogue::Standard(), problems);
  }
  std::string Problem() const {
    return problems.empty() ? "none" : problems.all().front().ToString();
  }

  Problems problems;
  std::unique_ptr<Diagram> source;
};

TEST(TreeSourceTest, IsAFunctionOfTimeThoughTheFileSamplesIt) {
  const Alone spline("spline");
  ASSERT_NE(spline.source, nullptr) << spline.Problem();
  const auto request = PositionsAheadOf(
      *spline.source, spline.source->FindOutput("spline.position"), Samples::kBetween, "here");
  EXPECT_FALSE(request.requested);
  EXPECT_DOUBLE_EQ(request.at(0.25)[0], 2.0 * 0.25 * 0.25 * (3.0 - 2.0 * 0.25));
  const Alone obstacles("obstacles");
  ASSERT_NE(obstacles.source, nullptr) << obstacles.Problem();
  const std::shared_ptr<const Diagram> shared(std::shared_ptr<void>(), obstacles.source.get());
  ObstaclesAhead ahead(shared, shared->FindOutput("obstacles.obstacles"), "here");
  EXPECT_DOUBLE_EQ(ahead.At(0.25).obstacles.at(0).X_WO.translation().x(), 0.25);
}

TEST(TreeSourceTest, IsNoneForWhatIsNotThereOrNotToBeMadeAlone) {
  const std::pair<const char*, const char*> refused[] = {
      {"splin", "no 'splin' in systems; did you mean 'spline'"},
      {"no_map", "no 'no_map' in systems"},
      {"no_type", "systems.no_type.type: missing; expected the name of a system type"},
      {"wrong", "systems.wrong: key_points: empty"},
      {"gain", "systems.gain: "},
  };
  for (const auto& [name, problem] : refused) {
    const Alone alone(name);
    EXPECT_EQ(alone.source, nullptr) << name;
    EXPECT_THAT(alone.Problem(), HasSubstr(problem));
  }
}

/// The parameters after they were told.
Value Told(const std::string& params) {
  const files::YamlText tree(kTree);
  files::YamlText text(params);
  EXPECT_EQ(text.problems, "");
  TellGoal(*files::At(tree.value, "systems").map(), files::Catalogue::Standard(),
           *text.value.map());
  return text.value;
}

TEST(TreeSourceTest, TellsAGoalWithAClearanceTheObstaclesOfTheFile) {
  const Value around = files::At(Told("goal: {clearance: 0.1}"), "goal", "around");
  ASSERT_NE(around.list(), nullptr);
  ASSERT_EQ(around.list()->size(), 1u);
  const Value& source = around.list()->front();
  EXPECT_EQ(source.Find("type"), nullptr);
  EXPECT_NE(source.Find("period"), nullptr);
  EXPECT_EQ(*files::At(source.Find("obstacles")->list()->front(), "id").string(), "ball");
}

TEST(TreeSourceTest, TellsItTheObstaclesOfOtherTypesWithTheSameParameters) {
  const files::YamlText tree(
      "systems: {lidar: {type: Lidar, obstacles: [{id: box}]}, gain: {type: Gain, gain: 2}}\n");
  auto catalogue = files::Catalogue::Standard();
  using Params = systems::ObstacleSource::Params;
  catalogue.Add<Params>(
      "Lidar", systems::ObstacleSource::kDoc, systems::ObstacleSource::Example(),
      [](const Params& params) { return std::make_unique<systems::ObstacleSource>(params); });
  files::YamlText text("goal: {clearance: 0.1}");
  TellGoal(*files::At(tree.value, "systems").map(), catalogue, *text.value.map());
  const Value around = files::At(text.value, "goal", "around");
  ASSERT_NE(around.list(), nullptr);
  ASSERT_EQ(around.list()->size(), 1u);
  EXPECT_EQ(*files::At(around.list()->front().Find("obstacles")->list()->front(), "id").string(),
            "box");
}

TEST(TreeSourceTest, TellsNothingToAGoalThatNamesThemOrWithoutClearance) {
  EXPECT_TRUE(
      files::At(Told("goal: {clearance: 0.1, around: []}"), "goal", "around").list()->empty());
  EXPECT_TRUE(files::At(Told("goal: {time: 1}"), "goal", "around").null());
  EXPECT_TRUE(files::At(Told("gain: {clearance: 0.1}"), "gain", "around").null());
}

}  // namespace tree_source_test
}  // namespace oca::foresight
