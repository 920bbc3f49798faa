// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/barrier_filter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "tests/allocation_count.h"

namespace oca::robot {
namespace barrier_filter_test {

constexpr double kDt = 0.01;

BarrierSettings Settings() {
  return {.period = kDt,
          .safe_distance = 0.05,
          .form = BarrierSettings::Form::kLinear,
          .approach_gain = 5.0,
          .deceleration = 2.0,
          .position_gain = 5.0,
          .weights = Eigen::Vector2d::Ones(),
          .progress_weight = 0.0,
          .slack_penalty = 1e4,
          .trust_time = 0.0,
          .recovery_gain = 5.0,
          .recovery_speed = 0.5,
          .recovery_penalty = 10.0,
          .most_rows = 10};
}

/// planar2 at rest, stretched along x; its tip is at (0.9, 0, 0), its joints at 0 and 0.5.
class BarrierFilterTest : public testing::Test {
 protected:
  BarrierFilterTest()
      : model_(std::make_shared<const RobotModel>(
            LoadUrdf(OCA_SOURCE_DIR "/models/robots/planar2/planar2.urdf"))),
        X_WL_(LinkPoses(*model_, Eigen::Vector2d::Zero())) {
    result_.command = result_.last_velocity = Eigen::Vector2d::Zero();
  }
  /// An obstacle at `distance` beside the tip, that comes with `speed`.
  Proximity& AddBeside(double distance, double speed = 0.0) {
    Proximity& proximity = set_.proximities.emplace_back();
    proximity.link = models::Name("planar2_link_2");
    proximity.obstacle = models::Name("ball");
    proximity.distance = distance;
    proximity.point_on_link = Eigen::Vector3d(0.9, 0.0, 0.0);
    proximity.normal = -Eigen::Vector3d::UnitY();
    proximity.obstacle_velocity = -speed * Eigen::Vector3d::UnitY();
    return proximity;
  }
  /// The velocity for a request that asks for `wish`, rad/s.
  const Eigen::VectorXd& Answer(const BarrierSettings& settings, const Eigen::Vector2d& wish) {
    const BarrierFilter filter(model_, settings);
    Solve(filter, wish);
    return result_.velocity;
  }
  void Solve(const BarrierFilter& filter, const Eigen::Vector2d& wish) {
    position_ = wish / 5.0;
    const BarrierFilter::Positions position(position_.data(), 2), way(way_.data(), 2);
    filter.Solve({X_WL_, set_, position, {}, {}, clear_, way, last_, witnesses_}, result_);
  }

