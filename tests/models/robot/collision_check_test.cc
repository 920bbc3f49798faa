// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/collision_check.h"

#include <gmock/gmock.h>

#include "oca/models/error.h"
#include "oca/models/robot/srdf.h"
#include "oca/models/robot/urdf.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace collision_check_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

// A mast at the origin with a ball at (0, 0, 1); a slide along x that carries a ball at (1, 0, 1)
// and, beyond a second slide along y, a ball on the x axis at (x1 + 2, y, 1).
RobotModel Slides(double x_low, double x_high) {
  std::vector<Link> links(4);
  const char* names[] = {"mast", "near", "far", "plate"};
  const double at[] = {0.0, 1.0, 2.0, 1.05};
  for (int i = 0; i < 4; ++i) {
    links[i].name = models::Name(names[i]);
    CollisionElement ball;
    ball.X_LC.translation() = Eigen::Vector3d(at[i], 0.0, 1.0);
    ball.shape = geometry::Sphere{0.1};
    ball.source = names[i];
    links[i].collisions.push_back(ball);
  }
  std::vector<Joint> joints(3);
  const char* joint_names[] = {"x", "y", "bolt"};
  const int parents[] = {0, 1, 1};
  for (int j = 0; j < 3; ++j) {
    joints[j].name = models::Name(joint_names[j]);
    joints[j].type = j < 2 ? JointType::kPrismatic : JointType::kFixed;
    joints[j].axis = Eigen::Vector3d::Unit(j % 2);
    joints[j].parent_link = parents[j];
    joints[j].child_link = j + 1;
    joints[j].lower_limit = j == 0 ? x_low : -0.5;
    joints[j].upper_limit = j == 0 ? x_high : 0.5;
  }
  return {models::Name("slides"), std::move(links), std::move(joints)};
}

TEST(CollisionCheckTest, TellsAdjacentNeverAndSometimesByHand) {
  const auto pairs = CheckCollisions(Slides(-2.0, 1.0), {.samples = 1000});
  ASSERT_EQ(pairs.size(), 6u);
  const auto kind = [&](int a, int b) {
    for (const auto& pair : pairs) {
      if (pair.link_a == a && pair.link_b == b) return pair.kind;
    }
    return PairKind::kAlways;
  };
  EXPECT_EQ(kind(0, 1), PairKind::kAdjacent);
  EXPECT_EQ(kind(1, 2), PairKind::kAdjacent);
  EXPECT_EQ(kind(1, 3), PairKind::kAdjacent) << "bolted together";
  EXPECT_EQ(kind(0, 3), PairKind::kAdjacent) << "one joint between";
  EXPECT_EQ(kind(0, 2), PairKind::kSometimes);
  EXPECT_EQ(kind(2, 3), PairKind::kAdjacent);
}

TEST(CollisionCheckTest, FindsTheLeastDistanceAtTheLimits) {
  // At x = -1.5 the far ball stands at (0.5, y, 1): 0.5 m from the mast's, less two radii.
  const auto pairs = CheckCollisions(Slides(-1.5, 1.0), {.samples = 2000});
  EXPECT_EQ(pairs[1].kind, PairKind::kNever);
  EXPECT_NEAR(pairs[1].least_distance, 0.3, 1e-3);
  EXPECT_EQ(pairs[1].collisions, 0);
}

TEST(CollisionCheckTest, LooksAtAdjacentPairsAtEverySample) {
  // The first slide brings the near ball from 0.8 m before the mast's to 0.3 m before it.
  const auto pairs = CheckCollisions(Slides(-0.5, 1.0), {.samples = 2000});
  EXPECT_EQ(pairs[0].kind, PairKind::kAdjacent);
  EXPECT_NEAR(pairs[0].least_distance, 0.3, 1e-9);
  EXPECT_EQ(pairs[0].collisions, 0);
  const auto through = CheckCollisions(Slides(-1.5, 1.0), {.samples = 2000});
  EXPECT_EQ(through[0].kind, PairKind::kAdjacent);
  EXPECT_NEAR(through[0].least_distance, -0.2, 0.01);
  EXPECT_GT(through[0].collisions, 10);
}

