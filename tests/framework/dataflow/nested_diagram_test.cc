// SPDX-License-Identifier: BSD-3-Clause
// Nesting is a way to write a diagram, not a thing at run time.
#include <gmock/gmock.h>

#include <cmath>

#include "oca/framework/dataflow/schedule.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace nested_diagram_test {

using blocks::Vec;

const auto kFold = [](double x) { return std::sin(3.0 * x) + 0.1; };
const auto kRise = [](double t, double x, double u) { return u - 0.7 * x + std::cos(t); };

/// u -> first -> delay -> y
std::unique_ptr<Diagram> Innermost() {
  DiagramBuilder builder;
  const auto& first = builder.Add<blocks::Map>("first", kFold);
  const auto& delay = builder.Add<blocks::Delay>("delay", Every{Period(1, 30)}, 0.25);
  builder.Connect(first.out, delay.in);
  builder.ExportInput("u", first.in);
  builder.ExportOutput("y", delay.out);
  return builder.Build();
}

/// u -> innermost -> ode -> y
std::unique_ptr<Diagram> Middle() {
  DiagramBuilder builder;
  const System& inner = builder.AddSystem("inner", Innermost());
  const auto& ode = builder.Add<blocks::Ode>("ode", 1.0, kRise);
  builder.ConnectPorts(inner.FindOutput("y"), ode.in);
  builder.ExportInput("u", inner.FindInput("u"));
  builder.ExportOutput("y", ode.out);
  return builder.Build();
}

/// The loop u = y closed over the middle one.
std::unique_ptr<Diagram> Nested() {
  DiagramBuilder builder;
  const System& middle = builder.AddSystem("middle", Middle());
  builder.ConnectPorts(middle.FindOutput("y"), middle.FindInput("u"));
  builder.ExportOutput("y", middle.FindOutput("y"));
  return builder.Build();
}

std::unique_ptr<Diagram> Flat() {
  DiagramBuilder builder;
  const auto& first = builder.Add<blocks::Map>("first", kFold);
  const auto& delay = builder.Add<blocks::Delay>("delay", Every{Period(1, 30)}, 0.25);
  const auto& ode = builder.Add<blocks::Ode>("ode", 1.0, kRise);
  builder.Connect(first.out, delay.in);
  builder.Connect(delay.out, ode.in);
  builder.Connect(ode.out, first.in);
  builder.ExportOutput("y", ode.out);
  return builder.Build();
}

TEST(NestedDiagramTest, ThreeDeepGivesTheSameBitsAndTheSameScheduleAsFlat) {
  const auto nested = Nested();
  const auto flat = Flat();
  EXPECT_EQ(nested->schedule().nodes.size(), flat->schedule().nodes.size());
  EXPECT_EQ(nested->schedule().arena_size, flat->schedule().arena_size);
  EXPECT_EQ(nested->schedule().slots.size(), flat->schedule().slots.size());
  Simulator a(*nested), b(*flat);
  for (int i = 1; i <= 50; ++i) {
    a.AdvanceTo(0.07 * i);
    b.AdvanceTo(0.07 * i);
    ASSERT_EQ(nested->GetOutput<Vector>("y").Eval(a.context())[0],
              flat->GetOutput<Vector>("y").Eval(b.context())[0]);
  }
  EXPECT_EQ(a.statistics().steps, b.statistics().steps);
  EXPECT_NE(nested->GetOutput<Vector>("y").Eval(a.context())[0], 1.0);
}

TEST(NestedDiagramTest, SystemsInsideAreFoundByPath) {
  const auto nested = Nested();
  EXPECT_NE(nested->FindSystem("middle.inner.delay"), nullptr);
  EXPECT_NE(nested->FindSystem("middle.ode"), nullptr);
  EXPECT_EQ(nested->FindSystem("middle.nobody"), nullptr);
  EXPECT_EQ(nested->FindSystem("middle.ode.deeper"), nullptr);
  EXPECT_EQ(nested->FindSystem(""), nullptr);
  EXPECT_EQ(nested->schedule().PathOf(*nested->FindSystem("middle.inner.first")),
            "middle.inner.first");
}

TEST(NestedDiagramTest, AnExportedInputFansOutThroughAllLevels) {
  DiagramBuilder inner;
  const auto& a = inner.Add<blocks::Map>("a", [](double x) { return x + 1.0; });
  const auto& b = inner.Add<blocks::Map>("b", [](double x) { return x * 10.0; });
  inner.ExportInput("u", a.in);
  inner.ExportInput("u", b.in);
  DiagramBuilder builder;
  const System& nested = builder.AddSystem("nested", inner.Build());
  const auto& c = builder.Add<blocks::Map>("c", [](double x) { return -x; });
  builder.ExportInput("v", nested.FindInput("u"));
  builder.ExportInput("v", c.in);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("v").Fix(context, Vec({4.0}));
  EXPECT_EQ(a.out.Eval(context)[0], 5.0);
  EXPECT_EQ(b.out.Eval(context)[0], 40.0);
  EXPECT_EQ(c.out.Eval(context)[0], -4.0);
}

TEST(NestedDiagramTest, OneOutputMayBeExportedUnderTwoNames) {
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({2.0}));
  builder.ExportOutput("y", source.value);
  builder.ExportOutput("z", source.value);
  EXPECT_THROW(builder.ExportOutput("y", source.value), WiringError);
  const auto diagram = builder.Build();
  const Context context = diagram->MakeContext();
  EXPECT_EQ(diagram->GetOutput<Vector>("z").Eval(context)[0], 2.0);
}

TEST(NestedDiagramTest, ANestedDiagramRefusesToMakeAContext) {
  auto inner = Innermost();
  const Diagram& reference = *inner;
  EXPECT_NO_THROW(reference.MakeContext());
  DiagramBuilder builder;
  const auto& source = builder.Add<blocks::Source>("source", Vec({2.0}));
  const System& nested = builder.AddSystem("inner", std::move(inner));
  builder.ConnectPorts(source.value, nested.FindInput("u"));
  const auto root = builder.Build();
  EXPECT_THROW(reference.MakeContext(), WiringError);
  EXPECT_THROW(reference.schedule(), WiringError);
  EXPECT_THROW(Simulator{reference}, WiringError);
  EXPECT_NO_THROW(root->MakeContext());
}

TEST(NestedDiagramTest, TheInputOfANestedDiagramCannotBeFixedFromOutside) {
  // The schedule of the root is likely to lie where the nested one's own lay.
  for (int i = 0; i < 20; ++i) {
    DiagramBuilder builder;
    const auto& source = builder.Add<blocks::Source>("source", Vec({2.0}));
    const System& nested = builder.AddSystem("inner", Innermost());
    builder.ConnectPorts(source.value, nested.FindInput("u"));
    const auto root = builder.Build();
    Context context = root->MakeContext();
    const Input<Vector> u = Typed<Vector>(nested.FindInput("u"));
    EXPECT_THROW(u.Fix(context, Vec({1.0})), WiringError);
  }
}

TEST(NestedDiagramTest, ErrorsNameThePathInside) {
  DiagramBuilder builder;
  builder.AddSystem("outer", Middle());
  EXPECT_THAT(blocks::ProblemsOf(builder),
              testing::ElementsAre("outer.inner.first.in: input not connected; expected an output "
                                   "of type Vector"));
}

}  // namespace nested_diagram_test
}  // namespace oca
