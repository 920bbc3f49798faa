// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/params.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "oca/framework/dataflow/error.h"
#include "tests/framework/dataflow/example_params.h"
#include "tests/framework/dataflow/values.h"

namespace oca {
namespace params_test {

using testing::ElementsAre;
using testing::HasSubstr;
using values::ListOf;
using values::MapOf;
using values::Number;
using values::Text;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The problems of reading P from `value`, without location and `error: `.
template <class P>
std::vector<std::string> ProblemsOf(const Value& value) {
  Problems problems;
  P params;
  ReadFields(value, FieldsOf<P>(), "", &params, problems);
  std::vector<std::string> texts;
  for (const Diagnostic& problem : problems.all()) texts.push_back(problem.what);
  return texts;
}

/// The problems of an Everything whose only unusual entry is key: value.
std::vector<std::string> With(const std::string& key, Value value) {
  Value::Map map{{"count", {}, Number(1.0)}};
  if (key == "count") map.clear();
  map.push_back({key, {}, std::move(value)});
  return ProblemsOf<Everything>(Value(std::move(map), {}));
}

TEST(ParamsTest, ReadsEveryType) {
  const auto params = ReadParams<Everything>(
      MapOf({{"gain", Number(2.5)},
             {"count", Value(std::int64_t{3}, {})},
             {"enabled", Value(true, {})},
             {"name", Text("elbow")},
             {"method", Text("damped")},
             {"period", Number(1.0 / 60.0)},
             {"limit", ListOf({Number(1.0), Number(2.0)})},
             {"weights", ListOf({Number(1.0), Number(2.0), Number(3.0), Number(4.0)})},
             {"axis", ListOf({Number(0.0), Number(0.0), Number(1.0)})},
             {"waypoints", ListOf({MapOf({{"time", Number(1.0)}}),
                                   MapOf({{"time", Number(2.0)}, {"position", Number(-0.5)}})})},
             {"ignore", ListOf({ListOf({Text("a"), Text("b")}), ListOf({})})},
             {"start", MapOf({{"time", Number(0.25)}})},
             {"ceiling", Number(9.0)}}));
  EXPECT_EQ(params.gain, 2.5);
  EXPECT_EQ(params.count, 3);
  EXPECT_TRUE(params.enabled);
  EXPECT_EQ(params.name, "elbow");
  EXPECT_EQ(params.method, Method::kDamped);
  EXPECT_EQ(params.period, Period(1, 60));
  EXPECT_FALSE(params.limit.scalar());
  EXPECT_EQ(params.limit[1], 2.0);
  EXPECT_EQ(params.weights, Eigen::VectorXd(Eigen::Vector4d(1.0, 2.0, 3.0, 4.0)));
  EXPECT_EQ(params.axis, Eigen::Vector3d::UnitZ());
  ASSERT_EQ(params.waypoints.size(), 2u);
  EXPECT_EQ(params.waypoints[0].position, 0.125);  // its default
  EXPECT_EQ(params.waypoints[1].time, 2.0);
  EXPECT_EQ(params.waypoints[1].position, -0.5);
  EXPECT_THAT(params.ignore, ElementsAre(ElementsAre("a", "b"), ElementsAre()));
  EXPECT_EQ(params.start.time, 0.25);
  EXPECT_EQ(params.ceiling, 9.0);
}

TEST(ParamsTest, KeepsTheDefaultsOfWhatIsNotWritten) {
  const auto params = ReadParams<Everything>(MapOf({{"count", Number(4.0)}}));
  EXPECT_EQ(params.count, 4);
  EXPECT_EQ(params.gain, 0.5);
  EXPECT_EQ(params.method, Method::kTranspose);
  EXPECT_EQ(params.period, Period(1, 100));
  EXPECT_TRUE(params.limit.scalar());
  EXPECT_EQ(params.ceiling, std::nullopt);
  EXPECT_NO_THROW(ReadParams<Waypoint>(MapOf({{"time", Number(0.0)}})));
}

TEST(ParamsTest, NothingAtAllIsAnEmptyMap) {
  EXPECT_THAT(ProblemsOf<Everything>(Value()), ElementsAre("count: missing; expected integer"));
  EXPECT_THAT(ProblemsOf<Everything>(Number(1.0)),
              ElementsAre("parameters: got 1; expected a map"));
}

TEST(ParamsTest, RefusesEveryWrongType) {
  EXPECT_THAT(With("gain", Text("2")), ElementsAre("gain: got '2'; expected a number in N m^2"));
  EXPECT_THAT(With("gain", Value(true, {})),
              ElementsAre("gain: got true; expected a number in N m^2"));
  EXPECT_THAT(With("count", Number(1.5)), ElementsAre("count: got 1.5; expected an integer"));
  EXPECT_THAT(With("count", Text("one")), ElementsAre("count: got 'one'; expected a number"));
  EXPECT_THAT(With("enabled", Number(1.0)), ElementsAre("enabled: got 1; expected true or false"));
  EXPECT_THAT(With("enabled", Text("yes")),
              ElementsAre("enabled: got 'yes'; expected true or false"));
  EXPECT_THAT(With("name", Number(7.0)), ElementsAre("name: got 7; expected text"));
  EXPECT_THAT(With("method", Number(1.0)),
              ElementsAre("method: got 1; expected one of transpose, damped"));
  EXPECT_THAT(With("method", Text("dampd")),
              ElementsAre("method: got 'dampd'; expected one of transpose, damped; did you mean "
                          "'damped'?"));
  EXPECT_THAT(With("limit", Text("x")), ElementsAre("limit: got 'x'; expected a number or a list"));
  EXPECT_THAT(With("weights", Number(1.0)),
              ElementsAre("weights: got 1; expected a list of numbers"));
  EXPECT_THAT(With("axis", Number(1.0)), ElementsAre("axis: got 1; expected a list of 3 numbers"));
  EXPECT_THAT(With("waypoints", MapOf({})), ElementsAre(HasSubstr("waypoints: got a map; "
                                                                  "expected a list of")));
  EXPECT_THAT(With("start", Number(1.0)), ElementsAre("start: got 1; expected a map"));
  EXPECT_THAT(With("ceiling", Text("x")), ElementsAre("ceiling: got 'x'; expected a number"));
  EXPECT_THAT(With("period", Text("x")), ElementsAre("period: got 'x'; expected a number in s"));
}

TEST(ParamsTest, RefusesNumbersThatAreNotFiniteEverywhere) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    for (const char* key : {"gain", "count", "period", "limit", "ceiling"}) {
      EXPECT_THAT(With(key, Number(bad)), ElementsAre(HasSubstr("expected a finite number")))
          << key;
    }
    EXPECT_THAT(With("weights", ListOf({Number(1.0), Number(bad)})),
                ElementsAre(HasSubstr("weights[1]: got")));
    EXPECT_THAT(With("axis", ListOf({Number(bad), Number(1.0), Number(1.0)})),
                ElementsAre(HasSubstr("axis[0]: got")));
  }
}

