// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <limits>

#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace wiring_test {

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

/// out = in, or -1 while nothing is connected.
class Optional final : public System {
 public:
  Optional()
      : in(DeclareOptionalInput<Vector>("in", {1})),
        label(DeclareOptionalInput<Label>("label")),
        out(DeclareOutput<Vector, &Optional::Calc>("out", {1}, in, label)) {}

 private:
  void Calc(const std::optional<VectorView>& x, const Label* text, MutableVectorView y) const {
    y[0] = (x ? (*x)[0] : -1.0) + (text == nullptr ? 0.0 : 100.0);
  }

 public:
  const OptionalInput<Vector> in;
  const OptionalInput<Label> label;
  const Output<Vector> out;
};

TEST(WiringTest, AnInputNobodyDrivesIsReported) {
  DiagramBuilder builder;
  builder.Add<blocks::Map>("map");
  EXPECT_THAT(ProblemsOf(builder),
              ElementsAre("map.in: input not connected; expected an output of type Vector"));
}

TEST(WiringTest, TwoDriversOfOneInputAreReportedByName) {
  DiagramBuilder builder;
  const auto& a = builder.Add<blocks::Source>("a", Vec({1.0}));
  const auto& b = builder.Add<blocks::Source>("b", Vec({2.0}));
  const auto& map = builder.Add<blocks::Map>("map");
  builder.Connect(a.value, map.in);
  builder.Connect(b.value, map.in);
  EXPECT_THAT(ProblemsOf(builder),
              ElementsAre("map.in: two drivers; got a.value and b.value; expected one"));
}

TEST(WiringTest, AnExportIsADriverToo) {
  DiagramBuilder builder;
  const auto& a = builder.Add<blocks::Source>("a", Vec({1.0}));
  const auto& map = builder.Add<blocks::Map>("map");
  builder.Connect(a.value, map.in);
  builder.ExportInput("u", map.in);
  EXPECT_THAT(
      ProblemsOf(builder),
      ElementsAre("map.in: two drivers; got a.value and the exported input 'u'; expected one"));
}

TEST(WiringTest, SixAgainstSevenJointsIsRefusedAndSevenAgainstSevenIsNot) {
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

TEST(WiringTest, RadiansAgainstMetresIsRefused) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}), "rad");
  const auto& sink = builder.Add<blocks::Sink>("sink", 1, "m");
  builder.Connect(source.value, sink.in);
  EXPECT_THAT(ProblemsOf(builder),
              ElementsAre("source.value -> sink.in: unit; got rad; expected m"));
}

TEST(WiringTest, AnyUnitConnectsToEveryUnit) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}), "rad");
  const auto& free = builder.Add<blocks::Source>("free", Vec({1.0}));
  builder.Connect(source.value, builder.Add<blocks::Sink>("any", 1).in);
  builder.Connect(free.value, builder.Add<blocks::Sink>("metres", 1, "m").in);
  EXPECT_THAT(ProblemsOf(builder), IsEmpty());
}

