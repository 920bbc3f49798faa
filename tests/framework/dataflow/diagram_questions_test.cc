// SPDX-License-Identifier: BSD-3-Clause
// What a diagram answers of its wiring, through nesting.
#include <gmock/gmock.h>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace diagram_questions_test {

using blocks::Vec;
using testing::ElementsAre;
using testing::HasSubstr;

/// u -> filter -> velocities, with a counter that nothing reads.
std::unique_ptr<Diagram> Arm() {
  DiagramBuilder builder;
  const auto& filter = builder.Add<blocks::Map>("filter");
  const auto& delay = builder.Add<blocks::Delay>("delay", Every{Period(1, 10)});
  builder.Connect(filter.out, delay.in);
  builder.ExportInput("u", filter.in);
  builder.ExportInput("u", builder.Add<blocks::Map>("other").in);
  builder.ExportOutput("velocities", delay.out);
  return builder.Build();
}

/// source -> arm (two levels deep) -> sum <- offset (from outside)
class DiagramQuestionsTest : public testing::Test {
 protected:
  DiagramQuestionsTest() {
    DiagramBuilder cell;
    const System& arm = cell.AddSystem("arm", Arm());
    cell.ExportInput("u", arm.FindInput("u"));
    cell.ExportOutput("v", arm.FindOutput("velocities"));
    DiagramBuilder builder;
    const auto& source = builder.Add<blocks::Source>("source", Vec({1.0, 2.0, 3.0}), "rad/s");
    const System& inner = builder.AddSystem("cell", cell.Build());
    const auto& sum = builder.Add<blocks::Sum>("sum");
    builder.ConnectPorts(source.value, inner.FindInput("u"));
    builder.ConnectPorts(inner.FindOutput("v"), sum.in0);
    builder.ExportInput("offset", sum.in1);
    builder.ExportOutput("y", sum.out);
    diagram_ = builder.Build();
  }
  OutputHandle Out(const char* path) const { return diagram_->FindOutput(path); }
  InputHandle In(const char* path) const { return diagram_->FindInput(path); }

  std::unique_ptr<Diagram> diagram_;
};

TEST_F(DiagramQuestionsTest, ListsItsLeavesWithTheirPathsInOrder) {
  std::vector<std::string> paths;
  for (const Diagram::Leaf& leaf : diagram_->systems()) {
    paths.push_back(leaf.path);
    EXPECT_EQ(diagram_->FindSystem(leaf.path), leaf.system);
    EXPECT_EQ(diagram_->PathOf(*leaf.system), leaf.path);
  }
  EXPECT_THAT(paths,
              ElementsAre("source", "cell.arm.filter", "cell.arm.delay", "cell.arm.other", "sum"));
}

TEST_F(DiagramQuestionsTest, FindsPortsByPath) {
  EXPECT_EQ(diagram_->PathOf(Out("cell.arm.filter.out")), "cell.arm.filter.out");
  EXPECT_EQ(diagram_->PathOf(In("cell.arm.filter.in")), "cell.arm.filter.in");
  EXPECT_EQ(Out("cell.arm.velocities"), Out("cell.arm.delay.out"));
  EXPECT_EQ(Out("cell.v"), Out("cell.arm.delay.out"));
  EXPECT_EQ(Out("y"), Out("sum.out"));
  EXPECT_EQ(diagram_->PathOf(In("cell.arm.u")), "cell.arm.u");
  EXPECT_EQ(diagram_->PathOf(In("offset")), "offset");
}

TEST_F(DiagramQuestionsTest, NamesTheSystemsThereAreIfAPathLeadsNowhere) {
  try {
    Out("cell.arm.filtre.out");
    FAIL();
  } catch (const WiringError& error) {
    EXPECT_THAT(error.what(), HasSubstr("no output port 'cell.arm.filtre.out': no system "
                                        "'cell.arm.filtre'; did you mean 'cell.arm.filter'?"));
    EXPECT_THAT(error.what(), HasSubstr("systems are: source, cell, cell.arm, cell.arm.filter"));
  }
  EXPECT_THROW(Out("cell.arm.filter.exit"), WiringError);
  EXPECT_THROW(In("source.value"), WiringError);  // an output
  EXPECT_THROW(In(".in"), WiringError);
}

