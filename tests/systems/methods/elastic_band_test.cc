// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/elastic_band.h"

#include <gmock/gmock.h>

#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/commands/key_points.h"
#include "tests/allocation_count.h"
#include "tests/systems/methods/band_bench.h"

namespace oca::systems {
namespace elastic_band_test {

using band_bench::Bench;
using band_bench::BoxAt;
using band_bench::Planar;
using band_bench::Turn;
using Eigen::Vector3d;
using Eigen::VectorXd;
using testing::HasSubstr;

std::string RefusalOf(const ElasticBand::Params& params) {
  try {
    ElasticBand band(params, Planar());
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ElasticBandTest, RefusesToPlanMoreOftenThanItControls) {
  EXPECT_THAT(RefusalOf({.period = Period(1, 10), .plan_period = Period(1, 20)}),
              HasSubstr("plan_period: got 0.05 s"));
  EXPECT_EQ(RefusalOf({.period = Period(1, 10), .plan_period = Period(1, 10)}), "accepted");
}

TEST(ElasticBandTest, RefusesToCallClearWhatItDoesNotLookAt) {
  EXPECT_THAT(RefusalOf({.period = Period(1, 100), .margin = 0.05, .clear_distance = 0.06}),
              HasSubstr("clear_distance: got 0.06 m"));
  EXPECT_EQ(RefusalOf({.period = Period(1, 100), .margin = 0.05, .clear_distance = 0.05}),
            "accepted");
}

TEST(ElasticBandTest, RefusesAHardDistanceThatIsMoreThanItPrefers) {
  EXPECT_THAT(RefusalOf({.period = Period(1, 100), .hard_distance = 0.05}),
              HasSubstr("hard_distance: got 0.05 m; expected at most clear_distance, 0.045 m"));
  EXPECT_THAT(RefusalOf({.period = Period(1, 100), .hard_distance = 0.0}),
              HasSubstr("hard_distance: got 0"));
  EXPECT_EQ(RefusalOf({.period = Period(1, 100), .hard_distance = 0.045, .trust_distance = 0.045}),
            "accepted");
}

TEST(ElasticBandTest, RefusesToBeTrustedWithLessThanIsClear) {
  EXPECT_THAT(RefusalOf({.period = Period(1, 100), .trust_distance = 0.05}),
              HasSubstr("got 0.05 m; expected at most clear_distance, 0.045 m"));
  EXPECT_THAT(RefusalOf({.period = Period(1, 100), .flying_distance = 0.05}),
              HasSubstr("got 0.05 m; expected at most clear_distance, 0.045 m"));
  EXPECT_THAT(RefusalOf({.period = Period(1, 100), .limit_share = 1.1}),
              HasSubstr("limit_share: got 1.1; expected in (0, 1]"));
  EXPECT_EQ(RefusalOf({.period = Period(1, 100), .trust_distance = 0.045, .limit_share = 1.0}),
            "accepted");
}

TEST(ElasticBandTest, PassesARequestThatIsClear) {
  Bench bench(BoxAt({5.0, 5.0, 0.0}));
  for (int k = 0; k < 300; ++k) {
    bench.Tick(k);
    const VectorXd request = Turn().trajectory->Evaluate((k + 1) * 0.01, 0);
    EXPECT_LT((bench.Position() - request).norm(), 1e-12) << k;
  }
  EXPECT_EQ(bench.Plan().plans, 1u) << "what stands need not be planned for twice";
}

TEST(ElasticBandTest, EveryPlanTakesEffectAtATickAndNotARoundingLater) {
  ObstacleSet drifting = BoxAt({3.0, 3.0, 0.0});
  drifting.obstacles[0].linear.x() = 0.01;
  Bench bench(drifting);
  for (int k = 0; k < 200; ++k) {
    bench.Tick(k);
    const double change = bench.Plan().change;
    EXPECT_EQ(change, std::round(50.0 * change) / 50.0) << k;  // 0.02 s from plan to plan
    EXPECT_GT(change, 0.01 * k);
  }
  EXPECT_GT(bench.Plan().plans, 50u);
}

TEST(ElasticBandTest, IsChargedForWhatItsPlansCost) {
  ElasticBand::Params params = ElasticBand::Example();
  params.plan_cost.plan = 0.03;
  ObstacleSet drifting = BoxAt({3.0, 3.0, 0.0});
  drifting.obstacles[0].linear.x() = 0.01;
  Bench bench(drifting, params);
  bench.Tick(0);
  EXPECT_EQ(bench.Plan().overruns, 1u);
  EXPECT_EQ(bench.Plan().plans, 0u);
  bench.Tick(3);
  EXPECT_EQ(bench.Plan().plans, 0u) << "until 0.03 s the first one would still be made";
  bench.Tick(4);
  EXPECT_EQ(bench.Plan().plans, 1u);
  const double charged = bench.Plan().charged;
  EXPECT_GT(charged, 0.03);
  EXPECT_LT(charged, 0.032);
  EXPECT_EQ(bench.Plan().change, 0.08);  // 0.04 s and a quarter more than 0.03, at a tick
  EXPECT_EQ(bench.Plan().overruns, 1u);
}

TEST(ElasticBandTest, PlansBeginAfterPlanTime) {
  ElasticBand::Params params = ElasticBand::Example();
  params.plan_time = 0.01;
  ObstacleSet drifting = BoxAt({3.0, 3.0, 0.0});
  drifting.obstacles[0].linear.x() = 0.01;
  Bench bench(drifting, params);
  bench.Tick(0);
  EXPECT_EQ(bench.Plan().change, 0.01);
  bench.Tick(2);
  EXPECT_EQ(bench.Plan().change, 0.03);
}

TEST(ElasticBandTest, RefusesHorizonsWithoutEnd) {
  EXPECT_THAT(RefusalOf({.period = Period(1, 100), .most_horizon = 1e9}),
              HasSubstr("most_horizon: got 1000000000 s; expected in [0.5, 600]"));
  EXPECT_EQ(RefusalOf({.period = Period(1, 100), .most_horizon = 600.0}), "accepted");
}

TEST(ElasticBandTest, GoesRoundAPostAndArrivesWithoutAJump) {
  Bench bench(BoxAt({0.6, 0.6, 0.0}));
  VectorXd last = Vector3d::Zero(), speed = Vector3d::Zero();
  double farthest = 0.0;
  for (int k = 0; k < 800; ++k) {
    bench.Tick(k);
    const VectorXd q = bench.Position();
    EXPECT_LT(((q - last) / 0.01 - speed).cwiseAbs().maxCoeff(), 0.5) << k;
    speed = (q - last) / 0.01;
    last = q;
    farthest = std::max(farthest,
                        (q - Turn().trajectory->Evaluate((k + 1) * 0.01, 0)).cwiseAbs().maxCoeff());
  }
  EXPECT_TRUE(bench.Plan().clear);
  EXPECT_GT(farthest, 0.1);
  EXPECT_TRUE(last.isApprox(Vector3d(1.57, 0, 0), 1e-9)) << last.transpose();
  EXPECT_FALSE(bench.Plan().stuck);
}

TEST(ElasticBandTest, PlansThatAreLateMakeNoJump) {
  ElasticBand::Params params = ElasticBand::Example();
  params.plan_cost.band = 4e-5;
  Bench bench(BoxAt({0.6, 0.6, 0.0}), params);
  VectorXd last = VectorXd::Zero(3), speed = VectorXd::Zero(3);
  for (int k = 0; k < 1000; ++k) {
    bench.Tick(k);
    const VectorXd v = (bench.Position() - last) / 0.01;
    EXPECT_LT((v - speed).cwiseAbs().maxCoeff(), 0.5) << k;
    last = bench.Position();
    speed = v;
  }
  EXPECT_GT(bench.Plan().overruns, 0u);
  EXPECT_TRUE(bench.Plan().clear);
  EXPECT_LT((last - VectorXd(Vector3d(1.57, 0, 0))).norm(), 0.01);
}

TEST(ElasticBandTest, OnlyPlansAllocate) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  Bench bench(BoxAt({0.6, 0.6, 0.0}));
  int k = 0;
  // The first plans look for better ways, then one is kept; one that takes too long is made twice.
  for (; k < 30 || (k < 80 && bench.Plan().plans < 8); ++k) bench.Tick(k);
  ASSERT_EQ(bench.Plan().plans, 8u);
  VectorXd q = bench.Position();
  const std::int64_t before = AllocationCount();
  for (; k < 300; ++k) {
    bench.AdvanceTo((k + 0.5) * 0.01);
    q = bench->position.Eval(bench.context());
    bench->measured_position.Fix(bench.context(), q);
  }
  EXPECT_EQ(AllocationCount(), before);
}

double ClearFor(Bench& bench) { return bench->clear.Eval(bench.context()).clear_for; }

TEST(ElasticBandTest, SaysForHowLongItsPlanIsClearWhileAllGoesAsForeseen) {
  const ObstacleSet post = BoxAt({0.6, 0.6, 0.0});
  Bench bench(post);
  bench.AdvanceTo(0.005);
  EXPECT_EQ(ClearFor(bench), 0.0);  // the first plan has yet to be computed
  for (int k = 1; k < 40; ++k) bench.Tick(k);
  ASSERT_TRUE(bench.Plan().clear);
  EXPECT_EQ(ClearFor(bench), 30.0);
  const ClearMotion& clear = bench->clear.Eval(bench.context());
  EXPECT_EQ(clear.bodies, std::vector{models::Name("post")});
  EXPECT_FALSE(clear.own_links);

  // An arm that is not where the band is.
  const VectorXd followed = bench.Position();
  bench.Measure(followed + Vector3d(0.0, 0.0049, 0.0));
  EXPECT_EQ(ClearFor(bench), 30.0);
  bench.Measure(followed + Vector3d(0.0, 0.0051, 0.0));
  EXPECT_EQ(ClearFor(bench), 0.0);
  bench.Measure(followed);

  // What moves, is elsewhere, is new or is gone.
  ObstacleSet other = post;
  other.obstacles[0].linear = Vector3d(0.05, 0.0, 0.0);  // 15 mm in 0.3 s
  bench->obstacles.Fix(bench.context(), other);
  EXPECT_EQ(ClearFor(bench), 0.0);
  bench->obstacles.Fix(bench.context(), BoxAt({0.6, 0.594, 0.0}));
  EXPECT_EQ(ClearFor(bench), 0.0);
  other = post;
  other.obstacles.push_back(BoxAt({3.0, 0.0, 0.0}).obstacles[0]);
  auto body = std::make_shared<ObstacleBody>(*other.obstacles[1].body);
  body->id = models::Name("another post");
  other.obstacles[1].body = body;
  bench->obstacles.Fix(bench.context(), other);
  EXPECT_EQ(ClearFor(bench), 0.0);
  bench->obstacles.Fix(bench.context(), ObstacleSet{});
  EXPECT_EQ(ClearFor(bench), 0.0);
  bench->obstacles.Fix(bench.context(), post);
  EXPECT_EQ(ClearFor(bench), 30.0);

  // Another motion, until a plan for it has begun.
  const std::uint64_t plans = bench.Plan().plans;
  bench->ahead.Fix(bench.context(), Turn());
  EXPECT_EQ(ClearFor(bench), 0.0);
  bench.Tick(40);
  EXPECT_EQ(ClearFor(bench), 0.0);
  // One that takes long to make begins later.
  for (int k = 41; k < 45 || (k < 60 && ClearFor(bench) == 0.0); ++k) bench.Tick(k);
  EXPECT_GT(bench.Plan().plans, plans);
  EXPECT_EQ(ClearFor(bench), 30.0);
}

TEST(ElasticBandTest, NamesWhatBlocksAnArmThatDoesNotGetOn) {
  Bench bench(BoxAt({0.0, 0.8, 0.0}, 0.4));  // on the goal
  for (int k = 0; k < 900; ++k) {
    bench.AdvanceTo((k + 0.5) * 0.01);
    if (k < 100) bench.Measure(bench.Position());
    if (k != 500) continue;
    EXPECT_FALSE(bench.Plan().stuck);  // the request has just come to rest
  }
  EXPECT_TRUE(bench.Plan().stuck);
  EXPECT_EQ(bench.Plan().obstacle, models::Name("post"));
  EXPECT_FALSE(bench.Plan().link.empty());
}

TEST(ElasticBandTest, KnowsWhatStandsWhileSomethingElseDoesWhatNobodyForesaw) {
  ObstacleSet set = BoxAt({0.6, 0.6, 0.0});
  set.obstacles.push_back(BoxAt({3.0, 3.0, 0.0}).obstacles[0]);
  auto body = std::make_shared<ObstacleBody>(*set.obstacles[1].body);
  body->id = models::Name("fly");
  set.obstacles[1].body = body;
  set.obstacles[1].linear = Vector3d(0.1, 0.0, 0.0);
  Bench bench(set);
  bench.AdvanceTo(0.045);  // on its plan, which does not move yet
  const auto clear = [&] { return bench->clear.Eval(bench.context()); };
  EXPECT_GT(clear().ClearFor(models::Name("post"), false), 1.0);
  EXPECT_GT(clear().ClearFor(models::Name("fly"), false), 1.0);
  set.obstacles[1].linear = Vector3d(-0.1, 0.0, 0.0);
  bench->obstacles.Fix(bench.context(), set);
  EXPECT_GT(clear().ClearFor(models::Name("post"), false), 1.0);
  EXPECT_EQ(clear().ClearFor(models::Name("fly"), false), 0.0);
  set.obstacles[0].X_WO.translation().x() += 0.01;
  bench->obstacles.Fix(bench.context(), set);
  EXPECT_EQ(clear().ClearFor(models::Name("post"), false), 0.0);
}

TEST(ElasticBandTest, RefusesARequestForAnotherArm) {
  Bench bench(BoxAt({0.6, 0.6, 0.0}));
  bench->ahead.Fix(
      bench.context(),
      RequestAhead{std::make_shared<const motion::Trajectory>(
          motion::Trajectory::Linear({{.time = 0.0, .position = VectorXd::Zero(2)}}))});
  EXPECT_ANY_THROW(bench.AdvanceTo(0.1));
}

}  // namespace elastic_band_test
}  // namespace oca::systems
