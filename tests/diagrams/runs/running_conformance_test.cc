// SPDX-License-Identifier: BSD-3-Clause
// How every system evaluates and runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/allocation_count.h"
#include "tests/diagrams/runs/conformance.h"

namespace oca::runs {
namespace running_conformance_test {

using testing::HasSubstr;

class RunningConformanceTest : public conformance::ConformanceTest {};

TEST_P(RunningConformanceTest, EvaluatesToTheSameBitsEachTimeAndInACopy) {
  const auto diagram = MakeDiagram();
  Context context = diagram->MakeContext();
  FixInputs(*diagram, context);
  const Context copy = context;
  const std::string first = Outputs(*diagram, context);
  EXPECT_EQ(Outputs(*diagram, context), first);
  EXPECT_EQ(Outputs(*diagram, copy), first);
  EXPECT_THAT(first, testing::Not(HasSubstr("nan")));
}

TEST_P(RunningConformanceTest, RunsToTheSameBitsTwice) {
  const auto diagram = MakeDiagram();
  const auto run = [&] {
    Simulator simulator(*diagram);
    FixInputs(*diagram, simulator.context());
    try {
      simulator.AdvanceTo(0.5);
    } catch (const SimulationError& error) {
      return std::string(error.what());
    }
    return Outputs(*diagram, simulator.context());
  };
  EXPECT_EQ(run(), run());
}

TEST_P(RunningConformanceTest, ItsInputsRefuseWhatIsNotFinite) {
  const auto diagram = MakeDiagram();
  Context context = diagram->MakeContext();
  FixInputs(*diagram, context);
  for (const auto& input : diagram->inputs()) {
    if (input.type != &kVectorType) continue;
    const auto port = diagram->GetInput<Vector>(input.name);
    for (int size = 1; size <= 12; ++size) {
      for (const double bad :
           {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        const Eigen::VectorXd value = Eigen::VectorXd::Constant(size, bad);
        EXPECT_ANY_THROW(port.Fix(context, value)) << input.name << " " << size;
      }
    }
  }
}

TEST_P(RunningConformanceTest, AnInputThatNobodyFixedIsNeverReadAsZero) {
  const auto diagram = MakeDiagram();
  for (const auto& input : diagram->inputs()) {
    Simulator simulator(*diagram);
    FixInputs(*diagram, simulator.context(), input.name);
    try {
      simulator.Initialize();
      ADD_FAILURE() << input.name << " was read";
    } catch (const SimulationError& error) {
      EXPECT_EQ(error.port, input.name);
      EXPECT_THAT(error.what(), HasSubstr("has not been fixed"));
    }
  }
}

TEST_P(RunningConformanceTest, NoOutputThatReadsAnInputHasAValueBeforeItIsFixed) {
  const auto diagram = MakeDiagram();
  const Context context = diagram->MakeContext();
  for (const auto& output : diagram->outputs()) {
    const OutputHandle port = diagram->FindOutput(output.name);
    for (const InputHandle& input : diagram->UpstreamOf(port, Through::kInstant).exported) {
      if (diagram->inputs()[input.index].optional) continue;
      std::string text;
      EXPECT_THROW(EvalJson(port, context, text), SimulationError) << output.name << " is " << text;
    }
  }
}

TEST_P(RunningConformanceTest, RunsWithoutTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const auto diagram = MakeDiagram();
  Simulator simulator(*diagram);
  FixInputs(*diagram, simulator.context());
  simulator.Initialize();
  const std::int64_t before = AllocationCount();
  simulator.AdvanceTo(0.4);
  EXPECT_EQ(AllocationCount(), before);
}

INSTANTIATE_TEST_SUITE_P(Catalogue, RunningConformanceTest, testing::ValuesIn(conformance::Types()),
                         [](const auto& type) { return type.param; });

}  // namespace running_conformance_test
}  // namespace oca::runs
