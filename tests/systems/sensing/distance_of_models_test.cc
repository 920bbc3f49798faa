// SPDX-License-Identifier: BSD-3-Clause
// BulletDistance with other models beside its own: arms that move, and what stands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "tests/systems/sensing/distance_scene.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace distance_of_models_test {

using distance_scene::At;
using distance_scene::Ball;
using distance_scene::LinksAt;
using distance_scene::Pairs;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Params = BulletDistance::Params;

/// Two planar arms and a table; the second arm stands 0.3 m beside the first one.
class TwoArmsTest : public ::testing::Test {
 protected:
  TwoArmsTest() {
    models_.Add("left", LoadTestModel("planar2"));
    models_.Add("right", LoadTestModel("planar2", At(0.0, 0.3, 0.0)));
    models_.Add("table_frame", LoadTestModel("table_frame"));
  }
  LinkPoses RightArm(double rate) const {
    const auto model = models_.Get("right");
    LinkPoses links = LinksAt(*model, Eigen::Vector2d::Zero());
    links.velocities.resize(links.size());
    robot::LinkVelocities(*model, links.poses, Eigen::Vector2d(rate, 0.0), links.velocities);
    return links;
  }
  ProximitySet Near(const Params& params) {
    SystemBench<BulletDistance> bench(params, models_);
    bench->links.Fix(bench.context(), LinksAt(*models_.Get("left"), Eigen::Vector2d::Zero()));
    bench->obstacles.Fix(bench.context(), ObstacleSet{{Ball("ball", Vector3d(0.7, 0.4, 0.0))}});
    if (!bench->links_of_others.empty()) {
      bench->links_of_others[0].Fix(bench.context(), RightArm(rate_));
    }
    return bench->proximities.Eval(bench.context());
  }
  ModelSet models_;
  double rate_{0.0};  // of the right arm's first joint, rad/s
};

TEST_F(TwoArmsTest, LooksAtLinksOfOthersIfItIsAskedTo) {
  Params params{.model = "left",
                .ignore = {{"planar2_link_1", "ball"}, {"planar2_link_2", "ball"}},
                .others = {"right"}};
  EXPECT_FALSE(Near(params).compared);
  params.calculate_link_forces = true;
  EXPECT_TRUE(Near(params).compared);
}

TEST_F(TwoArmsTest, CarriesTheVelocityOfAnotherArmAtItsPoint) {
  rate_ = -2.0;
  const ProximitySet set = Near(
      {.model = "left", .max_distance = 0.5, .calculate_link_forces = true, .others = {"right"}});
  int moving = 0;
  for (const Proximity& p : set.proximities) {
    EXPECT_TRUE(p.own_link.empty());
    if (p.obstacle == models::Name("ball")) continue;
    // The right arm turns about (0, 0.3, 0).
    const Vector3d expected =
        Vector3d(0.0, 0.0, -2.0).cross(p.point_on_obstacle - Vector3d(0.0, 0.3, 0.0));
    EXPECT_NEAR((p.obstacle_velocity - expected).norm(), 0.0, 1e-12);
    EXPECT_GT(expected.norm(), 0.5);
    ++moving;
  }
  EXPECT_EQ(moving, 3);
}

