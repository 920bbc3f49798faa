// SPDX-License-Identifier: BSD-3-Clause
// Blocks that are given as a callable.
#include "oca/framework/dataflow/function.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace function_test {

using blocks::Vec;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Its only output at a time, with these inputs fixed.
Eigen::VectorXd Out(std::unique_ptr<System> block, const std::vector<Eigen::VectorXd>& inputs,
                    double time = 0.0) {
  std::map<std::string, int> sizes;
  for (const auto& input : block->inputs()) sizes[input.name] = -1;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    sizes[block->inputs()[i].name] = static_cast<int>(inputs[i].size());
  }
  const auto diagram = MakeDiagramOf(std::move(block), sizes);
  Context context = diagram->MakeContext();
  context.SetTime(time);
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    diagram->GetInput<Vector>(diagram->inputs()[i].name).Fix(context, inputs[i]);
  }
  return diagram->GetOutput<Vector>("out").Eval(context);
}

const FunctionPorts kTwo{.inputs = {{"a"}, {"b"}}, .output = {"out"}};

TEST(FunctionTest, WritesWhereItsLastParameterIs) {
  const auto sum = [](VectorView a, VectorView b, MutableVectorView out) { out = a + b; };
  EXPECT_EQ(Out(MakeBlock(kTwo, sum), {Vec({1, 2}), Vec({10, 20})}), Vec({11, 22}));
}

TEST(FunctionTest, OrReturnsANumberOrAColumn) {
  EXPECT_EQ(Out(MakeBlock({.inputs = {{"a"}}, .output = {"out", 1}},
                          [](VectorView a) { return a.norm(); }),
                {Vec({3, 4})}),
            Vec({5}));
  EXPECT_EQ(Out(MakeBlock({.inputs = {{"a"}}, .output = {"out"}},
                          [](VectorView a) -> Eigen::VectorXd { return 2.0 * a; }),
                {Vec({3, 4})}),
            Vec({6, 8}));
}

TEST(FunctionTest, ADoubleBeforeTheInputsIsTheTime) {
  const auto late = [](double t, VectorView a) -> Eigen::VectorXd { return t * a; };
  EXPECT_EQ(Out(MakeBlock({.inputs = {{"a"}}, .output = {"out"}}, late), {Vec({3, 4})}, 0.5),
            Vec({1.5, 2}));
  EXPECT_EQ(Out(MakeBlock({.output = {"out", 1}}, [](double t) { return 2.0 * t; }), {}, 0.5),
            Vec({1}));
}

TEST(FunctionTest, TakesAnyNumberOfVectorsAtOnce) {
  const auto sum = [](const VectorInputs& in, MutableVectorView out) {
    out.setZero();
    for (int i = 0; i < in.size(); ++i) out += in[i];
  };
  EXPECT_EQ(Out(MakeBlock(kTwo, sum), {Vec({1, 2}), Vec({10, 20})}), Vec({11, 22}));
  const auto later = [](double t, const VectorInputs& in) -> Eigen::VectorXd { return t * in[1]; };
  EXPECT_EQ(Out(MakeBlock(kTwo, later), {Vec({1, 2}), Vec({10, 20})}, 0.5), Vec({5, 10}));
}

TEST(FunctionTest, AnOptionalInputMayStayAlone) {
  const auto either = [](std::optional<VectorView> a) { return a ? (*a)[0] : -1.0; };
  EXPECT_EQ(Out(MakeBlock({.inputs = {{"a", 1}}, .output = {"out", 1}}, either), {Vec({3})}),
            Vec({3}));
  const auto diagram =
      MakeDiagramOf(MakeBlock({.inputs = {{"a", 1}}, .output = {"out", 1}}, either));
  EXPECT_EQ(diagram->GetOutput<Vector>("out").Eval(diagram->MakeContext())[0], -1.0);
}

TEST(FunctionTest, CarriesOtherSignals) {
  DiagramBuilder builder;
  const System& twice = builder.AddSystem(
      "twice", MakeBlock({.inputs = {{"in"}}, .output = {"out"}},
                         [](const Label& in) { return Label{in.text + in.text}; }));
  const System& length = builder.AddSystem(
      "length", MakeBlock({.inputs = {{"in"}, {"none"}}, .output = {"out", 1}},
                          [](const Label& in, const Label* none) {
                            return static_cast<double>(in.text.size()) + (none == nullptr ? 0 : 99);
                          }));
  builder.ConnectPorts(twice.FindOutput("out"), length.FindInput("in"));
  builder.ExportInput("in", twice.FindInput("in"));
  builder.ExportOutput("out", length.FindOutput("out"));
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  diagram->GetInput<Label>("in").Fix(context, Label{"abc"});
  EXPECT_EQ(diagram->GetOutput<Vector>("out").Eval(context)[0], 6.0);
}