TEST(ParamsTest, BoundsAreJudgedFromBothSides) {
  // gain in [0, 10]
  EXPECT_THAT(With("gain", Number(0.0)), ElementsAre());
  EXPECT_THAT(With("gain", Number(10.0)), ElementsAre());
  EXPECT_THAT(With("gain", Number(-1e-9)),
              ElementsAre("gain: got -1e-09 N m^2; expected in [0, 10]"));
  EXPECT_THAT(With("gain", Number(std::nextafter(10.0, 11.0))),
              ElementsAre(HasSubstr("expected in [0, 10]")));
  // period > 0
  EXPECT_THAT(With("period", Number(1e-9)), ElementsAre());
  EXPECT_THAT(With("period", Number(0.0)), ElementsAre("period: got 0 s; expected > 0"));
  EXPECT_THAT(With("period", Number(-1.0)), ElementsAre("period: got -1 s; expected > 0"));
  // limit in (0, 5], each component
  EXPECT_THAT(With("limit", Number(5.0)), ElementsAre());
  EXPECT_THAT(With("limit", Number(0.0)), ElementsAre("limit: got 0 rad/s; expected in (0, 5]"));
  EXPECT_THAT(With("limit", ListOf({Number(5.0), Number(5.1), Number(0.0)})),
              ElementsAre("limit[1]: got 5.1 rad/s; expected in (0, 5]",
                          "limit[2]: got 0 rad/s; expected in (0, 5]"));
  // count >= 1
  EXPECT_THAT(With("count", Number(1.0)), ElementsAre());
  EXPECT_THAT(With("count", Number(0.0)), ElementsAre("count: got 0; expected >= 1"));
}

TEST(ParamsTest, IntegersReachFromTheSmallestToTheLargest) {
  constexpr int kMost = std::numeric_limits<int>::max();
  EXPECT_EQ(ReadParams<Everything>(MapOf({{"count", Number(kMost)}})).count, kMost);
  EXPECT_THAT(With("count", Number(kMost + 1.0)), ElementsAre(HasSubstr("expected an integer")));
}

TEST(ParamsTest, ListsOfTheWrongLengthAreRefused) {
  EXPECT_THAT(With("axis", ListOf({Number(1.0), Number(2.0)})),
              ElementsAre("axis: got a list of 2; expected a list of 3 numbers"));
  EXPECT_THAT(With("weights", ListOf({})),
              ElementsAre("weights: got a list of 0; expected at least one number"));
  EXPECT_THAT(With("limit", ListOf({})),
              ElementsAre("limit: got a list of 0; expected at least one number"));
}

TEST(ParamsTest, PeriodsAreExactOrRefused) {
  EXPECT_EQ(ReadParams<Everything>(MapOf({{"count", Number(1)}, {"period", Number(0.3)}})).period,
            Period(3, 10));
  EXPECT_THAT(With("period", Number(std::sqrt(2.0))),
              ElementsAre(HasSubstr("period: period: got 1.414")));
}

