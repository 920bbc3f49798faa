// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/signal_log.h"

#include <gmock/gmock.h>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace signal_log_test {

using blocks::Vec;
using testing::HasSubstr;

/// out = (t, 2 t)
class Clocks final : public System {
 public:
  Clocks() : out(DeclareOutput<Vector, &Clocks::Calc>("out", {2}, kTime)) {}

 private:
  void Calc(double t, MutableVectorView both) const { both << t, 2.0 * t; }

 public:
  const Output<Vector> out;
};

struct Sources {
  Sources() {
    DiagramBuilder builder;
    const auto& source = builder.Add<Clocks>("source");
    const auto& constant = builder.Add<blocks::Source>("constant", Vec({7.0}));
    clocks = source.out;
    seven = constant.value;
    diagram = builder.Build();
  }
  OutputHandle clocks, seven;
  std::unique_ptr<Diagram> diagram;
};

TEST(SignalLogTest, KeepsARowAPeriodOfAllOutputsSideBySide) {
  Sources sources;
  Simulator simulator(*sources.diagram);
  const SignalLog log(simulator, {sources.clocks, sources.seven}, Period(1, 4), 10);
  EXPECT_EQ(log.rows(), 0);
  simulator.AdvanceTo(0.6);
  ASSERT_EQ(log.rows(), 3);
  for (int row = 0; row < 3; ++row) {
    EXPECT_EQ(log.time(row), 0.25 * row);
    EXPECT_EQ(log.values(row, 0), Vec({0.25 * row, 0.5 * row}));
    EXPECT_EQ(log.values(row, 1), Vec({7.0}));
  }
}

TEST(SignalLogTest, OverwritesTheOldestRowOnceAllAreTaken) {
  Sources sources;
  Simulator simulator(*sources.diagram);
  const SignalLog log(simulator, {sources.clocks}, Period(1, 1), 3);
  simulator.AdvanceTo(2.0);
  EXPECT_EQ(log.rows(), 3);
  EXPECT_EQ(log.overwritten(), 0);
  EXPECT_EQ(log.time(0), 0.0);
  simulator.AdvanceTo(7.0);  // rows at 5, 6, 7 remain of eight
  EXPECT_EQ(log.rows(), 3);
  EXPECT_EQ(log.overwritten(), 5);
  for (int row = 0; row < 3; ++row) {
    EXPECT_EQ(log.time(row), 5.0 + row);
    EXPECT_EQ(log.values(row, 0), Vec({5.0 + row, 10.0 + 2.0 * row}));
  }
}

TEST(SignalLogTest, GivesMatricesWithTimesNamesAndUnits) {
  DiagramBuilder builder;
  const auto& source = builder.Add<Clocks>("source");
  const auto& speed = builder.Add<blocks::Source>("speed", Vec({7.0}), "rad/s");
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  const SignalLog log(simulator, {source.out, speed.value}, Period(1, 2));
  EXPECT_EQ(log.Matrix().rows(), 0);
  EXPECT_EQ(log.Matrix().cols(), 3);
  simulator.AdvanceTo(1.25);
  EXPECT_EQ(log.times(), Vec({0.0, 0.5, 1.0}));
  EXPECT_EQ(log.Matrix(), (Eigen::MatrixXd(3, 3) << 0, 0, 7, 0.5, 1, 7, 1, 2, 7).finished());
  EXPECT_EQ(log.Matrix(0), (Eigen::MatrixXd(3, 2) << 0, 0, 0.5, 1, 1, 2).finished());
  EXPECT_EQ(log.Matrix(1), Vec({7.0, 7.0, 7.0}));
  EXPECT_THAT(log.names(),
              testing::ElementsAre("source.out[0]", "source.out[1]", "speed.value[0]"));
  EXPECT_THAT(log.units(), testing::ElementsAre("", "", "rad/s"));
}

TEST(SignalLogTest, WithoutACapacityKeepsEveryRow) {
  Sources sources;
  Simulator simulator(*sources.diagram);
  const SignalLog log(simulator, {sources.clocks}, Period(1, 100));
  simulator.AdvanceTo(20.0);
  EXPECT_EQ(log.rows(), 2001);
  EXPECT_EQ(log.overwritten(), 0);
  EXPECT_EQ(log.time(0), 0.0);
  EXPECT_EQ(log.values(2000, 0), Vec({20.0, 40.0}));
}

TEST(SignalLogTest, ItsMatrixBeginsWithTheOldestRowThatIsLeft) {
  Sources sources;
  Simulator simulator(*sources.diagram);
  const SignalLog log(simulator, {sources.clocks}, Period(1, 1), 3);
  simulator.AdvanceTo(7.0);
  EXPECT_EQ(log.times(), Vec({5.0, 6.0, 7.0}));
  EXPECT_EQ(log.Matrix().col(1), Vec({10.0, 12.0, 14.0}));
}

TEST(SignalLogTest, WithoutOutputsKeepsTheTimes) {
  Sources sources;
  Simulator simulator(*sources.diagram);
  const SignalLog log(simulator, {}, Period(1, 2), 1);
  simulator.AdvanceTo(1.0);
  EXPECT_EQ(log.rows(), 1);
  EXPECT_EQ(log.time(0), 1.0);
}

TEST(SignalLogTest, RefusesACapacityAndAPeriodThatAreNotPositive) {
  Sources sources;
  Simulator simulator(*sources.diagram);
  EXPECT_THROW(SignalLog(simulator, {sources.clocks}, Period(1, 1), 0), ConfigError);
  EXPECT_THROW(SignalLog(simulator, {sources.clocks}, Period(0, 1), 1), ConfigError);
  EXPECT_NO_THROW(SignalLog(simulator, {sources.clocks}, Period(1, 1), 1));
}

TEST(SignalLogTest, RefusesAnOutputThatIsNoVector) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::LabelSink>());
  Simulator simulator(*diagram);
  try {
    const SignalLog log(simulator, {diagram->FindOutput("out")}, Period(1, 1), 1);
    FAIL() << "a Label was logged";
  } catch (const WiringError& error) {
    EXPECT_THAT(error.what(), HasSubstr("got a Label; expected a Vector"));
  }
}

TEST(SignalLogTest, RefusesOutputsOfAnotherDiagramAndALateStart) {
  Sources sources, other;
  Simulator simulator(*sources.diagram);
  EXPECT_THROW(SignalLog(simulator, {other.clocks}, Period(1, 1), 1), WiringError);
  simulator.Initialize();
  EXPECT_THROW(SignalLog(simulator, {sources.clocks}, Period(1, 1), 1), ConfigError);
}

}  // namespace signal_log_test
}  // namespace oca
