// SPDX-License-Identifier: BSD-3-Clause
// BulletDistance between the links of its own arm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <utility>

#include "oca/models/robot/jacobian_mapping.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "tests/systems/sensing/distance_scene.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace self_distance_test {

using distance_scene::Ball;
using distance_scene::LinksAt;
using distance_scene::Pairs;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using Params = BulletDistance::Params;

TEST(SelfDistanceTest, SeesTheArmItselfIfAskedTo) {
  const ModelSet models = TestModels("planar3");
  const auto model = models.Get("planar3");
  // Folded: link 3 comes back beside link 1.
  const LinkPoses links = LinksAt(*model, Vector3d(0.0, 1.5, 1.5));
  for (const bool self : {false, true}) {
    SystemBench<BulletDistance> bench(
        Params{.model = "planar3", .max_distance = 1.0, .self_collision = self}, models);
    bench->links.Fix(bench.context(), links);
    bench->obstacles.Fix(bench.context(), ObstacleSet{});
    const ProximitySet& set = bench->proximities.Eval(bench.context());
    if (!self) {
      EXPECT_TRUE(set.proximities.empty());
      continue;
    }
    ASSERT_THAT(Pairs(set), ElementsAre("planar3_link_1 planar3/planar3_link_3",
                                        "planar3_link_3 planar3/planar3_link_1"));
    EXPECT_EQ(set.proximities[0].own_link, models::Name("planar3_link_3"));
    EXPECT_EQ(set.proximities[1].own_link, models::Name("planar3_link_1"));
  }
}

TEST(SelfDistanceTest, ListsEveryPairOfTheArmFromBothSidesAsMirrors) {
  const ModelSet models = TestModels("lwr4");
  const auto model = models.Get("lwr4");
  SystemBench<BulletDistance> bench(Params{.max_distance = 0.4, .self_collision = true}, models);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int mirrored = 0, fixed = 0;
  for (int k = 0; k < 200; ++k) {
    Eigen::VectorXd q(7);
    for (int j = 0; j < 7; ++j) q[j] = (2.0 * unit(random) - 1.0) * model->upper_limits()[j];
    bench->links.Fix(bench.context(), LinksAt(*model, q));
    bench->obstacles.Fix(bench.context(), ObstacleSet{{Ball("ball", Vector3d(0.3, 0.0, 0.6))}});
    const ProximitySet& set = bench->proximities.Eval(bench.context());
    std::vector<std::pair<int, int>> order;
    for (const Proximity& p : set.proximities) {
      const int link = model->FindLink(p.link.text());
      const int other = p.own_link.empty() ? -1 : model->FindLink(p.own_link.text());
      order.emplace_back(link, other);
      if (other < 0) continue;
      EXPECT_EQ(p.obstacle.text(), "lwr4/" + p.own_link.text());
      const auto twin = std::find_if(
          set.proximities.begin(), set.proximities.end(),
          [&](const Proximity& t) { return t.link == p.own_link && t.own_link == p.link; });
      if (model->body(other) < 0) {
        ++fixed;
        EXPECT_EQ(twin, set.proximities.end()) << "the base cannot move";
        continue;
      }
      ASSERT_NE(twin, set.proximities.end()) << p.link.text() << " " << p.own_link.text();
      EXPECT_EQ(p.distance, twin->distance);
      EXPECT_EQ(p.point_on_link, twin->point_on_obstacle);
      EXPECT_EQ(p.normal, -twin->normal);
      ++mirrored;
    }
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  }
  EXPECT_GT(mirrored, 100);
  EXPECT_GT(fixed, 20);
}