TEST(FunctionTest, LengthsOfOneNameAndUnitsAreCheckedInTheWiring) {
  const auto build = [](int n, const Unit& unit) {
    DiagramBuilder builder;
    const auto& a = builder.Add<blocks::Source>("a", Vec({1, 2}), "rad");
    const auto& b = builder.Add<blocks::Source>("b", Eigen::VectorXd::Ones(n), unit);
    const System& sum = builder.AddSystem(
        "sum", MakeBlock({.inputs = {{"a", "n", "rad"}, {"b", "n", "rad"}}, .output = {"out"}},
                         [](VectorView x, VectorView y, MutableVectorView z) { z = x + y; }));
    builder.ConnectPorts(a.value, sum.FindInput("a"));
    builder.ConnectPorts(b.value, sum.FindInput("b"));
    return builder.Build();
  };
  EXPECT_NE(build(2, "rad"), nullptr);
  EXPECT_THAT([&] { build(3, "rad"); }, ThrowsMessage<WiringError>(HasSubstr("sum.b")));
  EXPECT_THAT([&] { build(2, "m"); }, ThrowsMessage<WiringError>(HasSubstr("sum.b")));
}

template <class F>
void ExpectFailure(F f, const std::string& what) {
  DiagramBuilder builder;
  const System& block =
      builder.AddSystem("block", MakeBlock({.inputs = {}, .output = {"out", 2}}, f));
  builder.ExportOutput("out", block.FindOutput("out"));
  const auto diagram = builder.Build();
  try {
    diagram->GetOutput<Vector>("out").Eval(diagram->MakeContext());
    FAIL() << "was computed";
  } catch (const SimulationError& error) {
    EXPECT_EQ(error.system, "block");
    EXPECT_EQ(error.port, "out");
    EXPECT_THAT(error.what(), HasSubstr(what));
  }
}

TEST(FunctionTest, WhatFailsInItFailsTheRunAtItsPort) {
  ExpectFailure([](double) -> Eigen::Vector2d { throw std::runtime_error("no luck"); }, "no luck");
  ExpectFailure([](double) -> Eigen::Vector2d { throw 42; }, "no std::exception");
  ExpectFailure([](double) { return Eigen::Vector3d(1, 2, 3); }, "length; got 3; expected 2");
  ExpectFailure([](double) { return 1.0; }, "length; got 1; expected 2");
  ExpectFailure([](double) { return Eigen::Vector2d(0, std::nan("")); }, "not finite");
}

TEST(FunctionTest, WantsAPortForEachInput) {
  const auto sum = [](VectorView a, VectorView b) { return a[0] + b[0]; };
  EXPECT_THAT(
      [&] {
        MakeBlock({.inputs = {{"a"}}, .output = {"out", 1}}, sum);
      },
      ThrowsMessage<WiringError>(AllOf(HasSubstr("got 1"), HasSubstr("expected 2"))));
  EXPECT_THAT(
      [&] {
        MakeBlock({.inputs = {{"a"}, {"b"}, {"c"}}, .output = {"out", 1}}, sum);
      },
      ThrowsMessage<WiringError>(AllOf(HasSubstr("got 3"), HasSubstr("expected 2"))));
}

TEST(FunctionTest, WithMemoryItsOutputIsAState) {
  const auto count = [](double t, MutableVectorView x) { x[0] += t < 0.25 ? 1.0 : 10.0; };
  const auto diagram =
      MakeDiagramOf(MakeBlock({.inputs = {}, .output = {"out", 1}}, {Period(1, 10), 5.0}, count));
  EXPECT_TRUE(ShowsState(diagram->FindOutput("out")));
  Simulator simulator(*diagram);
  simulator.Initialize();
  const auto out = diagram->GetOutput<Vector>("out");
  EXPECT_EQ(out.Eval(simulator.context())[0], 5.0);
  simulator.AdvanceTo(0.35);  // ticks at 0, 0.1, 0.2, 0.3
  EXPECT_EQ(out.Eval(simulator.context())[0], 18.0);
  EXPECT_THAT(
      [&] {
        MakeBlock({.inputs = {}, .output = {"out", 1}}, {Period(), 0.0}, count);
      },
      ThrowsMessage<ConfigError>(HasSubstr("period")));
}

TEST(FunctionTest, PortsHaveNamesThatPathsCanSay) {
  const auto copy = [](VectorView a) -> Eigen::VectorXd { return a; };
  for (const char* name : {"", "o.p", "o p", "\n"}) {
    EXPECT_THAT(
        [&] {
          MakeBlock({.inputs = {{"a"}}, .output = {name, 2}}, copy);
        },
        ThrowsMessage<WiringError>(HasSubstr("output name: got")))
        << name;
    EXPECT_THAT(
        [&] {
          MakeBlock({.inputs = {{name}}, .output = {"out", 2}}, copy);
        },
        ThrowsMessage<WiringError>(HasSubstr("input name: got")))
        << name;
  }
}

TEST(FunctionTest, NoTwoInputsShareAName) {
  const auto sum = [](VectorView a, VectorView b, MutableVectorView out) { out = a + b; };
  EXPECT_THAT(
      [&] {
        MakeBlock({.inputs = {{"a"}, {"a"}}, .output = {"a"}}, sum);
      },
      ThrowsMessage<WiringError>(HasSubstr("input name: 'a' is taken")));
  EXPECT_EQ(MakeBlock({.inputs = {{"a"}, {"b"}}, .output = {"a"}}, sum)->outputs().size(), 1u);
}

}  // namespace function_test
}  // namespace oca
