// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/judging/avoidance_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/log.h"
#include "oca/systems/fields/repulsive_field.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace avoidance_log_test {

using ::testing::ElementsAre;

class Lines final : public Log {
 public:
  explicit Lines(bool wants) : wants_(wants) {}
  bool enabled(LogLevel) const override { return wants_; }
  void Write(LogLevel level, double, std::string_view text) override {
    EXPECT_EQ(level, LogLevel::kDebug);
    lines.emplace_back(text);
  }
  std::vector<std::string> lines;

 private:
  bool wants_;
};

ProximitySet Near(double distance) {
  Proximity far, near;
  far.link = near.link = models::Name("lwr4_link_4");
  far.obstacle = models::Name("wall");
  far.distance = 0.25;
  near.obstacle = models::Name("box");
  near.distance = distance;
  return {{far, near}};
}

/// A log behind a field, for 0.2 s at 10 Hz: lines at 0, 0.1 and 0.2 s.
std::vector<std::string> LinesOf(const ProximitySet& proximities, bool enabled, bool wants) {
  DiagramBuilder builder;
  const auto& field = builder.Add<RepulsiveField>("field", RepulsiveField::Params{});
  const auto& log = builder.Add<AvoidanceLog>(
      "log", AvoidanceLog::Params{.period = Period(1, 10), .enabled = enabled});
  builder.ExportInput("proximities", field.proximities);
  builder.ExportInput("proximities", log.proximities);
  builder.Connect(field.forces, log.forces);
  builder.ExportInput("delta", log.delta);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  diagram->GetInput<ProximitySet>("proximities").Fix(simulator.context(), proximities);
  diagram->GetInput<Vector>("delta").Fix(simulator.context(),
                                         Eigen::VectorXd::Constant(1, -0.0231));
  Lines lines(wants);
  simulator.SetLog(&lines);
  simulator.AdvanceTo(0.2);
  return lines.lines;
}

TEST(AvoidanceLogTest, WritesClosestPairLargestForceAndDeltaOnceAPeriod) {
  const std::string line = "closest lwr4_link_4 - box 0.2000 m, force 41.67 N, delta 0.0231";
  EXPECT_THAT(LinesOf(Near(0.2), true, true), ElementsAre(line, line, line));
}

TEST(AvoidanceLogTest, SaysWhenNothingIsNear) {
  EXPECT_THAT(LinesOf({}, true, true).at(0), "closest -, force 0 N, delta 0.0231");
}

TEST(AvoidanceLogTest, IsSilentIfNotEnabledOrNotWanted) {
  EXPECT_TRUE(LinesOf(Near(0.2), false, true).empty());
  EXPECT_TRUE(LinesOf(Near(0.2), true, false).empty());
}

TEST(AvoidanceLogTest, WritesWhatIsConnectedOnly) {
  DiagramBuilder builder;
  const auto& log = builder.Add<AvoidanceLog>("log", AvoidanceLog::Params{.period = Period(1, 10)});
  builder.ExportInput("delta", log.delta);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  diagram->GetInput<Vector>("delta").Fix(simulator.context(), Eigen::VectorXd::Constant(1, 0.5));
  Lines lines(true);
  simulator.SetLog(&lines);
  simulator.Initialize();
  EXPECT_THAT(lines.lines, ElementsAre("delta 0.5"));
}

TEST(AvoidanceLogTest, RefusesAPeriodOfZero) {
  EXPECT_THROW(AvoidanceLog(AvoidanceLog::Params{}), ConfigError);
}

}  // namespace avoidance_log_test
}  // namespace oca::systems
