// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/request_ahead.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/commands/spline_generator.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace request_ahead_test {

Eigen::VectorXd One(double value) { return Eigen::VectorXd::Constant(1, value); }

RequestAhead Swing() {
  const SplineGenerator::Params params{
      .kind = SplineKind::kQuintic,
      .key_points = {{.time = 0.5, .position = One(0.0)}, {.time = 1.5, .position = One(1.0)}}};
  SystemBench<SplineGenerator> bench(params);
  return bench->ahead.Eval(bench.context());
}

TEST(RequestAheadTest, IsTheWholeMotionOfASplineGenerator) {
  const RequestAhead request = Swing();
  ASSERT_NE(request.trajectory, nullptr);
  EXPECT_DOUBLE_EQ(request.trajectory->Evaluate(0.75, 0)[0], 53.0 / 512.0);
  EXPECT_EQ(request.trajectory->times().back(), 1.5);
}

TEST(RequestAheadTest, ComesBackFromJsonAsTheQuinticThroughItsPoints) {
  std::string text;
  Signal<RequestAhead>::WriteJson(Swing(), text);
  const RequestAhead back = Signal<RequestAhead>::ReadJson(text);
  EXPECT_DOUBLE_EQ(back.trajectory->Evaluate(0.75, 0)[0], 53.0 / 512.0);
  std::string again;
  Signal<RequestAhead>::WriteJson(back, again);
  EXPECT_EQ(again, text);
}

TEST(RequestAheadTest, WithoutAMotionIsAListWithoutPoints) {
  std::string text;
  Signal<RequestAhead>::WriteJson({}, text);
  EXPECT_EQ(text, R"({"points":[]})");
  EXPECT_EQ(Signal<RequestAhead>::ReadJson(text).trajectory, nullptr);
}

TEST(RequestAheadTest, RefusesPointsThatAreNoMotion) {
  EXPECT_THROW(Signal<RequestAhead>::ReadJson(R"({"points":[{"time":0}]})"), ConfigError);
  EXPECT_THROW(Signal<RequestAhead>::ReadJson(
                   R"({"points":[{"time":0,"position":[1],"velocity":[0,0],"acceleration":[0]}]})"),
               ConfigError);
}

}  // namespace request_ahead_test
}  // namespace oca::systems