// Link 3 folds beside link 1, nearest at the end.
TEST(SelfDistanceTest, AsksOfOwnLinksWhatSelfDistanceAndTheRequestLeave) {
  const ModelSet models = TestModels("planar3");
  const auto model = models.Get("planar3");
  const Vector3d folded(0.0, 1.5, 2.0);
  const auto ask = [&](double self_distance, bool ahead) {
    auto owned = std::make_unique<BulletDistance>(Params{.model = "planar3",
                                                         .max_distance = 1.0,
                                                         .self_collision = true,
                                                         .self_distance = self_distance},
                                                  models);
    const BulletDistance& distance = *owned;
    const auto diagram = MakeDiagramOf(std::move(owned), {{"ahead", -1}});
    Simulator simulator(*diagram);
    Context& context = simulator.context();
    distance.links.Fix(context, LinksAt(*model, folded));
    distance.obstacles.Fix(context, ObstacleSet{});
    RequestAhead request;
    if (ahead) {
      request.trajectory = std::make_shared<const motion::Trajectory>(motion::Trajectory::Linear(
          {{.time = 0.0, .position = Vector3d::Zero()}, {.time = 1.0, .position = folded}}));
    }
    diagram->GetInput<RequestAhead>("ahead").Fix(context, request);
    const ProximitySet set = distance.proximities.Eval(context);
    EXPECT_EQ(set.proximities.size(), 2u);
    EXPECT_EQ(set.proximities[0].range, set.proximities[1].range) << "from either side";
    return set.proximities.at(0);
  };
  const double distance = ask(1.0, true).distance;
  ASSERT_GT(distance, 0.03);
  EXPECT_NEAR(ask(1.0, true).range, distance / 3.0, 1e-9);
  EXPECT_EQ(ask(0.5 * distance / 3.0, true).range, 0.5 * distance / 3.0);
  EXPECT_EQ(ask(1.0, false).range, 1.0);
  EXPECT_EQ(ask(0.0, true).range, robot::kUnlimited) << "as of obstacles";
}

TEST(SelfDistanceTest, APairOfTheArmIgnoredFromOneSideIsIgnoredFromBoth) {
  const ModelSet models = TestModels("planar3");
  SystemBench<BulletDistance> bench(Params{.max_distance = 1.0,
                                           .ignore = {{"planar3_link_3", "planar3/planar3_link_1"}},
                                           .self_collision = true},
                                    models);
  bench->links.Fix(bench.context(), LinksAt(*models.Get("planar3"), Vector3d(0.0, 1.5, 1.5)));
  bench->obstacles.Fix(bench.context(), ObstacleSet{});
  EXPECT_TRUE(bench->proximities.Eval(bench.context()).proximities.empty());
}

// Found from either side, a pair pushes with n^T (J_A - J_B): the joints before both do nothing.
TEST(SelfDistanceTest, AForceBetweenTwoLinksOfTheArmPushesBoth) {
  const ModelSet models = TestModels("planar3");
  const auto model = models.Get("planar3");
  const LinkPoses links = LinksAt(*model, Vector3d(0.7, 1.5, 1.9));
  SystemBench<BulletDistance> bench(
      Params{.model = "planar3", .max_distance = 1.0, .self_collision = true}, models);
  bench->links.Fix(bench.context(), links);
  bench->obstacles.Fix(bench.context(), ObstacleSet{});
  const ProximitySet& set = bench->proximities.Eval(bench.context());
  ASSERT_EQ(set.proximities.size(), 2u);
  std::vector<robot::BodyWrench> wrenches(model->bodies().size());
  for (const Proximity& p : set.proximities) {
    const int link = model->FindLink(p.link.text());
    const Vector3d force = 5.0 * p.normal;
    const Vector3d lever = p.point_on_link - links.poses[link].translation();
    wrenches[model->body_index(link)].force += force;
    wrenches[model->body_index(link)].torque += lever.cross(force);
  }
  robot::MappingWorkspace workspace(*model);
  Eigen::VectorXd push(3), row(3);
  robot::MultiplyTransposed(*model, links.poses, wrenches, workspace, push);
  const Proximity& p = set.proximities[0];
  robot::DistanceRow(*model, links.poses, model->FindLink(p.link.text()), p.point_on_link,
                     model->FindLink(p.own_link.text()), p.point_on_obstacle, p.normal, row);
  EXPECT_NEAR((push - 5.0 * row).norm(), 0.0, 1e-9);
  EXPECT_EQ(row[0], 0.0);
  EXPECT_GT(row.norm(), 0.1);
}

}  // namespace self_distance_test
}  // namespace oca::systems
