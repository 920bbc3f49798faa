// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <limits>
#include <memory>
#include <string>

#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace wiring_test {

using blocks::ProblemsOf;
using blocks::Vec;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

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

TEST(WiringTest, AnEmptyDiagramIsADiagram) {
  const auto diagram = DiagramBuilder().Build();
  EXPECT_EQ(diagram->MakeContext().time(), 0.0);
}

/// A map whose input a diagram exports by a name that is a path.
std::unique_ptr<Diagram> Imports(const std::string& name) {
  DiagramBuilder builder;
  const auto& map = builder.Add<blocks::Map>("map", [](double x) { return 2.0 * x; });
  builder.Add<blocks::Source>("source", Vec({1.0}));
  builder.ExportInput(name, map.in);
  return builder.Build();
}

TEST(ExportedPathTest, IsFoundAsItIsWrittenThroughNestingToo) {
  const auto diagram = Imports("left.plant.position");
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("left.plant.position").Fix(context, Vec({3.0}));
  EXPECT_EQ(diagram->GetOutput<Vector>("map.out").Eval(context)[0], 6.0);
  EXPECT_EQ(diagram->PathOf(diagram->FindInput("left.plant.position")), "left.plant.position");

  DiagramBuilder builder;
  const System& part = builder.AddSystem("part", Imports("left.plant.position"));
  builder.ExportInput("q", part.FindInput("left.plant.position"));
  const auto root = builder.Build();
  EXPECT_EQ(root->FindInput("part.left.plant.position"), part.FindInput("left.plant.position"));
  EXPECT_EQ(root->ExportOf(root->FindInput("part.left.plant.position")), root->FindInput("q"));
}

TEST(ExportedPathTest, LeadsToNoOtherPortInside) {
  EXPECT_NO_THROW(Imports("map.in"));
  for (const char* taken : {"map.out", "map.other", "source.value"}) {
    EXPECT_THAT([&] { Imports(taken); }, testing::ThrowsMessage<WiringError>(
                                             HasSubstr(std::string("exported input '") + taken +
                                                       "': got another port than the one inside")))
        << taken;
  }
  for (const char* none : {"", ".", "a.", ".a", "a..b", "a b.c"}) {
    EXPECT_THROW(Imports(none), WiringError) << none;
  }
}

}  // namespace wiring_test
}  // namespace oca
