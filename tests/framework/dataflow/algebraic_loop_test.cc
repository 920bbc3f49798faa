// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace algebraic_loop_test {

using blocks::ProblemsOf;
using testing::ElementsAre;
using testing::IsEmpty;

const char* const kAdvice = "; break it with a delay, a hold or any system whose output is a state";

TEST(AlgebraicLoopTest, IsShownAsAPathWithTheAdviceWhereAStateWouldBreakIt) {
  DiagramBuilder builder;
  const auto& a = builder.Add<blocks::Map>("a");
  const auto& b = builder.Add<blocks::Map>("b");
  builder.Connect(a.out, b.in);
  builder.Connect(b.out, a.in);
  EXPECT_THAT(ProblemsOf(builder),
              ElementsAre(std::string("algebraic loop: a.out -> b.in -> b.out -> a.in -> a.out") +
                          kAdvice));
}

TEST(AlgebraicLoopTest, BeginsAtTheSystemThatWasAddedFirstWhateverLeadsToIt) {
  DiagramBuilder builder;
  const auto& before = builder.Add<blocks::Map>("before");
  const auto& x = builder.Add<blocks::Map>("x");
  const auto& y = builder.Add<blocks::Map>("y");
  const auto& z = builder.Add<blocks::Map>("z");
  builder.Connect(y.out, before.in);
  builder.Connect(x.out, y.in);
  builder.Connect(y.out, z.in);
  builder.Connect(z.out, x.in);
  EXPECT_THAT(
      ProblemsOf(builder),
      ElementsAre(std::string("algebraic loop: x.out -> y.in -> y.out -> z.in -> z.out -> x.in -> "
                              "x.out") +
                  kAdvice));
}

TEST(AlgebraicLoopTest, OfOneSystemIsFoundToo) {
  DiagramBuilder builder;
  const auto& a = builder.Add<blocks::Map>("a");
  builder.Connect(a.out, a.in);
  EXPECT_THAT(ProblemsOf(builder),
              ElementsAre(std::string("algebraic loop: a.out -> a.in -> a.out") + kAdvice));
}

TEST(AlgebraicLoopTest, ShowsOnlyTheSystemsOnTheLoop) {
  DiagramBuilder builder;
  const auto& clock = builder.Add<blocks::Clock>("clock");
  const auto& before = builder.Add<blocks::Map>("before");
  const auto& sum = builder.Add<blocks::Sum>("sum");
  const auto& back = builder.Add<blocks::Map>("back");
  const auto& after = builder.Add<blocks::Map>("after");
  builder.Connect(clock.value, before.in);
  builder.Connect(before.out, sum.in0);
  builder.Connect(back.out, sum.in1);
  builder.Connect(sum.out, back.in);
  builder.Connect(back.out, after.in);
  EXPECT_THAT(
      ProblemsOf(builder),
      ElementsAre(
          std::string("algebraic loop: sum.out -> back.in -> back.out -> sum.in1 -> sum.out") +
          kAdvice));
}

TEST(AlgebraicLoopTest, EveryLoopIsToldThoseBehindAnotherToo) {
  DiagramBuilder builder;
  const auto& first = builder.Add<blocks::Map>("first");
  const auto& between = builder.Add<blocks::Map>("between");
  const auto& sum = builder.Add<blocks::Sum>("sum");
  const auto& behind = builder.Add<blocks::Map>("behind");
  const auto& apart = builder.Add<blocks::Map>("apart");
  builder.Connect(first.out, first.in);
  builder.Connect(first.out, between.in);
  builder.Connect(between.out, sum.in0);
  builder.Connect(sum.out, sum.in1);
  builder.Connect(sum.out, behind.in);
  builder.Connect(apart.out, apart.in);
  EXPECT_THAT(
      ProblemsOf(builder),
      ElementsAre(std::string("algebraic loop: first.out -> first.in -> first.out") + kAdvice,
                  std::string("algebraic loop: sum.out -> sum.in1 -> sum.out") + kAdvice,
                  std::string("algebraic loop: apart.out -> apart.in -> apart.out") + kAdvice));
}

TEST(AlgebraicLoopTest, ThroughANestedDiagramNamesThePathsInside) {
  DiagramBuilder inner;
  const auto& map = inner.Add<blocks::Map>("map");
  inner.ExportInput("u", map.in);
  inner.ExportOutput("y", map.out);
  DiagramBuilder builder;
  const System& nested = builder.AddSystem("nested", inner.Build());
  builder.ConnectPorts(nested.FindOutput("y"), nested.FindInput("u"));
  EXPECT_THAT(
      ProblemsOf(builder),
      ElementsAre(std::string("algebraic loop: nested.map.out -> nested.map.in -> nested.map.out") +
                  kAdvice));
}

TEST(AlgebraicLoopTest, IsBrokenByADiscreteState) {
  DiagramBuilder builder;
  const auto& a = builder.Add<blocks::Map>("a");
  const auto& delay = builder.Add<blocks::Delay>("delay", Every{Period(1, 10)});
  builder.Connect(a.out, delay.in);
  builder.Connect(delay.out, a.in);
  EXPECT_THAT(ProblemsOf(builder), IsEmpty());
}

TEST(AlgebraicLoopTest, IsBrokenByAContinuousState) {
  DiagramBuilder builder;
  const auto& ode =
      builder.Add<blocks::Ode>("ode", 1.0, [](double, double, double u) { return u; });
  const auto& a = builder.Add<blocks::Map>("a");
  builder.Connect(ode.out, a.in);
  builder.Connect(a.out, ode.in);
  EXPECT_THAT(ProblemsOf(builder), IsEmpty());
}

/// Two independent ways through one system: out0 = in0, out1 = in1.
class Crossing final : public System {
 public:
  Crossing()
      : in0(DeclareInput<Vector>("in0")),
        in1(DeclareInput<Vector>("in1")),
        out0(DeclareOutput<Vector, &Crossing::Calc>("out0", {}, in0)),
        out1(DeclareOutput<Vector, &Crossing::Calc>("out1", {}, in1)) {}

 private:
  void Calc(VectorView x, MutableVectorView y) const { y = x; }

 public:
  const Input<Vector> in0, in1;
  const Output<Vector> out0, out1;
};

TEST(AlgebraicLoopTest, IsJudgedPortByPortNotSystemBySystem) {
  DiagramBuilder builder;
  const auto& clock = builder.Add<blocks::Clock>("clock", [](double) { return 5.0; });
  const auto& crossing = builder.Add<Crossing>("crossing");
  builder.Connect(clock.value, crossing.in0);
  builder.Connect(crossing.out0, crossing.in1);
  const auto diagram = builder.Build();
  EXPECT_EQ(crossing.out1.Eval(diagram->MakeContext())[0], 5.0);
}

}  // namespace algebraic_loop_test
}  // namespace oca