TEST_F(TwoArmsTest, TellsWhoMeasuresOnHisOwnAllThatIsAroundAndWhatDoesNotCount) {
  for (const bool link_forces : {true, false}) {
    SystemBench<BulletDistance> bench(Params{.model = "left",
                                             .ignore = {{"planar2_link_2", "ball"}},
                                             .calculate_link_forces = link_forces,
                                             .others = {"right", "table_frame"}},
                                      models_);
    bench->obstacles.Fix(bench.context(), ObstacleSet{{Ball("ball", Vector3d(0.7, 0.4, 0.0))}});
    bench->links.Fix(bench.context(), LinksAt(*models_.Get("left"), Eigen::Vector2d::Zero()));
    bench->links_of_others[0].Fix(bench.context(), RightArm(-2.0));
    const std::vector<Obstacle>& around = bench->around.Eval(bench.context()).obstacles;
    ASSERT_FALSE(around.empty());
    EXPECT_EQ(around.front().body->id, models::Name("ball"));
    const auto& ignored = bench->ignored.Eval(bench.context()).pairs;
    EXPECT_EQ(ignored.front(), std::pair(models::Name("planar2_link_2"), models::Name("ball")));
    const bool lowest = std::find(ignored.begin(), ignored.end(),
                                  std::pair(models::Name("planar2_link_1"),
                                            models::Name("right/planar2_link_1"))) != ignored.end();
    EXPECT_EQ(lowest, link_forces);
    if (!link_forces) {
      EXPECT_EQ(around.size(), 1u);
      continue;
    }
    EXPECT_TRUE(Signal<ObstacleSet>::Check(bench->around.Eval(bench.context()), Look::kWhole).ok());
    int moving = 0, tables = 0;
    for (const Obstacle& one : around) {
      tables += one.body->id.text().starts_with("table_frame/") ? 1 : 0;
      if (one.body->id != models::Name("right/planar2_link_2")) continue;
      ++moving;
      // It begins 0.5 m along x from the foot about which it turns; see SeesTheOtherArm.
      EXPECT_NEAR((one.X_WO.translation() - Vector3d(0.5, 0.3, 0.0)).norm(), 0.0, 1e-12);
      EXPECT_NEAR((one.linear - Vector3d(0.0, -1.0, 0.0)).norm(), 0.0, 1e-12);
      EXPECT_NEAR((one.angular - Vector3d(0.0, 0.0, -2.0)).norm(), 0.0, 1e-12);
    }
    EXPECT_EQ(moving, 1);
    EXPECT_GT(tables, 0);
  }
}

TEST_F(TwoArmsTest, RefusesAMovingArmWhoseVelocitiesAreNotKnown) {
  SystemBench<BulletDistance> bench(
      Params{.model = "left", .calculate_link_forces = true, .others = {"right"}}, models_);
  bench->links.Fix(bench.context(), LinksAt(*models_.Get("left"), Eigen::Vector2d::Zero()));
  bench->obstacles.Fix(bench.context(), ObstacleSet{});
  bench->links_of_others[0].Fix(bench.context(),
                                LinksAt(*models_.Get("right"), Eigen::Vector2d::Zero()));
  try {
    bench->proximities.Eval(bench.context());
    FAIL() << "was taken as at rest";
  } catch (const SimulationError& error) {
    EXPECT_THAT(error.what(), HasSubstr("links_right: got poses without velocities"));
  }
}

TEST_F(TwoArmsTest, RefusesLinkForcesOfNobodyAndNamesTheModelsThereAre) {
  try {
    BulletDistance distance(Params{.model = "left", .calculate_link_forces = true}, models_);
    FAIL() << "was accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("without `others`"));
    EXPECT_THAT(error.what(), HasSubstr("right, table_frame"));
  }
  EXPECT_THROW(BulletDistance(Params{.calculate_link_forces = true}, TestModels("planar2")),
               ConfigError);
}

TEST_F(TwoArmsTest, SeesNoOtherModelUnlessLinkForcesAreAskedFor) {
  EXPECT_THAT(Pairs(Near({.model = "left",
                          .max_distance = 2.0,
                          .calculate_link_forces = false,
                          .others = {"right", "table_frame"}})),
              ElementsAre("planar2_link_1 ball", "planar2_link_2 ball"));
}

TEST_F(TwoArmsTest, SeesTheOtherArmButForTheLowestPair) {
  const ProximitySet set = Near(
      {.model = "left", .max_distance = 0.5, .calculate_link_forces = true, .others = {"right"}});
  EXPECT_THAT(Pairs(set), ElementsAre("planar2_link_1 ball", "planar2_link_1 right/planar2_link_2",
                                      "planar2_link_2 ball", "planar2_link_2 right/planar2_link_1",
                                      "planar2_link_2 right/planar2_link_2"));
  const Proximity& forearms = set.proximities.back();
  EXPECT_NEAR(forearms.distance, 0.2, 1e-12);
  EXPECT_NEAR((forearms.normal - Vector3d(0.0, -1.0, 0.0)).norm(), 0.0, 1e-12);
}

