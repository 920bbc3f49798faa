// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/near_obstacles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/sensing/model_links.h"
#include "tests/allocation_count.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace near_obstacles_test {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::shared_ptr<const ObstacleBody> Body(int number, double radius) {
  ShapeParams shape;
  if (number % 2 == 0) {
    shape.radius = radius;
  } else {
    shape.type = ShapeType::kBox;
    shape.size = Vector3d(radius, 2.0 * radius, radius);
  }
  const std::string id = "body" + std::to_string(number);
  return MakeObstacleBody(id, shape, id);
}

/// Bodies that a seed strews around an arm.
class Strewn {
 public:
  Strewn(unsigned seed, int count) : random_(seed) {
    for (int i = 0; i < count; ++i) {
      set.obstacles.emplace_back();
      set.obstacles.back().body = Body(i, 0.02 + 0.001 * (i % 50));
      Throw(i);
    }
  }
  void Throw(int i) {
    Obstacle& obstacle = set.obstacles[static_cast<std::size_t>(i)];
    obstacle.X_WO.translation() = Point();
    obstacle.X_WO.linear() =
        Eigen::AngleAxisd(Uniform(0.0, 3.0), Point().normalized()).toRotationMatrix();
  }
  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  int Index() { return static_cast<int>(random_() % set.obstacles.size()); }
  Vector3d Point() { return {Uniform(-1.5, 1.5), Uniform(-1.5, 1.5), Uniform(-1.5, 1.5)}; }

  ObstacleSet set;

 private:
  std::mt19937_64 random_;
};

std::vector<int> Near(const ObstacleScene& scene, const Vector3d& point, double reach) {
  NearObstacles near;
  near.Clear(1, static_cast<std::size_t>(scene.balls().size()));
  near.Add(scene.balls(), point, reach);
  return {near.of(0).begin(), near.of(0).end()};
}

Obstacle BallAt(double x) {
  Obstacle obstacle;
  obstacle.body = Body(0, 0.1);
  obstacle.X_WO.translation().x() = x;
  return obstacle;
}

TEST(ObstacleSceneTest, FollowsBodiesThatMoveComeAndGo) {
  ObstacleScene scene;
  ObstacleSet set{{BallAt(1.0), BallAt(5.0)}};
  scene.Follow(set);
  EXPECT_THAT(Near(scene, Vector3d::Zero(), 1.0), ElementsAre(0));
  set.obstacles[1].X_WO.translation().x() = -1.0;
  scene.Follow(set);
  EXPECT_THAT(Near(scene, Vector3d::Zero(), 1.0), ElementsAre(0, 1));
  set.obstacles.erase(set.obstacles.begin());
  scene.Follow(set);
  EXPECT_THAT(Near(scene, Vector3d::Zero(), 1.0), ElementsAre(0));
  set.obstacles.clear();
  scene.Follow(set);
  EXPECT_THAT(Near(scene, Vector3d::Zero(), 1.0), IsEmpty());
}

TEST(ObstacleSceneTest, LooksOnlyAtWhatMovesWhileTheLayoutStays) {
  ObstacleScene scene;
  ObstacleSet set{{BallAt(1.0), BallAt(5.0)}, 7, {1}};
  scene.Follow(set);
  set.obstacles[0].X_WO.translation().x() = 5.0;  // against the promise: not looked at
  set.obstacles[1].X_WO.translation().x() = -1.0;
  scene.Follow(set);
  EXPECT_THAT(Near(scene, Vector3d::Zero(), 1.0), ElementsAre(0, 1));
  set.layout = 8;
  scene.Follow(set);
  EXPECT_THAT(Near(scene, Vector3d::Zero(), 1.0), ElementsAre(1));
}

TEST(ObstacleSceneTest, BoundsTheSpeedOfWhatIsFastest) {
  ObstacleSet set{{BallAt(1.0), BallAt(2.0)}};
  set.obstacles[0].linear = Vector3d(0.0, 0.3, 0.0);
  set.obstacles[1].angular = Vector3d(0.0, 0.0, 5.0);  // its rim: 5 rad/s x 0.1 m
  ObstacleScene scene;
  scene.Follow(set);
  EXPECT_NEAR(scene.fastest(), 0.5, 1e-15);
}

