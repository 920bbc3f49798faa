// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <concepts>

#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace typed_ports_test {

using blocks::ProblemsOf;
using blocks::Vec;
using testing::ElementsAre;
using testing::HasSubstr;

template <class From, class To>
concept Connectable = requires(DiagramBuilder& builder, const From& from, const To& to) {
  builder.Connect(from, to);
};

// The compiler is the judge of these.
static_assert(Connectable<Output<Vector>, Input<Vector>>);
static_assert(Connectable<Output<Vector>, OptionalInput<Vector>>);
static_assert(Connectable<Output<Label>, Input<Label>>);
static_assert(!Connectable<Output<Vector>, Input<Label>>);
static_assert(!Connectable<Output<Label>, Input<Vector>>);
static_assert(!Connectable<Output<Label>, OptionalInput<Vector>>);
static_assert(!Connectable<Input<Vector>, Output<Vector>>);
static_assert(!Connectable<Input<Vector>, Input<Vector>>);
static_assert(!Connectable<Output<Vector>, Output<Vector>>);
static_assert(!Connectable<OutputHandle, Input<Vector>>);
// No typed handle is made of an untyped one without a look at its type.
static_assert(!std::constructible_from<Output<Label>, OutputHandle>);
static_assert(!std::constructible_from<Input<Label>, InputHandle>);
static_assert(!std::constructible_from<OptionalInput<Label>, InputHandle>);
static_assert(!std::constructible_from<DiscreteState<Label>, StateHandle>);
static_assert(!std::constructible_from<ContinuousState, StateHandle>);
static_assert(!std::is_aggregate_v<Output<Label>> && !std::is_aggregate_v<Input<Label>>);
static_assert(!std::copy_constructible<System> && !std::is_copy_assignable_v<blocks::Map>);

/// Whether a method fits what it is declared to read and write.
struct Methods : System {
  void ReadsVector(VectorView, MutableVectorView) const {}
  void ReadsLabel(const Label&, MutableVectorView) const {}
  void WritesLabel(VectorView, Label&) const {}
};
template <auto kMethod, class Read, class Write>
concept Fits = std::invocable<decltype(kMethod), const Methods&,
                              decltype(internal::Access<Read>::Get(nullptr, Slot{})),
                              decltype(internal::Access<WriteOf<Write>>::Get(nullptr, Slot{}))>;
static_assert(Fits<&Methods::ReadsVector, Input<Vector>, Vector>);
static_assert(Fits<&Methods::ReadsVector, ContinuousState, Vector>);
static_assert(Fits<&Methods::ReadsVector, DiscreteState<Vector>, Vector>);
static_assert(!Fits<&Methods::ReadsVector, OptionalInput<Vector>, Vector>);
static_assert(!Fits<&Methods::ReadsVector, Input<Label>, Vector>);
static_assert(!Fits<&Methods::ReadsVector, Input<Vector>, Label>);
static_assert(!Fits<&Methods::ReadsLabel, Input<Vector>, Vector>);
static_assert(Fits<&Methods::WritesLabel, Input<Vector>, Label>);

TEST(TypedPortsTest, DifferentTypesConnectedAtRunTimeAreReportedWithBothSidesAndBothTypes) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}));
  const auto& sink = builder.Add<blocks::LabelSink>("sink");
  builder.ConnectPorts(source.value, sink.in);
  EXPECT_THAT(ProblemsOf(builder),
              ElementsAre("source.value -> sink.in: type; got Vector; expected Label"));
}

TEST(TypedPortsTest, DifferentTypesAreReportedInTheOtherDirectionToo) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({1.0}));
  const auto& labeller = builder.Add<blocks::Labeller>("labeller", Every{Period(1, 10)});
  const auto& map = builder.Add<blocks::Map>("map");
  builder.Connect(source.value, labeller.in);
  builder.ConnectPorts(labeller.text, map.in);
  EXPECT_THAT(ProblemsOf(builder),
              ElementsAre("labeller.text -> map.in: type; got Label; expected Vector"));
}