TEST_F(TwoArmsTest, SeesTheTableWhereItStands) {
  const ProximitySet set = Near({.model = "left",
                                 .max_distance = 1.0,
                                 .ignore = {{"planar2_link_2", "ball"}},
                                 .calculate_link_forces = true,
                                 .others = {"table_frame", "right"}});
  // The table's underside is at z = 0.7, the arm's upper side at 0.05.
  double to_table = 0.0;
  for (const Proximity& p : set.proximities) {
    if (p.obstacle == models::Name("table_frame/table") &&
        p.link == models::Name("planar2_link_2")) {
      to_table = p.distance;
    }
  }
  EXPECT_NEAR(to_table, 0.65, 1e-9);
  EXPECT_THAT(Pairs(set), ::testing::Not(::testing::Contains("planar2_link_2 ball")));
}

TEST_F(TwoArmsTest, SeesAsManyMovingArmsAsItNames) {
  for (int i = 3; i <= 9; ++i) {
    models_.Add("arm" + std::to_string(i), LoadTestModel("planar2", At(0.0, 0.3 * i, 0.0)));
  }
  Params params{.model = "left", .max_distance = 3.0, .calculate_link_forces = true};
  for (int i = 3; i <= 7; ++i) params.others.push_back("arm" + std::to_string(i));
  SystemBench<BulletDistance> bench(params, models_);
  bench->links.Fix(bench.context(), LinksAt(*models_.Get("left"), Eigen::Vector2d::Zero()));
  bench->obstacles.Fix(bench.context(), ObstacleSet{});
  ASSERT_EQ(bench->links_of_others.size(), 5u);
  for (int i = 3; i <= 7; ++i) {
    LinkPoses links = LinksAt(*models_.Get("arm" + std::to_string(i)), Eigen::Vector2d::Zero());
    links.velocities.assign(links.size(), {Vector3d(0.1 * i, 0, 0), Vector3d::Zero()});
    bench->links_of_others[i - 3].Fix(bench.context(), links);
  }
  const ProximitySet& set = bench->proximities.Eval(bench.context());
  int forearms = 0;
  for (const Proximity& p : set.proximities) {
    if (p.link != models::Name("planar2_link_2") ||
        !p.obstacle.text().ends_with("planar2_link_2")) {
      continue;
    }
    const int i = 3 + forearms++;
    EXPECT_EQ(p.obstacle.text(), "arm" + std::to_string(i) + "/planar2_link_2");
    EXPECT_NEAR(p.distance, 0.3 * i - 0.1, 1e-12);
    EXPECT_NEAR((p.obstacle_velocity - Vector3d(0.1 * i, 0, 0)).norm(), 0.0, 1e-12);
  }
  EXPECT_EQ(forearms, 5);
  params.others = {"arm3", "arm4", "arm5", "arm6", "arm7", "arm8", "arm9", "right"};
  EXPECT_EQ(SystemBench<BulletDistance>(params, models_)->links_of_others.size(), 8u);
  models_.Add("arm10", models_.Get("right"));
  params.others.push_back("arm10");
  EXPECT_THROW(BulletDistance(params, models_), ConfigError);
}

TEST_F(TwoArmsTest, RefusesToRunWithoutThePosesOfTheOtherArm) {
  DiagramBuilder builder;
  const auto& distance = builder.Add<BulletDistance>(
      "distance",
      Params{.model = "left", .calculate_link_forces = true, .others = {"right", "table_frame"}},
      models_);
  builder.ExportInput("links", distance.links);
  builder.ExportInput("obstacles", distance.obstacles);
  try {
    builder.Build();
    FAIL() << "was built";
  } catch (const WiringError& error) {
    EXPECT_THAT(error.what(), HasSubstr("distance.links_right"));
  }
}

}  // namespace distance_of_models_test
}  // namespace oca::systems