/// The arm among strewn bodies, beside a plain look at every pair.
class NearAnArmTest : public ::testing::Test {
 protected:
  static constexpr double kMaxDistance = 0.3;
  NearAnArmTest()
      : model_(LoadTestModel("lwr4")),
        colliders_(MakeLinkColliders(*model_)),
        bench_(BulletDistance::Params{.max_distance = kMaxDistance}, TestModels("lwr4")) {
    std::erase_if(colliders_, [&](const auto& link) { return model_->body(link.number) < 0; });
    NameLinks(*model_, links_);
  }
  void MoveArm(double t) {
    Eigen::Matrix<double, 7, 1> q;
    for (int i = 0; i < 7; ++i) q[i] = 1.5 * std::sin(0.7 * t + i);
    robot::ForwardKinematics(*model_, q, links_.poses);
  }
  const ProximitySet& Eval(const ObstacleSet& set) {
    bench_->links.Fix(bench_.context(), links_);
    bench_->obstacles.Fix(bench_.context(), set);
    return bench_->proximities.Eval(bench_.context());
  }
  /// Number of near pairs, all of which are found with the same bits; -1 if they are not.
  int CountIfSame(const ObstacleSet& set, const ProximitySet& found) const {
    std::size_t at = 0;
    for (const LinkCollider& link : colliders_) {
      for (const Obstacle& obstacle : set.obstacles) {
        const auto plain = DistanceToBody(link, links_.poses[static_cast<std::size_t>(link.number)],
                                          *obstacle.body->collider, obstacle.X_WO, kMaxDistance);
        if (plain.status == geometry::DistanceStatus::kBeyond) continue;
        if (at == found.proximities.size()) return -1;
        const Proximity& p = found.proximities[at++];
        if (!(p.link == link.link && p.obstacle == obstacle.body->id &&
              p.distance == plain.distance && p.normal == plain.normal &&
              p.point_on_link == plain.point_a && p.point_on_obstacle == plain.point_b)) {
          return -1;
        }
      }
    }
    return at == found.proximities.size() ? static_cast<int>(at) : -1;
  }
  std::shared_ptr<const robot::RobotModel> model_;
  std::vector<LinkCollider> colliders_;
  SystemBench<BulletDistance> bench_;
  LinkPoses links_;
};

TEST_F(NearAnArmTest, EqualsALookAtEveryPairBitByBitOver10000Ticks) {
  Strewn strewn(17, 100);
  int total = 0;
  for (int tick = 0; tick < 10'000; ++tick) {
    MoveArm(0.01 * tick);
    if (tick % 3 == 0) strewn.Throw(strewn.Index());
    const int found = CountIfSame(strewn.set, Eval(strewn.set));
    ASSERT_GE(found, 0) << "tick " << tick;
    total += found;
  }
  EXPECT_GT(total, 10'000);
}

TEST_F(NearAnArmTest, IsNotMisledByAHundredThousandFarBodies) {
  Strewn strewn(3, 50);
  MoveArm(0.0);
  const ProximitySet alone = Eval(strewn.set);
  for (int i = 0; i < 100'000; ++i) {
    Obstacle& obstacle = strewn.set.obstacles.emplace_back();
    obstacle.body = Body(50 + i, 0.1);
    obstacle.X_WO.translation() = strewn.Point() + 10.0 * Vector3d(1 + i % 7, i % 11, i % 13);
  }
  const ProximitySet& found = Eval(strewn.set);
  ASSERT_GE(alone.proximities.size(), 5u);
  ASSERT_EQ(found.proximities.size(), alone.proximities.size());
  for (std::size_t i = 0; i < alone.proximities.size(); ++i) {
    EXPECT_EQ(found.proximities[i].distance, alone.proximities[i].distance);
    EXPECT_EQ(found.proximities[i].obstacle, alone.proximities[i].obstacle);
  }
}

TEST_F(NearAnArmTest, TakesNothingFromTheHeapWhileBodiesMove) {
  if (!kCountsAllocations) GTEST_SKIP() << "allocations are not counted in this build";
  Strewn strewn(5, 200);
  MoveArm(0.0);
  Eval(strewn.set);
  const auto before = AllocationCount();
  for (int tick = 1; tick < 300; ++tick) {
    MoveArm(0.01 * tick);
    strewn.Throw(strewn.Index());
    Eval(strewn.set);
  }
  EXPECT_EQ(AllocationCount() - before, 0);
}

}  // namespace near_obstacles_test
}  // namespace oca::systems
