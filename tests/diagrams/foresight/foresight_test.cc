// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/foresight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "oca/diagrams/loading/loader.h"
#include "oca/framework/dataflow/error.h"

namespace oca::foresight {
namespace foresight_test {

using testing::ElementsAre;
using testing::HasSubstr;

loading::LoadedDiagram Load(const std::string& file,
                            const std::vector<files::Override>& overrides) {
  return loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/" + file + ".yaml", overrides);
}

/// A file and what it says beforehand of a model in the first `duration` seconds.
struct Scene {
  explicit Scene(const std::string& file, const std::string& model = "", double duration = 2.0,
                 const std::vector<files::Override>& overrides = {})
      : loaded(Load(file, overrides)), foresight(*loaded.diagram, loaded.models, model, duration) {}

  std::size_t BodiesNamed(const std::string& start) const {
    return static_cast<std::size_t>(std::count_if(
        foresight.bodies().begin(), foresight.bodies().end(),
        [&](const auto& body) { return std::string(body.name.text()).starts_with(start); }));
  }

  const loading::LoadedDiagram loaded;
  const Foresight foresight;
};

std::string RefusalOf(const std::string& file, const std::string& model = "",
                      const std::vector<files::Override>& overrides = {}) {
  try {
    const Scene scene(file, model, 0.1, overrides);
  } catch (const ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "was accepted";
  return "";
}

TEST(ForesightTest, KnowsRequestStartAndTheCubeThatComes) {
  const Scene scene("scenarios/head_on");
  const Foresight& foresight = scene.foresight;
  EXPECT_EQ(foresight.model_name(), "arm");
  EXPECT_EQ(foresight.model(), scene.loaded.models.Get("arm"));
  EXPECT_EQ(foresight.judge(), "metrics");
  EXPECT_EQ(foresight.duration(), 2.0);
  EXPECT_EQ(foresight.start().size(), 7);
  EXPECT_TRUE(foresight.request().Evaluate(0.0, 0).isApprox(foresight.start(), 1e-12));
  ASSERT_EQ(foresight.bodies().size(), 1u);
  const planning::BandBody& cube = foresight.bodies()[0];
  EXPECT_EQ(cube.name, models::Name("cube"));
  EXPECT_FALSE(cube.stands);
  const Eigen::Vector3d way = cube.pose(1.5).translation() - cube.pose(1.0).translation();
  EXPECT_NEAR(way.norm(), 0.5, 1e-9);  // at 1 m/s
  EXPECT_TRUE(foresight.ignored().empty());
}

TEST(ForesightTest, SeesTheOtherArmAlongItsRequestButNotTheLowestPair) {
  const Scene scene("dual_arm", "right");
  const Foresight& foresight = scene.foresight;
  EXPECT_EQ(foresight.judge(), "right.metrics");
  EXPECT_THAT(foresight.sees(), ElementsAre("obstacles", "left as requested by left.spline"));
  EXPECT_FALSE(foresight.own_links());
  EXPECT_EQ(scene.BodiesNamed("left/"), foresight.bodies().size());
  EXPECT_GE(foresight.bodies().size(), 7u);
  ASSERT_FALSE(foresight.ignored().empty());
  const int lowest = foresight.model()->bodies().front();
  for (const auto& [link, body] : foresight.ignored()) {
    EXPECT_EQ(foresight.model()->body(link), lowest);
    const auto& name = foresight.bodies().at(static_cast<std::size_t>(body)).name;
    EXPECT_TRUE(name == models::Name("left/lwr4_base_link") ||
                name == models::Name("left/lwr4_link_1"))
        << name.text();
  }
}

TEST(ForesightTest, PutsLinksOfTheOtherArmWhereItsRequestTakesThem) {
  const Scene scene("dual_arm", "right", 7.0);
  const auto& bodies = scene.foresight.bodies();
  const auto hand = std::find_if(bodies.begin(), bodies.end(), [](const auto& body) {
    return body.name == models::Name("left/lwr4_link_6");
  });
  ASSERT_NE(hand, bodies.end());
  EXPECT_FALSE(hand->stands);
  EXPECT_EQ(hand->pose(0.0).matrix(), hand->pose(0.5).matrix());  // it starts at 0.5 s
  EXPECT_GT(hand->pose(0.5).translation().y(), hand->pose(6.0).translation().y() + 0.3);
}

TEST(ForesightTest, IgnoresPairsThatTheDistanceBlockIgnores) {
  const std::vector<files::Override> ignore{
      {"right.systems.distance.ignore", "[[lwr4_link_5, left/lwr4_link_6]]"}};
  const Scene all("dual_arm", "right", 0.1);
  const Scene less("dual_arm", "right", 0.1, ignore);
  const std::size_t solids = less.BodiesNamed("left/lwr4_link_6");
  ASSERT_GE(solids, 1u);
  EXPECT_EQ(less.foresight.ignored().size(), all.foresight.ignored().size() + solids);
  EXPECT_EQ(less.foresight.ignored().back().first, less.foresight.model()->FindLink("lwr4_link_5"));
}

TEST(ForesightTest, DisablesPairsOfOwnLinksThatTheDistanceBlockIgnores) {
  const std::string file = "scenarios/two_arms_crossing";
  const files::Override method{"parameters.avoidance", "safety_filter"};
  const Scene scene(file, "", 0.1, {method});
  EXPECT_TRUE(scene.foresight.own_links());
  EXPECT_THAT(scene.foresight.sees(), ElementsAre("obstacles", "own links"));
  const std::string model = scene.foresight.model_name();
  const auto& links = scene.foresight.model()->links();
  const std::string first(links[3].name.text());
  const std::string last(links[links.size() - 2].name.text());
  const Scene less(
      file, "", 0.1,
      {method, {"systems.distance.ignore", "[[" + first + ", " + model + "/" + last + "]]"}});
  EXPECT_EQ(less.foresight.model()->disabled_pairs().size(),
            scene.foresight.model()->disabled_pairs().size() + 1);
}

TEST(ForesightTest, IsATaskForAPlanner) {
  const Scene scene("scenarios/head_on");
  const planning::ClairvoyantTask task = scene.foresight.Task();
  EXPECT_EQ(task.duration, 2.0);
  EXPECT_EQ(task.request_end, scene.foresight.request().times().back());
  EXPECT_EQ(task.start, scene.foresight.start());
  EXPECT_EQ(task.bodies.data(), scene.foresight.bodies().data());
  EXPECT_EQ(task.self_collision, scene.foresight.own_links());
  Eigen::VectorXd q(7);
  task.request(1.0, 0, q);
  EXPECT_EQ(q, scene.foresight.request().Evaluate(1.0, 0));
}

TEST(ForesightTest, RefusesByNameWhatNobodyCanKnowBeforehand) {
  EXPECT_THAT(RefusalOf("scenarios/fault_latency", "", {{"parameters.judge", "distance"}}),
              HasSubstr("distance.obstacles: driver; got 'sensor', which depends on the run"));
  EXPECT_THAT(RefusalOf("attractive_goal"), HasSubstr("metrics.request: driver; got nothing"));
}

TEST(ForesightTest, RefusesAFileInWhichNotOneJudgeIsMeant) {
  EXPECT_THAT(RefusalOf("dual_arm"),
              HasSubstr("judge; got 'left' by left.metrics, 'right' by right.metrics; expected"));
  EXPECT_THAT(RefusalOf("dual_arm", "middle"),
              HasSubstr("judge; got none; expected one of the model 'middle'"));
}

}  // namespace foresight_test
}  // namespace oca::foresight
