// SPDX-License-Identifier: BSD-3-Clause
// Where an ElasticBand rests: goals that are tight, taken, beyond limits, or move.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "oca/systems/signals/roles.h"
#include "tests/systems/methods/band_bench.h"

namespace oca::systems {
namespace elastic_band_rest_test {

using band_bench::Bench;
using band_bench::BoxAt;
using band_bench::Planar;
using band_bench::WayOf;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::HasSubstr;

TEST(ElasticBandRestTest, ArrivesAtAGoalNearerToAThingThanWhatItPrefersToKeep) {
  // At the goal the arm, 0.05 m thick, lies along y, 8 mm from the box behind it.
  Bench bench(BoxAt({-0.108, 0.5, 0.0}));
  int k = 0;
  EXPECT_LT(WayOf(bench, k, 900), 1e-9);
  EXPECT_TRUE(bench.Position().isApprox(Vector3d(1.57, 0, 0), 1e-9));
  EXPECT_TRUE(bench.Plan().clear);
  EXPECT_TRUE(bench.Plan().reaches);
  EXPECT_FALSE(bench.Plan().stuck);
  EXPECT_EQ(bench.Plan().lack, planning::BandLack::kGoal);
  EXPECT_LT(bench.Plan().distance, 0.02);
  EXPECT_GT(bench.Plan().distance, 0.002);
  EXPECT_EQ(bench->clear.Eval(bench.context()).clear_for, 30.0) << "the filter lets it stand there";
}

TEST(ElasticBandRestTest, RestsBeforeAGoalInContactSaysSoAndGoesOnOnceItIsFree) {
  Bench bench(BoxAt({0.0, 0.8, 0.0}, 0.4));
  int k = 0;
  EXPECT_LT(WayOf(bench, k, 1200), 0.01);
  const BandReport& plan = bench.Plan();
  EXPECT_TRUE(plan.stuck);
  EXPECT_TRUE(plan.clear);
  EXPECT_EQ(plan.block, planning::BandBlock::kContact);
  EXPECT_EQ(plan.block_body, models::Name("post"));
  EXPECT_GT(plan.block_amount, 0.1);
  EXPECT_LT((bench.Position() - Vector3d(1.57, 0, 0)).norm(), 1.57) << "it came nearer";
  bench->obstacles.Fix(bench.context(), BoxAt({5.0, 5.0, 0.0}));
  EXPECT_LT(WayOf(bench, k, 800), 1e-9);
  EXPECT_TRUE(bench.Position().isApprox(Vector3d(1.57, 0, 0), 1e-9));
  EXPECT_FALSE(bench.Plan().stuck);
  EXPECT_EQ(bench.Plan().block, planning::BandBlock::kNone);
}

TEST(ElasticBandRestTest, FollowsAGoalThatMovesThroughContactAndOutOfIt) {
  Bench bench(BoxAt({0.0, 0.8, 0.0}, 0.4));
  int k = 0;
  WayOf(bench, k, 800);
  ASSERT_EQ(bench.Plan().block, planning::BandBlock::kContact);
  // A new request every half a second, each 0.1 rad farther.
  VectorXd goal = Vector3d(1.57, 0, 0);
  double largest_step = 0.0, largest_change = 0.0;
  VectorXd step = VectorXd::Zero(3);
  for (int i = 0; i < 12; ++i) {
    const VectorXd next = goal + Vector3d(0.1, 0, 0);
    bench->ahead.Fix(
        bench.context(),
        RequestAhead{std::make_shared<const motion::Trajectory>(motion::Trajectory::CubicHermite(
            {{.time = 0.01 * k, .position = goal}, {.time = 0.01 * k + 0.5, .position = next}}))});
    goal = next;
    for (int tick = 0; tick < 50; ++tick, ++k) {
      const VectorXd before = bench.Position();
      bench.Tick(k);
      const VectorXd now = bench.Position() - before;
      largest_step = std::max(largest_step, now.cwiseAbs().maxCoeff());
      largest_change = std::max(largest_change, (now - step).cwiseAbs().maxCoeff());
      step = now;
    }
  }
  WayOf(bench, k, 1200);  // the way round the box takes its time
  EXPECT_TRUE(bench.Position().isApprox(goal, 1e-6)) << bench.Position().transpose();
  EXPECT_FALSE(bench.Plan().stuck);
  EXPECT_EQ(bench.Plan().block, planning::BandBlock::kNone);
  // A band that has to hurry may exceed limits a little, which the motion limiter keeps.
  EXPECT_LT(largest_step, 1.05 * 0.02) << "of 2 rad/s, the limit";
  EXPECT_LT(largest_change, 0.1 * 0.02) << "no jump: 20 rad/s^2";
}

TEST(ElasticBandRestTest, SaysWhatBlocksToWhoAsksByItsRole) {
  Bench bench(BoxAt({0.0, 0.8, 0.0}, 0.4));
  const auto* const knows = bench->role<KnowsWhatBlocks>();
  ASSERT_NE(knows, nullptr);
  EXPECT_FALSE(knows->what(bench.context()).has_value());
  int k = 0;
  WayOf(bench, k, 300);
  const auto what = knows->what(bench.context());
  ASSERT_TRUE(what.has_value());
  EXPECT_EQ(what->kind, "contact");
  EXPECT_EQ(what->other, models::Name("post"));
  EXPECT_EQ(what->unit, "m");
  EXPECT_EQ(what->amount, bench.Plan().block_amount);
  EXPECT_THAT(what->text, HasSubstr("m deep in post"));
}

TEST(ElasticBandRestTest, RestsAtTheLimitThatAGoalIsBeyond) {
  Bench bench(BoxAt({5.0, 5.0, 0.0}));
  const double limit = Planar().Get("arm")->upper_limits()[1];
  bench->ahead.Fix(
      bench.context(),
      RequestAhead{std::make_shared<const motion::Trajectory>(motion::Trajectory::CubicHermite(
          {{.time = 0.5, .position = Vector3d(0, 0, 0)},
           {.time = 4.5, .position = Vector3d(0, limit + 0.2, 0)}}))});
  int k = 0;
  EXPECT_LT(WayOf(bench, k, 900), 0.01);
  EXPECT_NEAR(bench.Position()[1], limit, 1e-3);
  EXPECT_EQ(bench.Plan().block, planning::BandBlock::kLimit);
  EXPECT_NEAR(bench.Plan().block_amount, 0.2, 1e-9);
  EXPECT_EQ(bench.Plan().block_link, Planar().Get("arm")->position_names()[1]);
  EXPECT_TRUE(bench.Plan().stuck);
}

}  // namespace elastic_band_rest_test
}  // namespace oca::systems
