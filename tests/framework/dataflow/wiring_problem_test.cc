// SPDX-License-Identifier: BSD-3-Clause
// Which ports and systems a problem of the wiring is about.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace wiring_problem_test {

using testing::ElementsAre;
using testing::IsEmpty;

WiringProblem ProblemOf(DiagramBuilder& builder) {
  try {
    builder.Build();
  } catch (const WiringError& error) {
    EXPECT_EQ(error.problems.size(), 1u) << error.what();
    return error.problems.front();
  }
  ADD_FAILURE() << "was built";
  return {};
}

std::vector<std::string> InputsOf(const WiringProblem& problem) {
  std::vector<std::string> inputs;
  for (const PortPath& input : problem.inputs) inputs.push_back(input.ToString());
  return inputs;
}

/// Two maps in a row in a diagram of their own, which nothing drives.
std::unique_ptr<Diagram> Row() {
  DiagramBuilder inner;
  const auto& first = inner.Add<blocks::Map>("first");
  const auto& second = inner.Add<blocks::Map>("second");
  inner.Connect(first.out, second.in);
  inner.ExportInput("u", first.in);
  inner.ExportOutput("y", second.out);
  return inner.BuildInner();
}

TEST(WiringProblemTest, OfAnOpenInputNamesItAndItsSystem) {
  DiagramBuilder builder;
  builder.AddSystem("row", Row());
  const WiringProblem problem = ProblemOf(builder);
  EXPECT_THAT(InputsOf(problem), ElementsAre("row.first.in"));
  EXPECT_EQ(problem.system, "row.first");
  EXPECT_EQ(problem.ToString(),
            "row.first.in: input not connected; expected an output of type Vector");
  EXPECT_EQ(problem.ToString("row"),
            "first.in: input not connected; expected an output of type Vector");
  EXPECT_EQ(problem.ToString("ro"), problem.ToString());
}

TEST(WiringProblemTest, OfALoopNamesItsInputsInOrder) {
  DiagramBuilder builder;
  const System& row = builder.AddSystem("row", Row());
  builder.ConnectPorts(row.FindOutput("y"), row.FindInput("u"));
  const WiringProblem problem = ProblemOf(builder);
  EXPECT_THAT(InputsOf(problem), ElementsAre("row.second.in", "row.first.in"));
  EXPECT_EQ(problem.system, "");
  EXPECT_THAT(problem.ToString("row"),
              testing::StartsWith("algebraic loop: first.out -> second.in -> second.out -> "
                                  "first.in -> first.out; "));
}

TEST(WiringProblemTest, OfUnequalPortsNamesTheInput) {
  DiagramBuilder builder;
  const auto& clock = builder.Add<blocks::Clock>("clock");
  const auto& sink = builder.Add<blocks::LabelSink>("sink");
  builder.ConnectPorts(clock.FindOutput("value"), sink.FindInput("in"));
  const WiringProblem problem = ProblemOf(builder);
  EXPECT_THAT(InputsOf(problem), ElementsAre("sink.in"));
  EXPECT_EQ(problem.system, "sink");
  EXPECT_EQ(problem.ToString(), "clock.value -> sink.in: type; got Vector; expected Label");
}

/// A state of two numbers that starts from three.
class Misshapen final : public System {
 public:
  Misshapen() : x_(DeclareDiscreteState("x", {2}, Eigen::VectorXd(Eigen::VectorXd::Zero(3)))) {}

 private:
  const DiscreteState<Vector> x_;
};

TEST(WiringProblemTest, OfAStateNamesItsSystemAlone) {
  DiagramBuilder builder;
  DiagramBuilder inner;
  inner.Add<Misshapen>("odd");
  builder.AddSystem("cell", inner.BuildInner());
  const WiringProblem problem = ProblemOf(builder);
  EXPECT_THAT(problem.inputs, IsEmpty());
  EXPECT_EQ(problem.system, "cell.odd");
  EXPECT_EQ(problem.ToString("cell"), "odd.x: initial value; got 3 numbers; expected 2");
}

TEST(WiringProblemTest, OfNoDiagramIsItsTextAlone) {
  const WiringError error("system 'a': got nothing");
  ASSERT_EQ(error.problems.size(), 1u);
  EXPECT_EQ(error.problems[0].ToString(), error.what());
  EXPECT_THAT(error.problems[0].inputs, IsEmpty());
}

}  // namespace wiring_problem_test
}  // namespace oca
