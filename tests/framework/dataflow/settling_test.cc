// SPDX-License-Identifier: BSD-3-Clause
// Sizes and units of ports, settled along the wiring.
#include <gmock/gmock.h>

#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace settling_test {

using blocks::ProblemsOf;
using blocks::Vec;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr int kJoints = 7;

/// out = in per second: a rate variable.
class Differentiator final : public System {
 public:
  Differentiator()
      : unit_(DeclareUnit()),
        in(DeclareInput<Vector>("in", {1, unit_})),
        out(DeclareOutput<Vector, &Differentiator::Calc>("out", {1, unit_.Rate()}, in)) {}

 private:
  const Unit unit_;
  void Calc(VectorView x, MutableVectorView y) const { y = x; }

 public:
  const Input<Vector> in;
  const Output<Vector> out;
};

TEST(SettlingTest, SixAgainstSevenJointsIsRefusedAndSevenAgainstSevenIsNot) {
  for (const int size : {kJoints - 1, kJoints, kJoints + 1}) {
    DiagramBuilder builder;
    const auto& source = builder.Add<blocks::Source>("source", Eigen::VectorXd::Zero(size));
    const auto& sink = builder.Add<blocks::Sink>("sink", kJoints);
    builder.Connect(source.value, sink.in);
    if (size == kJoints) {
      EXPECT_THAT(ProblemsOf(builder), IsEmpty());
    } else {
      EXPECT_THAT(ProblemsOf(builder), ElementsAre("source.value -> sink.in: size; got " +
                                                   std::to_string(size) + "; expected 7"));
    }
  }
}

TEST(SettlingTest, RadiansAgainstMetresIsRefused) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}), "rad");
  const auto& sink = builder.Add<blocks::Sink>("sink", 1, "m");
  builder.Connect(source.value, sink.in);
  EXPECT_THAT(ProblemsOf(builder),
              ElementsAre("source.value -> sink.in: unit; got rad; expected m"));
}

TEST(SettlingTest, AnyUnitConnectsToEveryUnit) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}), "rad");
  const auto& free = builder.Add<blocks::Source>("free", Vec({1.0}));
  builder.Connect(source.value, builder.Add<blocks::Sink>("any", 1).in);
  builder.Connect(free.value, builder.Add<blocks::Sink>("metres", 1, "m").in);
  EXPECT_THAT(ProblemsOf(builder), IsEmpty());
}

TEST(SettlingTest, ARateVariableTellsRadiansFromRadiansPerSecond) {
  for (const char* unit : {"rad/s", "rad", "rad/s^2"}) {
    DiagramBuilder builder;
    const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}), "rad");
    const auto& rate = builder.Add<Differentiator>("rate");
    const auto& sink = builder.Add<blocks::Sink>("sink", 1, unit);
    builder.Connect(source.value, rate.in);
    builder.Connect(rate.out, sink.in);
    if (unit == std::string("rad/s")) {
      EXPECT_THAT(ProblemsOf(builder), IsEmpty());
    } else {
      EXPECT_THAT(
          ProblemsOf(builder),
          ElementsAre(std::string("rate.out -> sink.in: unit; got rad/s; expected ") + unit));
    }
  }
}

TEST(SettlingTest, ARateVariableIsSettledFromItsOutputToo) {
  for (const char* unit : {"rad", "m"}) {
    DiagramBuilder builder;
    const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}), unit);
    const auto& map = builder.Add<blocks::Map>("map");
    const auto& rate = builder.Add<Differentiator>("rate");
    const auto& sink = builder.Add<blocks::Sink>("sink", 1, "rad/s");
    builder.Connect(rate.out, sink.in);
    builder.Connect(map.out, rate.in);
    builder.Connect(source.value, map.in);
    EXPECT_EQ(ProblemsOf(builder).empty(), unit == std::string("rad"));
  }
}

TEST(SettlingTest, RatesTakenTwiceAreSecondDerivatives) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}), "m");
  const auto& first = builder.Add<Differentiator>("first");
  const auto& second = builder.Add<Differentiator>("second");
  builder.Connect(source.value, first.in);
  builder.Connect(first.out, second.in);
  builder.Connect(second.out, builder.Add<blocks::Sink>("good", 1, "m/s^2").in);
  builder.Connect(second.out, builder.Add<blocks::Sink>("bad", 1, "m/s").in);
  EXPECT_THAT(ProblemsOf(builder),
              ElementsAre("second.out -> bad.in: unit; got m/s^2; expected m/s"));
}

TEST(SettlingTest, AUnitWhoseRateWouldBeAPlainUnitReadsAsAProduct) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}), "m");
  const auto& rate = builder.Add<Differentiator>("rate");
  builder.Connect(rate.out, builder.Add<blocks::Sink>("sink", 1, "rad").in);
  builder.Connect(source.value, rate.in);
  const auto problems = ProblemsOf(builder);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_THAT(problems[0], testing::AnyOf(HasSubstr("got m; expected rad s"),
                                          HasSubstr("got m/s; expected rad")));
}

TEST(SettlingTest, SizesAndUnitsPassThroughChainsFromTheSource) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Eigen::VectorXd::Ones(kJoints), "rad");
  const auto& first = builder.Add<blocks::Map>("first");
  const auto& second = builder.Add<blocks::Map>("second");
  const auto& sink = builder.Add<blocks::Sink>("sink", 6, "m");
  // Deliberately not in the order of the signal.
  builder.Connect(second.out, sink.in);
  builder.Connect(first.out, second.in);
  builder.Connect(source.value, first.in);
  // Which connection of a chain is to blame is a matter of taste; the two numbers are not.
  const auto problems = ProblemsOf(builder);
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_THAT(problems[0], HasSubstr("size; got 7; expected 6"));
  EXPECT_THAT(problems[1], HasSubstr("unit; got rad; expected m"));
}

TEST(SettlingTest, SizesPassThroughChainsFromTheSink) {
  DiagramBuilder builder;
  const auto& map = builder.Add<blocks::Map>("map");
  const auto& sink = builder.Add<blocks::Sink>("sink", kJoints);
  builder.ExportInput("u", map.in);
  builder.Connect(map.out, sink.in);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  EXPECT_THROW(diagram->GetInput<Vector>("u").Fix(context, Eigen::VectorXd::Ones(6)), ConfigError);
  diagram->GetInput<Vector>("u").Fix(context, Eigen::VectorXd::Ones(7));
  EXPECT_EQ(map.out.Eval(context).size(), kJoints);
}

TEST(SettlingTest, AnExportedInputCarriesOneSizeAndUnitToAllItReaches) {
  DiagramBuilder builder;
  builder.ExportInput("u", builder.Add<blocks::Sink>("a", 6, "rad").in);
  builder.ExportInput("u", builder.Add<blocks::Sink>("b", 7, "m").in);
  EXPECT_THAT(ProblemsOf(builder), UnorderedElementsAre("a.in -> b.in: size; got 6; expected 7",
                                                        "a.in -> b.in: unit; got rad; expected m"));
}

TEST(SettlingTest, AVectorThatNothingSettlesHasOneComponent) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Map>());
  Context context = diagram->MakeContext();
  EXPECT_EQ(diagram->GetOutput<Vector>("out").system, diagram->FindSystem("system"));
  EXPECT_THROW(diagram->GetInput<Vector>("in").Fix(context, Vec({1.0, 2.0})), ConfigError);
  EXPECT_NO_THROW(diagram->GetInput<Vector>("in").Fix(context, Vec({1.0})));
}

}  // namespace settling_test
}  // namespace oca