  const std::shared_ptr<const RobotModel> model_;
  const std::vector<Eigen::Isometry3d> X_WL_;
  ProximitySet set_;
  const ClearMotion* clear_{nullptr};
  Eigen::Vector2d position_, way_{0.0, 0.0};
  FilterActivity last_;
  WitnessPairs witnesses_;
  BarrierFilter::Solution result_;
};

TEST_F(BarrierFilterTest, GrantsAWishThatNothingIsNear) {
  EXPECT_NEAR((Answer(Settings(), {0.5, -0.25}) - Eigen::Vector2d(0.5, -0.25)).norm(), 0.0, 1e-13);
  EXPECT_EQ(result_.activity.num_bounds, 0);
}

TEST_F(BarrierFilterTest, ProjectsTheWishOntoTheRowByHand) {
  // h = 0.03: (0.9, 0.4) . u <= 0.15; the wish (1, 0) asks for 0.9.
  AddBeside(0.08);
  const Eigen::Vector2d expected(1 - 0.675 / 0.97, -0.3 / 0.97);
  EXPECT_NEAR((Answer(Settings(), {1, 0}) - expected).norm(), 0.0, 1e-12);
  ASSERT_EQ(result_.activity.num_bounds, 1);
  EXPECT_EQ(result_.activity.bounds[0].kind, FilterBound::Kind::kDistance);
  EXPECT_NEAR(result_.activity.bounds[0].multiplier, 0.75 / 0.97, 1e-12);
}

TEST_F(BarrierFilterTest, TheWayOfAJointMakesItDear) {
  AddBeside(0.05);
  way_ = {1.0, 0.0};
  BarrierSettings settings = Settings();
  settings.progress_weight = 10.0;
  const double w = 1.0 + 10.0 / 1.05;  // 1 and w onto (0.9, 0.4) . u = 0
  EXPECT_NEAR(Answer(settings, {1, 0})[0], 1 - 0.81 / w / (0.81 / w + 0.16), 1e-12);
}

TEST_F(BarrierFilterTest, LeavesTooNearAnObstacleWithTheRecoverySpeedAtMost) {
  AddBeside(0.03);
  EXPECT_NEAR(Answer(Settings(), {0, 0}).dot(Eigen::Vector2d(0.9, 0.4)), -0.1, 1e-12);
  set_.proximities[0].distance = -0.4;
  EXPECT_NEAR(Answer(Settings(), {0, 0}).dot(Eigen::Vector2d(0.9, 0.4)), -0.5, 1e-9);
}

TEST_F(BarrierFilterTest, LetsThroughWhatIsClearOfWhatItWasPlannedWith) {
  AddBeside(0.06, 1.0);
  const ClearMotion clear{.clear_for = 0.1, .bodies = {models::Name("ball")}};
  EXPECT_LT(Answer(Settings(), {0.5, 0})[0], -0.5);
  clear_ = &clear;
  EXPECT_TRUE(Answer(Settings(), {0.5, 0}).isApprox(Eigen::Vector2d(0.5, 0), 1e-9));
  BarrierSettings careful = Settings();
  careful.trust_time = 0.1;
  EXPECT_LT(Answer(careful, {0.5, 0})[0], -0.5);
  set_.proximities[0].own_link = models::Name("planar2_link_1");  // it knows no links
  EXPECT_FALSE(Answer(Settings(), {0.5, 0}).isApprox(Eigen::Vector2d(0.5, 0), 1e-9));
}

TEST_F(BarrierFilterTest, LetsThroughWhatIsClearOfWhatStandsWhateverElseIsNotKnown) {
  AddBeside(0.06, 1.0);
  const Eigen::Vector2d wish(0.5, 0);
  const ClearMotion standing{.clear_for = 0.0,
                             .bodies = {models::Name("ball"), models::Name("fly")},
                             .standing_for = 0.1,
                             .standing = {models::Name("ball")}};
  clear_ = &standing;
  EXPECT_TRUE(Answer(Settings(), wish).isApprox(wish, 1e-9));
  const ClearMotion other{.clear_for = 0.0,
                          .bodies = {models::Name("ball")},
                          .standing_for = 0.1,
                          .standing = {models::Name("fly")}};
  clear_ = &other;
  EXPECT_LT(Answer(Settings(), wish)[0], -0.5);
}

TEST_F(BarrierFilterTest, BrakesIfItHasNoProofOfItsAnswer) {
  AddBeside(0.08);
  BarrierSettings settings = Settings();
  settings.weights *= 1e-310;  // rows in units of it overflow
  EXPECT_EQ(Answer(settings, {0.5, 0.5}), Eigen::VectorXd(Eigen::Vector2d::Zero()));
  EXPECT_NE(result_.activity.status, qp::QpStatus::kOptimal);
}

TEST_F(BarrierFilterTest, NamesWhatShouldGrowAndNoJointMoves) {
  AddBeside(0.03).normal = -Eigen::Vector3d::UnitX();
  Answer(Settings(), {1, 0});
  EXPECT_EQ(result_.activity.rows, 0);
  ASSERT_EQ(result_.activity.num_bounds, 1);
  EXPECT_EQ(result_.activity.bounds[0].kind, FilterBound::Kind::kUnmovable);
  EXPECT_NEAR(result_.activity.bounds[0].slack, 0.1, 1e-15);
}

TEST_F(BarrierFilterTest, KeepsTheNearestRowsIfThereIsNoRoomForAll) {
  BarrierSettings settings = Settings();
  settings.most_rows = 1;
  AddBeside(0.2, 1.0);
  AddBeside(0.08);
  Answer(settings, {1, 0});
  EXPECT_EQ(result_.activity.dropped, 1);
  EXPECT_NEAR(result_.activity.bounds[0].multiplier, 0.75 / 0.97, 1e-12);
}

TEST_F(BarrierFilterTest, TheMarginIsWhatCurvatureCostsOverWhatIsWonBack) {
  const BarrierFilter linear(model_, Settings());
  EXPECT_DOUBLE_EQ(linear.TickMargin(2.0, 0.9, 0.5), 0.5 * kDt * (4.0 * 0.9 + 2.0) / 5.0);
  BarrierSettings settings = Settings();
  settings.approach_gain = 1.0;
  EXPECT_DOUBLE_EQ(BarrierFilter(model_, settings).TickMargin(1.0, 1.0, 0.0), 0.5 * kDt);
  settings.form = BarrierSettings::Form::kBraking;
  EXPECT_DOUBLE_EQ(BarrierFilter(model_, settings).TickMargin(1.0, 1.0, 0.0), 0.1 * kDt);
  EXPECT_NEAR(linear.reach(), 0.95, 1e-12);  // the fore link's solid ends 0.45 m from the elbow
}

TEST_F(BarrierFilterTest, ReachesAsFarAsSlidesCarryTheArm) {
  const auto arm = std::make_shared<const RobotModel>(ParseUrdf(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'><collision><geometry>"
      "<sphere radius='0.1'/></geometry></collision></link><joint name='turn' type='revolute'>"
      "<parent link='a'/><child link='b'/><axis xyz='0 0 1'/><limit lower='-1' upper='1' "
      "velocity='1' effort='1'/></joint><joint name='slide' type='prismatic'><parent link='b'/>"
      "<child link='c'/><axis xyz='1 0 0'/><origin xyz='0.2 0 0'/><limit lower='-0.7' upper='0.4' "
      "velocity='1' effort='1'/></joint></robot>",
      "r.urdf"));
  EXPECT_NEAR(BarrierFilter(arm, Settings()).reach(), 0.2 + 0.7 + 0.1, 1e-12);
}

TEST_F(BarrierFilterTest, RefusesAProximityOfAStrangersLink) {
  AddBeside(0.08).link = models::Name("lwr4_link_3");
  EXPECT_THROW(Answer(Settings(), {0, 0}), models::ModelError);
}

TEST_F(BarrierFilterTest, SolvesWithoutTheHeapAfterTheFirstTime) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const BarrierFilter filter(model_, Settings());
  AddBeside(0.08);
  Solve(filter, {1, 0});
  const std::int64_t before = AllocationCount();
  last_ = result_.activity;
  Solve(filter, {1, 0.1});
  EXPECT_EQ(AllocationCount(), before);
}

}  // namespace barrier_filter_test
}  // namespace oca::robot