TEST(CollisionCheckTest, LooksAtThePostureZeroFirst) {
  EXPECT_NEAR(CheckCollisions(Slides(-1.0, 1.0), {.samples = 1})[0].least_distance, 0.8, 1e-12);
  // As near to 0 as the limits allow.
  EXPECT_NEAR(CheckCollisions(Slides(0.25, 1.0), {.samples = 1})[0].least_distance, 1.05, 1e-12);
}

TEST(CollisionCheckTest, AMarginAboveTheLeastDistanceKeepsAPairChecked) {
  const double least = CheckCollisions(Slides(-1.5, 1.0), {.samples = 500})[1].least_distance;
  const auto kind = [&](double margin) {
    return CheckCollisions(Slides(-1.5, 1.0), {.samples = 500, .margin = margin})[1].kind;
  };
  EXPECT_EQ(kind(least - 1e-9), PairKind::kNever);
  EXPECT_EQ(kind(least), PairKind::kSometimes);
}

TEST(CollisionCheckTest, SolidsThatNeverPartAreAlwaysInCollision) {
  auto model = Slides(-2.001, -1.999);
  std::vector<Joint> joints = model.joints();
  joints[1].lower_limit = -0.01;
  joints[1].upper_limit = 0.01;
  model = RobotModel(models::Name("stuck"), model.links(), joints);
  const auto pairs = CheckCollisions(model, {.samples = 100});
  EXPECT_EQ(pairs[1].kind, PairKind::kAlways);
  EXPECT_EQ(pairs[1].collisions, 100);
}

/// The far ball 1 m before the mast's at 0, in contact with it from x = -1.2 to -0.8; the near one
/// far above.
RobotModel Passing(double low, double high) {
  const RobotModel model = Slides(low, high);
  std::vector<Link> links = model.links();
  links[1].collisions[0].X_LC.translation().z() = 5.0;
  links[2].collisions[0].X_LC.translation().x() = 1.0;
  std::vector<Joint> joints = model.joints();
  joints[1].lower_limit = -1e-3;
  joints[1].upper_limit = 1e-3;
  return RobotModel(models::Name("passing"), std::move(links), std::move(joints));
}

LinkPairCheck MastAndFar(double low, double high, int samples) {
  for (const auto& pair : CheckCollisions(Passing(low, high), {.samples = samples})) {
    if (pair.link_a == 0 && pair.link_b == 2) return pair;
  }
  return {};
}

TEST(CollisionCheckTest, WhatTheZeroPostureHasInContactIsByDesign) {
  // Limits that have -1.1, in contact, nearest to 0, and -0.7, clear of it.
  const LinkPairCheck touching = MastAndFar(-3.0, -1.1, 400);
  EXPECT_TRUE(touching.at_zero);
  EXPECT_GT(touching.collisions, 0);
  EXPECT_LT(touching.collisions, 380);
  EXPECT_EQ(touching.kind, PairKind::kDefault);
  const LinkPairCheck clear = MastAndFar(-3.0, -0.7, 400);
  EXPECT_FALSE(clear.at_zero);
  EXPECT_GT(clear.collisions, 0);
  EXPECT_EQ(clear.kind, PairKind::kSometimes);
}

// An eighth of the draws lies on either limit.
TEST(CollisionCheckTest, AlwaysMeansNearlyAlways) {
  const LinkPairCheck all = MastAndFar(-1.15, -0.85, 400);
  EXPECT_EQ(all.collisions, 400);
  EXPECT_EQ(all.kind, PairKind::kAlways);
  const LinkPairCheck most = MastAndFar(-1.21, -0.85, 400);
  EXPECT_LT(most.collisions, 380) << "an eighth stands at -1.21";
  EXPECT_EQ(most.kind, PairKind::kDefault);
}

TEST(CollisionCheckTest, ASeedGivesTheSameAnswerTwiceAndAnotherSeedAnotherOne) {
  const RobotModel model = LoadUrdf(ProductFile("robots/lwr4/lwr4.urdf"));
  const auto least = [&](std::uint64_t seed) {
    std::vector<double> distances;
    for (const auto& pair : CheckCollisions(model, {.samples = 50, .seed = seed})) {
      distances.push_back(pair.least_distance);
    }
    return distances;
  };
  EXPECT_EQ(least(7), least(7));
  EXPECT_NE(least(7), least(8));
}

// What stands in the product's files is what the sampling finds.
class ProductSrdfTest : public testing::TestWithParam<const char*> {};