TEST(ParamsTest, AFrequencyMayStandForAPeriod) {
  const auto period_at = [](double hertz) {
    return ReadParams<Everything>(MapOf({{"count", Number(1)}, {"frequency", Number(hertz)}}))
        .period;
  };
  EXPECT_EQ(period_at(60.0), Period(1, 60));
  EXPECT_EQ(period_at(0.5), Period(2, 1));
  EXPECT_EQ(period_at(29.97), Period(100, 2997));
  EXPECT_THAT(With("frequency", Number(0.0)), ElementsAre("frequency: got 0 Hz; expected > 0"));
  EXPECT_THAT(With("frequency", Text("fast")),
              ElementsAre("frequency: got 'fast'; expected a number in Hz"));
  EXPECT_THAT(With("frequency", Number(std::sqrt(2.0))),
              ElementsAre(HasSubstr("expected a ratio of integers")));
}

TEST(ParamsTest, PeriodAndFrequencyTogetherAreRefused) {
  EXPECT_THAT(ProblemsOf<Everything>(MapOf(
                  {{"count", Number(1)}, {"period", Number(0.1)}, {"frequency", Number(10.0)}})),
              ElementsAre("frequency: got it beside period; expected one of the two"));
}

TEST(ParamsTest, AMisspeltFrequencyIsKnown) {
  EXPECT_THAT(With("frequncy", Number(10.0)),
              ElementsAre(HasSubstr("frequncy: unknown key; did you mean 'frequency'?")));
}

TEST(ParamsTest, UnknownKeysAreRefusedWithTheNearestAndAllKnown) {
  EXPECT_THAT(ProblemsOf<Waypoint>(MapOf({{"time", Number(1.0)}, {"positon", Number(1.0)}})),
              ElementsAre("positon: unknown key; did you mean 'position'?; known: time, position"));
  EXPECT_THAT(ProblemsOf<Waypoint>(MapOf({{"time", Number(1.0)}, {"zzz", Number(1.0)}})),
              ElementsAre("zzz: unknown key; known: time, position"));
}

TEST(ParamsTest, ProblemsInsideNameTheWholePath) {
  EXPECT_THAT(With("waypoints", ListOf({MapOf({{"time", Number(0.0)}}), MapOf({}),
                                        MapOf({{"time", Text("now")}, {"x", Number(1.0)}})})),
              ElementsAre("waypoints[1].time: missing; expected number",
                          "waypoints[2].time: got 'now'; expected a number in s",
                          "waypoints[2].x: unknown key; known: time, position"));
  EXPECT_THAT(With("start", MapOf({{"time", Number(-1.0)}})),
              ElementsAre("start.time: got -1 s; expected >= 0"));
  EXPECT_THAT(With("ignore", ListOf({ListOf({Number(1.0)})})),
              ElementsAre("ignore[0][0]: got 1; expected text"));
}

TEST(ParamsTest, AllProblemsComeAtOnceEachWithFileLineAndColumn) {
  const auto file = std::make_shared<const std::string>("arm.yaml");
  const auto at = [&](int line, int column) { return Location{file, line, column}; };
  Value::Map map;
  const auto add = [&](const char* key, int line, Value::Data data, int column) {
    map.push_back({key, at(line, 3), Value(std::move(data), at(line, column))});
  };
  add("gain", 2, -1.0, 9);
  add("enabeld", 3, true, 12);
  add("name", 4, std::int64_t{5}, 9);
  const Value value(std::move(map), at(1, 1));
  try {
    ReadParams<Everything>(value, "systems.field");
    FAIL();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_THAT(text, HasSubstr("arm.yaml:2:9: error: systems.field.gain: got -1 N m^2; expected "
                                "in [0, 10]\n"));
    EXPECT_THAT(text, HasSubstr("arm.yaml:3:3: error: systems.field.enabeld: unknown key; did you "
                                "mean 'enabled'?"));
    EXPECT_THAT(text, HasSubstr("arm.yaml:4:9: error: systems.field.name: got 5; expected text"));
    EXPECT_THAT(text, HasSubstr("arm.yaml:1:1: error: systems.field.count: missing; expected "
                                "integer"));
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  }
}

TEST(BoundsTest, ReadAsAPersonWouldWriteThem) {
  EXPECT_EQ(Bounds{}.ToString(), "");
  EXPECT_EQ((Bounds{.lower = 0.0}.ToString()), ">= 0");
  EXPECT_EQ((Bounds{.lower = 0.0, .above = true}.ToString()), "> 0");
  EXPECT_EQ((Bounds{.upper = 2.5}.ToString()), "<= 2.5");
  EXPECT_EQ((Bounds{.lower = 0.0, .upper = 1.0}.ToString()), "in [0, 1]");
  EXPECT_EQ((Bounds{.lower = 0.0, .upper = 1.0, .above = true}.ToString()), "in (0, 1]");
  EXPECT_FALSE(Bounds{}.Contains(kNan));
}

}  // namespace params_test
}  // namespace oca