TEST(WiringTest, ARateVariableTellsRadiansFromRadiansPerSecond) {
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

TEST(WiringTest, ARateVariableIsSettledFromItsOutputToo) {
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

TEST(WiringTest, RatesTakenTwiceAreSecondDerivatives) {
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

TEST(WiringTest, AUnitWhoseRateWouldBeAPlainUnitReadsAsAProduct) {
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

TEST(WiringTest, SizesAndUnitsPassThroughChainsFromTheSource) {
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

TEST(WiringTest, SizesPassThroughChainsFromTheSink) {
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

TEST(WiringTest, AnExportedInputCarriesOneSizeAndUnitToAllItReaches) {
  DiagramBuilder builder;
  builder.ExportInput("u", builder.Add<blocks::Sink>("a", 6, "rad").in);
  builder.ExportInput("u", builder.Add<blocks::Sink>("b", 7, "m").in);
  EXPECT_THAT(ProblemsOf(builder), UnorderedElementsAre("a.in -> b.in: size; got 6; expected 7",
                                                        "a.in -> b.in: unit; got rad; expected m"));
}

TEST(WiringTest, AVectorThatNothingSettlesHasOneComponent) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Map>());
  Context context = diagram->MakeContext();
  EXPECT_EQ(diagram->GetOutput<Vector>("out").system, diagram->FindSystem("system"));
  EXPECT_THROW(diagram->GetInput<Vector>("in").Fix(context, Vec({1.0, 2.0})), ConfigError);
  EXPECT_NO_THROW(diagram->GetInput<Vector>("in").Fix(context, Vec({1.0})));
}

TEST(WiringTest, OptionalInputsMayStayUnconnected) {
  DiagramBuilder builder;
  const auto& alone = builder.Add<Optional>("alone");
  const auto& wired = builder.Add<Optional>("wired");
  const auto& source = builder.Add<blocks::Source>("source", Vec({4.0}));
  const auto& labeller = builder.Add<blocks::Labeller>("labeller", Every{Period(1, 1)});
  builder.Connect(source.value, wired.in);
  builder.Connect(source.value, labeller.in);
  builder.Connect(labeller.text, wired.label);
  const auto diagram = builder.Build();
  const Context context = diagram->MakeContext();
  EXPECT_EQ(alone.out.Eval(context)[0], -1.0);
  EXPECT_EQ(wired.out.Eval(context)[0], 104.0);
}

TEST(WiringTest, TwoSystemsOfOneNameAreRefused) {
  DiagramBuilder builder;
  builder.Add<blocks::Clock>("same");
  EXPECT_THROW(builder.Add<blocks::Clock>("same"), WiringError);
}

TEST(WiringTest, NamesAreLettersDigitsAndUnderscores) {
  DiagramBuilder builder;
  for (const char* name : {"", "a.b", "a b", "a-b", "\xc3\xa4"}) {
    EXPECT_THROW(builder.Add<blocks::Clock>(name), WiringError) << name;
  }
  EXPECT_NO_THROW(builder.Add<blocks::Clock>("Joint_1"));
}

TEST(WiringTest, NothingInPlaceOfASystemIsRefused) {
  DiagramBuilder builder;
  EXPECT_THROW(builder.AddSystem("nothing", nullptr), WiringError);
}

TEST(WiringTest, PortsOfSystemsOutsideTheDiagramAreRefused) {
  const blocks::Source outside_source(Vec({1.0}));
  const blocks::Map outside_map;
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}));
  const auto& map = builder.Add<blocks::Map>("map");
  builder.Connect(outside_source.value, map.in);
  builder.Connect(source.value, outside_map.in);
  EXPECT_THAT(ProblemsOf(builder),
              testing::IsSupersetOf({HasSubstr("an output of a system outside this diagram"),
                                     HasSubstr("an input of a system outside this diagram")}));
}

TEST(WiringTest, ExportedPortsOfSystemsOutsideTheDiagramAreRefused) {
  const blocks::Map outside;
  DiagramBuilder builder;
  builder.ExportInput("u", outside.in);
  builder.ExportOutput("y", outside.out);
  EXPECT_THAT(ProblemsOf(builder),
              UnorderedElementsAre(HasSubstr("'u': an input of a system outside this diagram"),
                                   HasSubstr("'y': an output of a system outside this diagram")));
}

TEST(WiringTest, AnInitialValueOfAnotherLengthThanItsStateIsReported) {
  struct Stateful : System {
    explicit Stateful(PerComponent initial) {
      const auto state = DeclareDiscreteState("state", {3}, std::move(initial));
      DeclareStateOutput("out", state);
    }
  };
  DiagramBuilder builder;
  builder.Add<Stateful>("good", Vec({1.0, 2.0, 3.0}));
  builder.Add<Stateful>("scalar", 1.0);
  builder.Add<Stateful>("bad", Vec({1.0, 2.0}));
  builder.Add<Stateful>("nan", std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(
      ProblemsOf(builder),
      ElementsAre("bad.state: initial value; got 2 numbers; expected 3",
                  "nan.state: initial value; got a NaN or an infinity; expected finite numbers"));
}

TEST(WiringTest, AContinuousStateNeedsADerivative) {
  struct Idle : System {
    Idle() { DeclareContinuousState("x", {1}, 0.0); }
  };
  DiagramBuilder builder;
  builder.Add<Idle>("idle");
  EXPECT_THAT(ProblemsOf(builder), ElementsAre("idle.x: continuous state without a derivative"));
}

TEST(WiringTest, AllProblemsOfADiagramAreListedAtOnce) {
  DiagramBuilder builder;
  const auto& six = builder.Add<blocks::Source>("six", Eigen::VectorXd::Zero(6), "rad");
  const auto& seven = builder.Add<blocks::Sink>("seven", 7, "m");
  const auto& label = builder.Add<blocks::LabelSink>("label");
  builder.Add<blocks::Map>("lonely");
  const auto& a = builder.Add<blocks::Map>("a");
  const auto& b = builder.Add<blocks::Map>("b");
  const auto& twice = builder.Add<blocks::Sink>("twice", 6);
  builder.Connect(six.value, seven.in);
  builder.ConnectPorts(six.value, label.in);
  builder.Connect(a.out, b.in);
  builder.Connect(b.out, a.in);
  builder.Connect(six.value, twice.in);
  builder.Connect(six.value, twice.in);
  EXPECT_THAT(ProblemsOf(builder), UnorderedElementsAre(HasSubstr("six.value -> seven.in: size"),
                                                        HasSubstr("six.value -> seven.in: unit"),
                                                        HasSubstr("six.value -> label.in: type"),
                                                        HasSubstr("lonely.in: input not connected"),
                                                        HasSubstr("twice.in: two drivers"),
                                                        HasSubstr("algebraic loop")));
}

TEST(WiringTest, ADiagramCanBeMendedAfterARefusedBuild) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({3.0}));
  const auto& map = builder.Add<blocks::Map>("map");
  EXPECT_THROW(builder.Build(), WiringError);
  builder.Connect(source.value, map.in);
  const auto diagram = builder.Build();
  EXPECT_EQ(map.out.Eval(diagram->MakeContext())[0], 3.0);
}

