// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/spline_generator.h"

#include <gmock/gmock.h>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace spline_generator_test {

using ::testing::HasSubstr;

Eigen::VectorXd One(double value) { return Eigen::VectorXd::Constant(1, value); }

/// From 0 to 1 between 0.5 and 1.5 s.
SplineGenerator::Params Swing(SplineKind kind = SplineKind::kCubic) {
  return {.kind = kind,
          .key_points = {{.time = 0.5, .position = One(0.0)}, {.time = 1.5, .position = One(1.0)}}};
}

std::string RefusalOf(const SplineGenerator::Params& params) {
  try {
    SplineGenerator generator(params);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SplineGeneratorTest, FollowsTimeContinuously) {
  SystemBench<SplineGenerator> bench(Swing());
  bench.AdvanceTo(0.75);
  EXPECT_DOUBLE_EQ(bench->position.Eval(bench.context())[0], 5.0 / 32.0);
  EXPECT_DOUBLE_EQ(bench->velocity.Eval(bench.context())[0], 9.0 / 8.0);
  EXPECT_DOUBLE_EQ(bench->acceleration.Eval(bench.context())[0], 3.0);
}

TEST(SplineGeneratorTest, InterpolatesAsItsKindSays) {
  SystemBench<SplineGenerator> quintic(Swing(SplineKind::kQuintic));
  quintic.AdvanceTo(0.75);
  EXPECT_DOUBLE_EQ(quintic->position.Eval(quintic.context())[0], 53.0 / 512.0);
  auto params = Swing(SplineKind::kC2);
  params.ends = SplineEnds::kNatural;
  SystemBench<SplineGenerator> natural(params);  // through two points: a line
  natural.AdvanceTo(0.75);
  EXPECT_DOUBLE_EQ(natural->position.Eval(natural.context())[0], 0.25);
}

TEST(SplineGeneratorTest, ShowsTheLastKeyPointAsGoal) {
  SystemBench<SplineGenerator> bench(Swing());
  EXPECT_EQ(bench->goal.Eval(bench.context())[0], 1.0);
}

TEST(SplineGeneratorTest, SampledShowsTheRequestForTheEndOfThePeriod) {
  auto params = Swing();
  params.period = Period(1, 4);
  SystemBench<SplineGenerator> bench(params);
  EXPECT_EQ(bench->position.Eval(bench.context())[0], 0.0);  // request(0)
  bench.AdvanceTo(0.5);  // the tick at 0.25 showed request(0.5), the one at 0.5 is pending
  EXPECT_EQ(bench->position.Eval(bench.context())[0], 0.0);
  bench.AdvanceTo(0.6);
  EXPECT_DOUBLE_EQ(bench->position.Eval(bench.context())[0], 5.0 / 32.0);
  EXPECT_DOUBLE_EQ(bench->velocity.Eval(bench.context())[0], 9.0 / 8.0);
  EXPECT_DOUBLE_EQ(bench->acceleration.Eval(bench.context())[0], 3.0);
  bench.AdvanceTo(0.74);
  EXPECT_DOUBLE_EQ(bench->position.Eval(bench.context())[0], 5.0 / 32.0);
}

TEST(SplineGeneratorTest, RefusesNumbersThatTheKindCannotMeet) {
  auto params = Swing();
  params.key_points[1].acceleration = One(1.0);
  EXPECT_THAT(RefusalOf(params), HasSubstr("key_points[1].acceleration"));
  params.kind = SplineKind::kQuintic;
  EXPECT_EQ(RefusalOf(params), "accepted");

  params = Swing(SplineKind::kC2);
  params.key_points[0].velocity = One(1.0);
  EXPECT_EQ(RefusalOf(params), "accepted");
  params.ends = SplineEnds::kNatural;
  EXPECT_THAT(RefusalOf(params), HasSubstr("key_points[0].velocity"));
  params.ends = SplineEnds::kClamped;
  params.key_points.push_back({.time = 2.0, .position = One(0.0)});
  params.key_points[1].velocity = One(1.0);
  EXPECT_THAT(RefusalOf(params), HasSubstr("key_points[1].velocity"));
}

TEST(SplineGeneratorTest, RefusesNoKeyPointsAndANegativePeriod) {
  EXPECT_THAT(RefusalOf({}), HasSubstr("key_points: empty"));
  auto params = Swing();
  params.period = Period(-1, 4);
  EXPECT_THAT(RefusalOf(params), HasSubstr("period"));
}

}  // namespace spline_generator_test
}  // namespace oca::systems
