// SPDX-License-Identifier: BSD-3-Clause
// What is refused is named: a port of no system inside, an empty handle, a type that was asked for.
#include <gmock/gmock.h>

#include "oca/framework/dataflow/control_loop.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "tests/framework/dataflow/blocks.h"
#include "tests/refusal.h"

namespace oca {
namespace named_port_test {

using blocks::ProblemsOf;
using blocks::Vec;
using test::Refusal;
using testing::ElementsAre;

std::unique_ptr<Diagram> OneMap() { return MakeDiagramOf(std::make_unique<blocks::Map>()); }

TEST(NamedPortTest, AConnectionToOutsideNamesBothEnds) {
  const blocks::Source outside_source(Vec({1.0}));
  const blocks::Map outside_map;
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}));
  builder.Connect(outside_source.value, builder.Add<blocks::Map>("map").in);
  builder.Connect(source.value, outside_map.in);
  EXPECT_THAT(
      ProblemsOf(builder),
      testing::IsSupersetOf(
          {"connections: output 'value' -> map.in: an output of a system outside this diagram",
           "connections: source.value -> input 'in': an input of a system outside this diagram"}));
}

TEST(NamedPortTest, AConnectionInANestedDiagramIsToldWithTheOtherEndsPath) {
  DiagramBuilder inner;
  const auto& map = inner.Add<blocks::Map>("map");
  inner.ExportInput("u", map.in);
  DiagramBuilder arm;
  const System& nested = arm.AddSystem("nested", inner.BuildInner());
  arm.ConnectPorts(OutputHandle{}, nested.FindInput("u"));
  DiagramBuilder builder;
  builder.AddSystem("arm", arm.BuildInner());
  EXPECT_THAT(ProblemsOf(builder),
              testing::Contains("arm.connections: an empty handle -> arm.nested.u: got a handle "
                                "that was made by default; expected an output"));
}

TEST(NamedPortTest, AConnectionOfEmptyHandlesSaysSoOfEach) {
  DiagramBuilder builder;
  builder.Connect(Output<Vector>(), Input<Vector>());
  EXPECT_THAT(ProblemsOf(builder),
              ElementsAre("connections: an empty handle -> an empty handle: got a handle that was "
                          "made by default; expected an output",
                          "connections: an empty handle -> an empty handle: got a handle that was "
                          "made by default; expected an input"));
}

TEST(NamedPortTest, AnExportOfNothingOrOfOutsideSaysOfWhat) {
  DiagramBuilder builder;
  EXPECT_EQ(Refusal<WiringError>([&] { builder.ExportInput("u", {}); }),
            "exported input 'u': got a handle that was made by default; expected an input");
  EXPECT_EQ(Refusal<WiringError>([&] { builder.ExportOutput("y", {}); }),
            "exported output 'y': got a handle that was made by default; expected an output");
  const blocks::Map outside;
  builder.ExportInput("u", outside.in);
  builder.ExportOutput("y", outside.out);
  EXPECT_THAT(
      ProblemsOf(builder),
      ElementsAre("exported input 'u': an input of a system outside this diagram, input 'in'",
                  "exported output 'y': an output of a system outside this diagram, output 'out'"));
}

TEST(NamedPortTest, AContextOfAnotherDiagramIsRefusedNamingThePort) {
  const auto diagram = OneMap();
  Context context = diagram->MakeContext();
  const auto other = OneMap();
  EXPECT_EQ(Refusal<WiringError>([&] { other->GetOutput<Vector>("out").Eval(context); }),
            "output 'out': its system is not part of the diagram that made the context");
  EXPECT_EQ(
      Refusal<WiringError>([&] { other->GetInput<Vector>("system.in").Fix(context, Vec({1.0})); }),
      "input 'in': its system is not part of the diagram that made the context");
  EXPECT_EQ(Refusal<WiringError>([&] { Output<Vector>().Eval(context); }),
            "an empty handle: got a handle that was made by default; expected one of the diagram "
            "that made the context");
  EXPECT_EQ(Refusal<WiringError>([&] { ContinuousState().Get(context); }),
            Refusal<WiringError>([&] { Input<Vector>().Fix(context, Vec({1.0})); }));
  EXPECT_EQ(Refusal<WiringError>([&] {
              DiscreteState<Vector>(blocks::Delay(Every{Period(1, 10)}).state).Get(context);
            }),
            "state 'state': its system is not part of the diagram that made the context");
}

TEST(NamedPortTest, AQuestionAboutAPortOfAnotherDiagramNamesIt) {
  const auto diagram = OneMap();
  const auto other = OneMap();
  const std::string outside = ": its system is not part of the diagram that was asked";
  EXPECT_EQ(Refusal<WiringError>([&] { diagram->DriverOf(other->FindInput("system.in")); }),
            "input 'in'" + outside);
  EXPECT_EQ(Refusal<WiringError>([&] { diagram->PathOf(other->FindInput("system.in")); }),
            "input 'in'" + outside);
  EXPECT_EQ(Refusal<WiringError>([&] { diagram->ReadersOf(other->FindOutput("out")); }),
            "output 'out'" + outside);
  const std::string empty =
      "an empty handle: got a handle that was made by default; expected one of the diagram that "
      "was asked";
  EXPECT_EQ(Refusal<WiringError>([&] { diagram->SizeOf(OutputHandle{}); }), empty);
  EXPECT_EQ(Refusal<WiringError>([&] { diagram->PathOf(InputHandle{}); }), empty);
}

TEST(NamedPortTest, ALoopThatCannotSetAnInputSaysWhich) {
  const auto diagram = OneMap();
  ControlLoop loop(*diagram, Period(1, 100));
  const blocks::Map other;
  EXPECT_STREQ(loop.Set(other.in, Vec({1.0})).message(),
               "control loop: input 'in'; got one that the diagram does not export; expected one "
               "that it does");
  EXPECT_STREQ(loop.Set(Input<Vector>(), Vec({1.0})).message(),
               "control loop: input; got a handle that was made by default; expected an input that "
               "the diagram exports");
}

TEST(NamedPortTest, ATypeThatIsNotThePortsIsToldAsWhatWasAskedFor) {
  const auto diagram = OneMap();
  const Context context = diagram->MakeContext();
  EXPECT_EQ(Refusal<WiringError>([&] { diagram->GetOutput<Label>("system.out"); }),
            "output 'system.out' was asked for as Label; it is Vector");
  EXPECT_EQ(Refusal<WiringError>([&] { EvalObject(diagram->FindOutput("out"), context); }),
            "output 'system.out' was asked for as what is no Vector; it is Vector");
  const auto labels = MakeDiagramOf(std::make_unique<blocks::LabelSink>());
  EXPECT_EQ(
      Refusal<WiringError>([&] { EvalVector(labels->FindOutput("out"), labels->MakeContext()); }),
      "output 'system.out' was asked for as Vector; it is Label");
  EXPECT_EQ(Refusal<WiringError>([&] { EvalVector(OutputHandle{}, context); }),
            "an empty handle: got a handle that was made by default; expected one of the diagram "
            "that made the context");
  EXPECT_EQ(Refusal<WiringError>([&] { TypeOfPort(InputHandle{}); }),
            "an empty handle: got a handle that was made by default; expected one of a system");
}

}  // namespace named_port_test
}  // namespace oca
