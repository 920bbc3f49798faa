// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/motion_ahead.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/function.h"
#include "oca/systems/basics/sine_source.h"
#include "oca/systems/basics/sum.h"
#include "oca/systems/basics/zero_order_hold.h"
#include "oca/systems/commands/spline_generator.h"

namespace oca::foresight {
namespace motion_ahead_test {

using systems::SplineGenerator;
using testing::HasSubstr;

/// A spline of two joints that ends after 1 s at (`end`, 0), sampled every 0.1 s.
const SplineGenerator& AddSpline(DiagramBuilder& builder, const std::string& name, double end) {
  SplineGenerator::Params params;
  params.key_points = {{.time = 0.0, .position = Eigen::Vector2d::Zero()},
                       {.time = 1.0, .position = Eigen::Vector2d(end, 0.0)}};
  params.period = Period(1, 10);
  return builder.Add<SplineGenerator>(name, params);
}

const systems::ZeroOrderHold& AddHold(DiagramBuilder& builder, const std::string& name,
                                      const Output<Vector>& in) {
  const auto& hold = builder.Add<systems::ZeroOrderHold>(name, {.period = Period(1, 10)});
  builder.Connect(in, hold.in);
  return hold;
}

std::string RefusalOf(const Diagram& diagram, const OutputHandle& output) {
  try {
    MotionAheadOf(diagram, output, "here");
  } catch (const ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "was accepted";
  return "";
}

TEST(MotionAheadTest, IsThatOfTheNearestSplineUpTheLineThroughStates) {
  DiagramBuilder builder;
  const auto& far = AddSpline(builder, "far", 5.0);
  const auto& near = AddSpline(builder, "near", 2.0);
  const auto& first = AddHold(builder, "first", far.position);
  const auto& sum = builder.Add<systems::Sum>("sum", {.inputs = 2});
  builder.ConnectPorts(first.out, sum.FindInput("in0"));
  builder.Connect(near.position, Typed<Vector>(sum.FindInput("in1")));
  const auto& last = AddHold(builder, "last", sum.out);
  const auto diagram = builder.Build();
  const MotionAhead ahead = MotionAheadOf(*diagram, last.out, "here");
  EXPECT_EQ(ahead.source, &near);
  EXPECT_EQ(ahead.motion->goal(), Eigen::Vector2d(2.0, 0.0));
  EXPECT_DOUBLE_EQ(ahead.motion->Evaluate(0.5, 0)[0], 1.0);
}

TEST(MotionAheadTest, IsNoneOfTwoThatAreEquallyNear) {
  DiagramBuilder builder;
  const auto& one = AddSpline(builder, "one", 1.0);
  const auto& other = AddSpline(builder, "other", 2.0);
  const auto& sum = builder.Add<systems::Sum>("sum", {.inputs = 2});
  builder.ConnectPorts(one.position, sum.FindInput("in0"));
  builder.ConnectPorts(other.position, sum.FindInput("in1"));
  const auto diagram = builder.Build();
  const std::string refusal = RefusalOf(*diagram, sum.out);
  EXPECT_THAT(refusal, HasSubstr("here: motion ahead; got both of 'one' and 'other'"));
}

TEST(MotionAheadTest, IsRefusedWhereNobodyKnowsIt) {
  DiagramBuilder builder;
  const auto& sine = builder.Add<systems::SineSource>("sine", {});
  const auto& hold = AddHold(builder, "hold", sine.value);
  const auto diagram = builder.Build();
  EXPECT_THAT(RefusalOf(*diagram, hold.out),
              HasSubstr("here: motion ahead; got 'hold', up the line from which nobody knows it"));
}

TEST(MotionAheadTest, IsRefusedIfItIsOfOtherJoints) {
  DiagramBuilder builder;
  const auto& spline = AddSpline(builder, "spline", 1.0);
  const System& first = builder.AddSystem(
      "first", MakeBlock({.inputs = {{"q", 2, "rad"}}, .output = {"out", 1, "rad"}},
                         [](VectorView q) { return q[0]; }));
  builder.ConnectPorts(spline.position, first.FindInput("q"));
  const auto diagram = builder.Build();
  EXPECT_THAT(RefusalOf(*diagram, first.FindOutput("out")),
              HasSubstr("here: length of 'spline'; got 2 joints; expected 1"));
}

TEST(PositionsAheadTest, AreTheOutputAtAnyTimeIfTimeAloneMovesIt) {
  DiagramBuilder builder;
  const auto& sine = builder.Add<systems::SineSource>("sine", {.amplitude = 2.0});
  const auto diagram = builder.Build();
  const PositionsAhead ahead = PositionsAheadOf(*diagram, sine.value, Samples::kShown, "here");
  EXPECT_EQ(ahead.source, &sine);
  EXPECT_FALSE(ahead.requested);
  for (const double time : {0.3, 0.1, 7.25}) {
    EXPECT_DOUBLE_EQ(ahead.at(time)[0], 2.0 * std::sin(2.0 * std::numbers::pi * time));
  }
}

TEST(PositionsAheadTest, AreTheWholeMotionOfASplineThatIsSampled) {
  DiagramBuilder builder;
  const auto& spline = AddSpline(builder, "spline", 2.0);
  const auto& hold = AddHold(builder, "hold", spline.position);
  const auto diagram = builder.Build();
  const PositionsAhead ahead = PositionsAheadOf(*diagram, hold.out, Samples::kBetween, "here");
  EXPECT_EQ(ahead.source, &spline);
  EXPECT_TRUE(ahead.requested);
  EXPECT_DOUBLE_EQ(ahead.at(0.25)[0], 2.0 * 0.25 * 0.25 * (3.0 - 2.0 * 0.25));  // no tick
  EXPECT_EQ(ahead.at(9.0), Eigen::Vector2d(2.0, 0.0));
}

TEST(PositionsAheadTest, AreWhatASplineShowsIfItsSamplesAreAskedFor) {
  DiagramBuilder builder;
  const auto& spline = AddSpline(builder, "spline", 2.0);
  const auto diagram = builder.Build();
  const PositionsAhead ahead = PositionsAheadOf(*diagram, spline.position, Samples::kShown, "here");
  const MotionAhead motion = MotionAheadOf(*diagram, spline.position, "here");
  EXPECT_EQ(motion.period, Period(1, 10));
  for (const auto& [time, tick] : {std::pair(0.0, 0.0), {0.25, 0.3}, {0.3, 0.3}, {0.301, 0.4}}) {
    EXPECT_EQ(ahead.at(time), motion.motion->Evaluate(tick, 0)) << time;
  }
}

}  // namespace motion_ahead_test
}  // namespace oca::foresight