TEST_F(DiagramQuestionsTest, TypedPortsByPathAreReadAndFixed) {
  Context context = diagram_->MakeContext();
  diagram_->GetInput<Vector>("sum.in1").Fix(context, Vec({10.0, 20.0, 30.0}));
  EXPECT_EQ(diagram_->GetOutput<Vector>("cell.arm.filter.out").Eval(context)[2], 3.0);
  EXPECT_EQ(diagram_->GetOutput<Vector>("y").Eval(context)[1], 20.0);
  EXPECT_THROW(diagram_->GetInput<Vector>("sum.in0").Fix(context, Vec({0.0})), WiringError);
  EXPECT_THROW(diagram_->GetOutput<Label>("cell.arm.filter.out"), WiringError);
  EXPECT_THROW(diagram_->GetInput<Label>("cell.u"), WiringError);
}

TEST_F(DiagramQuestionsTest, SaysWhoDrivesAnInput) {
  EXPECT_EQ(diagram_->DriverOf(In("cell.arm.filter.in")), Out("source.value"));
  EXPECT_EQ(diagram_->DriverOf(In("cell.u")), Out("source.value"));
  EXPECT_EQ(diagram_->DriverOf(In("sum.in0")), Out("cell.arm.delay.out"));
  EXPECT_EQ(diagram_->DriverOf(In("sum.in1")), std::nullopt);
  EXPECT_EQ(diagram_->ExportOf(In("sum.in1")), In("offset"));
  EXPECT_EQ(diagram_->ExportOf(In("offset")), In("offset"));
  EXPECT_EQ(diagram_->ExportOf(In("sum.in0")), std::nullopt);
}

TEST_F(DiagramQuestionsTest, SaysWhatDrivesALeafInputByInput) {
  const auto of_filter = diagram_->DriversOf(*diagram_->FindSystem("cell.arm.filter"));
  ASSERT_EQ(of_filter.size(), 1u);
  EXPECT_EQ(of_filter[0].from, Out("source.value"));
  EXPECT_EQ(of_filter[0].to, In("cell.arm.filter.in"));
  const auto of_sum = diagram_->DriversOf(*diagram_->FindSystem("sum"));
  ASSERT_EQ(of_sum.size(), 1u);  // the other comes from outside
  EXPECT_EQ(of_sum[0].to, In("sum.in0"));
  EXPECT_TRUE(diagram_->DriversOf(*diagram_->FindSystem("source")).empty());
}

TEST_F(DiagramQuestionsTest, WalksUpFromLeafToLeafToWhereItIsToEnd) {
  const auto leaf = [&](const char* path) { return diagram_->FindSystem(path); };
  const auto never = [](const System&) { return false; };
  EXPECT_THAT(
      diagram_->LeavesUpstream({leaf("sum")}, never),
      ElementsAre(leaf("sum"), leaf("cell.arm.delay"), leaf("cell.arm.filter"), leaf("source")));
  const auto at_filter = [&](const System& system) { return &system == leaf("cell.arm.filter"); };
  EXPECT_THAT(diagram_->LeavesUpstream({leaf("sum")}, at_filter),
              ElementsAre(leaf("sum"), leaf("cell.arm.delay"), leaf("cell.arm.filter")));
  EXPECT_THAT(diagram_->LeavesUpstream({leaf("cell.arm.filter"), leaf("sum")}, at_filter),
              ElementsAre(leaf("cell.arm.filter"), leaf("sum"), leaf("cell.arm.delay")));
}

TEST_F(DiagramQuestionsTest, SaysWhoReadsAnOutput) {
  EXPECT_THAT(diagram_->ReadersOf(Out("source.value")),
              ElementsAre(In("cell.arm.filter.in"), In("cell.arm.other.in")));
  EXPECT_THAT(diagram_->ReadersOf(Out("cell.v")), ElementsAre(In("sum.in0")));
  EXPECT_THAT(diagram_->ReadersOf(Out("sum.out")), ElementsAre());
}