TEST_P(ProductSrdfTest, IsWhatSamplingFinds) {
  LoadOptions options;
  const std::string path = std::string("robots/") + GetParam();
  options.srdf = ProductFile(path + ".srdf");
  const RobotModel model = LoadUrdf(ProductFile(path + ".urdf"), options);
  for (const auto& pair : CheckCollisions(model, {.samples = 3000, .seed = 99})) {
    // The one pair that a person disabled: see the file.
    if (model.links()[pair.link_b].name == models::Name("iiwa14_link_7") && pair.link_a == 5)
      continue;
    const bool disabled = model.collision_disabled(pair.link_a, pair.link_b);
    const std::string names =
        model.links()[pair.link_a].name.text() + " " + model.links()[pair.link_b].name.text();
    // A pair that never met here may have met in the many samples that the file was made from.
    const bool may_skip = pair.kind != PairKind::kSometimes;
    EXPECT_TRUE(!disabled || may_skip) << names;
    EXPECT_TRUE(disabled || pair.kind == PairKind::kSometimes || pair.kind == PairKind::kNever)
        << names;
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, ProductSrdfTest,
                         testing::Values("iiwa14/iiwa14", "lwr4/lwr4", "lwr4_dual/lwr4_dual",
                                         "planar2/planar2", "planar3/planar3", "ur5e/ur5e"),
                         [](const auto& test) {
                           const std::string name = test.param;
                           return name.substr(name.find('/') + 1);
                         });

/// So many links, one behind the other, each with a ball.
RobotModel Chain(int count) {
  std::vector<Link> links(static_cast<std::size_t>(count));
  std::vector<Joint> joints(links.size() - 1);
  for (std::size_t i = 0; i < links.size(); ++i) {
    links[i].name = models::Name("link" + std::to_string(i));
    CollisionElement ball;
    ball.shape = geometry::Sphere{0.1};
    ball.source = links[i].name.text();
    links[i].collisions.push_back(ball);
    if (i == 0) continue;
    Joint& joint = joints[i - 1];
    joint.name = models::Name("joint" + std::to_string(i));
    joint.X_PJ.translation().z() = 0.3;
    joint.parent_link = static_cast<int>(i) - 1;
    joint.child_link = static_cast<int>(i);
    joint.lower_limit = -1.0;
    joint.upper_limit = 1.0;
  }
  return {models::Name("chain"), std::move(links), std::move(joints)};
}

TEST(CollisionCheckTest, LooksAtHundredsOfLinksAndRefusesMore) {
  EXPECT_EQ(CheckCollisions(Chain(500), {.samples = 2}).size(), 500u * 499u / 2u);
  EXPECT_THAT([] { CheckCollisions(Chain(501), {.samples = 2}); },
              ThrowsMessage<models::ModelError>(
                  HasSubstr("robot 'chain': links with solids, each pair of which is looked at; "
                            "got 501; expected at most 500")));
}

TEST(CollisionCheckTest, RefusesWhatCannotBeSampled) {
  EXPECT_THAT([] { CheckCollisions(Slides(-1, 1), {.samples = 0}); },
              ThrowsMessage<models::ModelError>(HasSubstr("samples")));
  EXPECT_THAT([] { CheckCollisions(Slides(-1, 1), {.margin = -0.01}); },
              ThrowsMessage<models::ModelError>(HasSubstr("margin")));
  EXPECT_THAT([] { CheckCollisions(Slides(-1, kUnlimited), {}); },
              ThrowsMessage<models::ModelError>(HasSubstr("joint 'x': limits")));
  EXPECT_THAT(
      [] { CheckCollisions(Slides(-1e9, 1e9), {}); },
      ThrowsMessage<models::ModelError>(HasSubstr("joint 'x': limits; got [-1e+09, 1e+09]")));
  EXPECT_THAT([] { CheckCollisions(Slides(-1e308, 1e308), {}); },
              ThrowsMessage<models::ModelError>(HasSubstr("joint 'x': limits")));
  auto joints = Slides(-1, 1).joints();
  joints[2].X_PJ.translation().x() = 1e308;
  const RobotModel far(models::Name("far"), Slides(-1, 1).links(), joints);
  EXPECT_THAT([&] { CheckCollisions(far, {.samples = 2}); },
              ThrowsMessage<models::ModelError>(HasSubstr("links 'mast' and 'plate': distance")));
}

}  // namespace collision_check_test
}  // namespace oca::robot::test