TEST(TypedPortsTest, EqualTypesConnectedAtRunTimeWork) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({2.5}));
  const auto& labeller = builder.Add<blocks::Labeller>("labeller", Every{Period(1, 10)});
  const auto& sink = builder.Add<blocks::LabelSink>("sink");
  builder.ConnectPorts(source.FindOutput("value"), labeller.FindInput("in"));
  builder.ConnectPorts(labeller.FindOutput("text"), sink.FindInput("in"));
  const auto diagram = builder.Build();
  EXPECT_EQ(sink.out.Eval(diagram->MakeContext()).text, "2.500000");
}

TEST(TypedPortsTest, ExportedInputsThatShareANameMustShareAType) {
  DiagramBuilder builder;
  const auto& map = builder.Add<blocks::Map>("map");
  const auto& sink = builder.Add<blocks::LabelSink>("sink");
  builder.ExportInput("u", map.in);
  builder.ExportInput("u", sink.in);
  EXPECT_THAT(ProblemsOf(builder), ElementsAre("u -> sink.in: type; got Vector; expected Label"));
}

TEST(TypedPortsTest, PortsOfADiagramAreFoundByNameAndType) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Map>([](double x) { return 3 * x; }));
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("in").Fix(context, Vec({2.0}));
  EXPECT_EQ(diagram->GetOutput<Vector>("out").Eval(context)[0], 6.0);
}

TEST(TypedPortsTest, APortOfAnotherTypeOrNameIsRefusedNamingWhatThereIs) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Map>());
  const auto text_of = [](const auto& call) -> std::string {
    try {
      call();
    } catch (const WiringError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(text_of([&] { diagram->GetInput<Label>("in"); }),
            "input 'in' was asked for as Label; it is Vector");
  EXPECT_EQ(text_of([&] { diagram->GetOutput<Label>("out"); }),
            "output 'out' was asked for as Label; it is Vector");
  EXPECT_THAT(text_of([&] { diagram->GetOutput<Vector>("otu"); }),
              HasSubstr("no output port 'otu'; did you mean 'out'?; output ports are: out"));
  EXPECT_THAT(text_of([&] { diagram->FindInput("nothing_like_it"); }),
              HasSubstr("no input port 'nothing_like_it'; input ports are: in"));
}

TEST(TypedPortsTest, AHandleIsTypedOnlyAsWhatItIs) {
  const blocks::Labeller labeller(Every{Period(1, 10)});
  EXPECT_EQ(Typed<Label>(labeller.FindOutput("text")), labeller.text);
  EXPECT_EQ(Typed<Vector>(labeller.FindInput("in")), labeller.in);
  EXPECT_THROW(Typed<Vector>(labeller.FindOutput("text")), WiringError);
  EXPECT_THROW(Typed<Label>(labeller.FindInput("in")), WiringError);
  EXPECT_THROW(Typed<Vector>(OutputHandle{}), WiringError);
  EXPECT_THROW(Typed<Vector>(OutputHandle{{&labeller, 2}}), WiringError);
  EXPECT_THROW(Typed<Vector>(InputHandle{{&labeller, -1}}), WiringError);
}

TEST(TypedPortsTest, APortThatIsAskedForByPathIsNamedByItIfItIsNotThereOrOfAnotherType) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Source>(Vec({1, 2})));
  const std::string system = diagram->systems().front().path;
  const auto refusal = [&](const auto& ask) -> std::string {
    try {
      ask();
    } catch (const WiringError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal([&] { diagram->GetOutput<Vector>(system + ".valu"); }),
              testing::StartsWith(system + ": no output port 'valu'"));
  EXPECT_THAT(refusal([&] { diagram->GetOutput<Label>(system + ".value"); }),
              HasSubstr("'" + system + ".value' was asked for as Label; it is Vector"));
}

}  // namespace typed_ports_test
}  // namespace oca