TEST_F(DiagramQuestionsTest, KnowsSettledSizesAndUnits) {
  for (const char* path : {"source.value", "cell.arm.filter.out", "cell.v", "y"}) {
    EXPECT_EQ(diagram_->SizeOf(Out(path)), 3) << path;
    EXPECT_EQ(diagram_->UnitOf(Out(path)), Unit("rad/s")) << path;
  }
  for (const char* path : {"cell.u", "cell.arm.other.in", "offset", "sum.in1"}) {
    EXPECT_EQ(diagram_->SizeOf(In(path)), 3) << path;
    EXPECT_EQ(diagram_->UnitOf(In(path)).ToString(), "rad/s") << path;
  }
}

TEST_F(DiagramQuestionsTest, ANestedDiagramAnswersThroughItsRoot) {
  const auto* arm = dynamic_cast<const Diagram*>(diagram_->FindSystem("cell.arm"));
  ASSERT_NE(arm, nullptr);
  EXPECT_EQ(arm->PathOf(*arm), "cell.arm");
  EXPECT_EQ(arm->FindOutput("filter.out"), Out("cell.arm.filter.out"));
  EXPECT_EQ(arm->PathOf(arm->FindOutput("velocities")), "cell.arm.delay.out");
  EXPECT_EQ(arm->DriverOf(arm->FindInput("u")), Out("source.value"));
  EXPECT_EQ(arm->SizeOf(arm->FindInput("filter.in")), 3);
  std::vector<std::string> paths;
  for (const Diagram::Leaf& leaf : arm->systems()) paths.push_back(leaf.path);
  EXPECT_THAT(paths, ElementsAre("cell.arm.filter", "cell.arm.delay", "cell.arm.other"));
}

TEST_F(DiagramQuestionsTest, RefusesPortsAndSystemsOfOtherDiagrams) {
  const auto other = MakeDiagramOf(std::make_unique<blocks::Map>());
  EXPECT_THROW(diagram_->DriverOf(other->FindInput("in")), WiringError);
  EXPECT_THROW(diagram_->ReadersOf(other->FindOutput("out")), WiringError);
  EXPECT_THROW(diagram_->UpstreamOf(other->FindInput("in"), Through::kInstant), WiringError);
  EXPECT_THROW(diagram_->SizeOf(other->FindOutput("out")), WiringError);
  EXPECT_THROW(diagram_->UnitOf(other->FindInput("in")), WiringError);
  EXPECT_THROW(diagram_->PathOf(*other), WiringError);
  EXPECT_THROW(diagram_->PathOf(other->FindOutput("out")), WiringError);
  EXPECT_THROW(diagram_->PathOf(InputHandle{}), WiringError);
  EXPECT_THROW(diagram_->DriverOf(InputHandle{}), WiringError);
}

TEST_F(DiagramQuestionsTest, ADiagramThatWaitsForItsRootAnswersNothing) {
  auto arm = Arm();
  const Diagram& reference = *arm;
  EXPECT_EQ(reference.PathOf(*reference.FindSystem("filter")), "filter");
  DiagramBuilder builder;
  const System& nested = builder.AddSystem("arm", std::move(arm));
  EXPECT_THROW(reference.systems(), WiringError);
  builder.ExportInput("u", nested.FindInput("u"));
  const auto root = builder.Build();
  EXPECT_EQ(reference.PathOf(*reference.FindSystem("filter")), "arm.filter");
}

TEST(DiagramUnitTest, AUnitThatNothingSettlesIsAny) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Map>(), {{"in", 2}});
  EXPECT_TRUE(diagram->UnitOf(diagram->FindOutput("out")).any());
  EXPECT_EQ(diagram->SizeOf(diagram->FindOutput("out")), 2);
  EXPECT_EQ(diagram->SizeOf(diagram->FindInput("in")), 2);
}

TEST(DiagramUnitTest, OtherTypesHaveNeitherSizeNorUnit) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::LabelSink>());
  EXPECT_EQ(diagram->SizeOf(diagram->FindOutput("out")), 0);
  EXPECT_EQ(diagram->SizeOf(diagram->FindInput("in")), 0);
  EXPECT_TRUE(diagram->UnitOf(diagram->FindInput("in")).any());
}

}  // namespace diagram_questions_test
}  // namespace oca
