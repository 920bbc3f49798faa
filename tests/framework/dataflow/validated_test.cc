// SPDX-License-Identifier: BSD-3-Clause
// Structs that are filled in C++ pass the same declaration as files.
#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/params.h"
#include "tests/framework/dataflow/example_params.h"

namespace oca {
namespace validated_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Everything Good() {
  Everything params;
  params.count = 3;
  return params;
}

/// What is said of the struct after `change`; "" if it is taken.
template <class Change>
std::string Refusal(Change change) {
  Everything params = Good();
  change(params);
  try {
    Validated(params);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ValidatedTest, ReturnsTheStructItselfIfItIsGood) {
  const Everything params = Good();
  EXPECT_EQ(&Validated(params), &params);
}

TEST(ValidatedTest, DrawsTheLineAtTheBounds) {
  EXPECT_EQ(Refusal([](Everything& p) { p.gain = 0.0; }), "");
  EXPECT_EQ(Refusal([](Everything& p) { p.gain = 10.0; }), "");
  EXPECT_EQ(Refusal([](Everything& p) { p.gain = -0.5; }),
            "gain: got -0.5 N m^2; expected in [0, 10]");
  EXPECT_EQ(Refusal([](Everything& p) { p.gain = 10.5; }),
            "gain: got 10.5 N m^2; expected in [0, 10]");
  EXPECT_THAT(Refusal([](Everything& p) { p.period = Period(0, 1); }), HasSubstr("period: got 0"));
}

TEST(ValidatedTest, ARequiredFieldMayNotKeepADefaultThatIsOutOfBounds) {
  EXPECT_THAT(Refusal([](Everything& p) { p.count = Everything().count; }), HasSubstr("count: "));
}

TEST(ValidatedTest, RefusesWhatIsNotFiniteUnlessItIsTheDefault) {
  EXPECT_THAT(Refusal([](Everything& p) { p.gain = kNaN; }),
              HasSubstr("gain: got nan; expected a finite number"));
  EXPECT_THAT(Refusal([](Everything& p) { p.gain = kInfinity; }), HasSubstr("gain: got inf"));
  EXPECT_THAT(Refusal([](Everything& p) { p.reach = kNaN; }), HasSubstr("reach: got nan"));
  EXPECT_THAT(Refusal([](Everything& p) { p.unset = kInfinity; }), HasSubstr("unset: got inf"));
  // Everything's reach is infinite and unset is NaN where nobody sets them.
  EXPECT_EQ(Refusal([](Everything&) {}), "");
}

TEST(ValidatedTest, NamesTheItemOfAListAndTheMemberOfAStruct) {
  EXPECT_THAT(Refusal([](Everything& p) { p.axis[1] = kNaN; }), HasSubstr("axis[1]: got nan"));
  EXPECT_THAT(Refusal([](Everything& p) {
                p.limit = PerComponent(Eigen::VectorXd(Eigen::Vector2d(1.0, -1.0)));
              }),
              HasSubstr("limit[1]: got -1"));
  EXPECT_THAT(Refusal([](Everything& p) { p.limit = PerComponent(Eigen::VectorXd()); }),
              HasSubstr("limit: got a list of 0"));
  EXPECT_THAT(Refusal([](Everything& p) {
                p.waypoints = {{1.0, 0.0}, {-1.0, 0.0}};
              }),
              HasSubstr("waypoints[1].time: got -1"));
  EXPECT_THAT(Refusal([](Everything& p) { p.start.time = -2.0; }), HasSubstr("start.time: got -2"));
  EXPECT_THAT(Refusal([](Everything& p) { p.ceiling = kNaN; }), HasSubstr("ceiling: got nan"));
}

TEST(ValidatedTest, RefusesAnEnumeratorThatHasNoName) {
  EXPECT_EQ(Refusal([](Everything& p) { p.method = static_cast<decltype(p.method)>(7); }),
            "method: got 7; expected one of transpose, damped");
}

TEST(ValidatedTest, TellsAllProblemsALineEach) {
  EXPECT_EQ(Refusal([](Everything& p) {
              p.gain = -1.0;
              p.axis[0] = kInfinity;
            }),
            "gain: got -1 N m^2; expected in [0, 10]\naxis[0]: got inf; expected a finite number");
}

struct Inner {
  double depth{1.0};
  static void Describe(Fields<Inner>& fields) {
    fields.Add("depth", &Inner::depth, "m", "how deep").Above(0.0);
  }
};
struct Outer {
  double width{1.0};
  Inner inner{};
  static void Describe(Fields<Outer>& fields) {
    fields.Add("width", &Outer::width, "m", "how wide");
    fields.Include(&Outer::inner);
  }
};

TEST(IncludedFieldsTest, AreThoseOfTheStructAround) {
  ASSERT_EQ(FieldsOf<Outer>().size(), 2u);
  Outer outer;
  outer.inner.depth = 3.0;
  EXPECT_EQ(JsonOfFields(FieldsOf<Outer>(), &outer).dump(), R"({"width":1,"depth":3})");
  *static_cast<double*>(FieldsOf<Outer>()[1].member(&outer)) = -3.0;
  EXPECT_THAT([&] { Validated(outer); },
              ThrowsMessage<ConfigError>(HasSubstr("depth: got -3 m; expected > 0")));
}

/// A block whose author did not think of bounds.
class Tank final : public System {
 public:
  using Params = Inner;
  explicit Tank(const Params& params) : depth(params.depth) {}
  const double depth;
};

TEST(ValidatedTest, ABuilderAddsNoBlockWhoseParametersAreOutOfBounds) {
  DiagramBuilder builder;
  EXPECT_THAT([&] { builder.Add<Tank>("tank", {.depth = -1.0}); },
              ThrowsMessage<ConfigError>(HasSubstr("depth: got -1 m; expected > 0")));
  EXPECT_EQ(builder.Add<Tank>("tank", {.depth = 2.0}).depth, 2.0);
}

}  // namespace validated_test
}  // namespace oca