TEST(WiringTest, APortOfAnotherDiagramIsRefusedAtRunTime) {
  const auto one = MakeDiagramOf(std::make_unique<blocks::Map>());
  const auto other = MakeDiagramOf(std::make_unique<blocks::Map>());
  Context context = one->MakeContext();
  EXPECT_THROW(other->GetInput<Vector>("in").Fix(context, Vec({1.0})), WiringError);
  EXPECT_THROW(other->GetOutput<Vector>("out").Eval(context), WiringError);
  EXPECT_THROW(Output<Vector>().Eval(context), WiringError);
}

TEST(WiringTest, OnlyAnExportedInputCanBeFixed) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({3.0}));
  const auto& map = builder.Add<blocks::Map>("map");
  builder.Connect(source.value, map.in);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  EXPECT_THROW(map.in.Fix(context, Vec({1.0})), WiringError);
}

/// A system that uses ports and states of `Of`, its own or those of another one, in one place.
class Borrower final : public System {
 public:
  enum class Use {
    kInput,
    kOutput,
    kState,
    kDerivative,
    kDriven,
    kWitness,
    kEvent,
    kWritten,
    kShown
  };
  explicit Borrower(Use use, const Borrower* of = nullptr) {
    if (of == nullptr) of = this;
    x_ = DeclareContinuousState("x", {1}, 0.0);
    s_ = DeclareDiscreteState("s", {1}, 0.0);
    u_ = DeclareInput<Vector>("u", {1});
    y_ = DeclareOutput<Vector, &Borrower::Copy>("y", {1}, u_);
    switch (use) {
      case Use::kInput:
        DeclareOutput<Vector, &Borrower::Copy>("z", {1}, of->u_);
        break;
      case Use::kOutput:
        DeclareOutput<Vector, &Borrower::Copy>("z", {1}, of->y_);
        break;
      case Use::kState:
        DeclareOutput<Vector, &Borrower::Copy>("z", {1}, of->s_);
        break;
      case Use::kDerivative:
        DeclareDerivative<&Borrower::Copy>(x_, of->x_);
        break;
      case Use::kDriven:
        DeclareDerivative<&Borrower::Copy>(of->x_, x_);
        break;
      case Use::kWitness:
        DeclareWitness<&Borrower::First>("w", Direction::kBoth, of->u_);
        break;
      case Use::kEvent:
        DeclareUpdate<&Borrower::Copy>(kEvery, Writes(s_), of->u_);
        break;
      case Use::kWritten:
        DeclareUpdate<&Borrower::Copy>(kEvery, Writes(of->s_), u_);
        break;
      case Use::kShown:
        DeclareStateOutput("z", of->s_);
        break;
    }
  }

 private:
  const Every kEvery{Period(1, 10)};
  void Copy(VectorView from, MutableVectorView to) const { to = from; }
  double First(VectorView from) const { return from[0]; }
  ContinuousState x_;
  DiscreteState<Vector> s_;
  Input<Vector> u_;
  Output<Vector> y_;
};

std::string RefusalOfBorrowing(Borrower::Use use) {
  EXPECT_NO_THROW(Borrower alone(use)) << static_cast<int>(use);
  const Borrower lender(use);
  try {
    const Borrower borrower(use, &lender);
  } catch (const WiringError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(WiringTest, ACalculationThatReadsPortsOrStatesOfAnotherSystemIsRefused) {
  using Use = Borrower::Use;
  const std::string expected = " of another system in place 0; expected one declared before it";
  EXPECT_EQ(RefusalOfBorrowing(Use::kInput), "output 'z': reads; got an input" + expected);
  EXPECT_EQ(RefusalOfBorrowing(Use::kOutput), "output 'z': reads; got an output" + expected);
  EXPECT_EQ(RefusalOfBorrowing(Use::kState), "output 'z': reads; got a state" + expected);
  EXPECT_EQ(RefusalOfBorrowing(Use::kDerivative),
            "derivative of 'x': reads; got a state" + expected);
  EXPECT_EQ(RefusalOfBorrowing(Use::kWitness), "witness 'w': reads; got an input" + expected);
  EXPECT_EQ(RefusalOfBorrowing(Use::kEvent), "update: reads; got an input" + expected);
}

TEST(WiringTest, AStateOfAnotherSystemIsNeitherDrivenNorWrittenNorShown) {
  for (const auto use : {Borrower::Use::kDriven, Borrower::Use::kWritten, Borrower::Use::kShown}) {
    EXPECT_THAT(RefusalOfBorrowing(use), HasSubstr("got one of another system"));
  }
}

TEST(WiringTest, APortReadBeforeItIsDeclaredIsRefused) {
  struct Hasty : System {
    Hasty() { DeclareOutput<Vector, &Hasty::Calc>("out", {1}, in); }
    void Calc(VectorView from, MutableVectorView to) const { to = from; }
    Input<Vector> in;
  };
  EXPECT_THROW(Hasty(), WiringError);
}

TEST(WiringTest, AnEmptyDiagramIsADiagram) {
  const auto diagram = DiagramBuilder().Build();
  EXPECT_EQ(diagram->MakeContext().time(), 0.0);
}

}  // namespace wiring_test
}  // namespace oca
