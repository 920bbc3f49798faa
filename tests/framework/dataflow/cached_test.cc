// SPDX-License-Identifier: BSD-3-Clause
// What calculations of one system share: computed once an instant, and no port.
#include <gmock/gmock.h>

#include <stdexcept>
#include <vector>

#include "oca/framework/dataflow/function.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/allocation_count.h"
#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace cached_test {

using blocks::Vec;
using testing::ElementsAre;
using testing::HasSubstr;

/// squares = in^2, kept with the memory that they are computed in; sum and largest read them, and
/// every 0.1 s `last` takes the sum over.
class Squares final : public System {
 public:
  /// No signal: it has neither a name nor JSON.
  struct Work {
    std::vector<double> squares;
    int computed{0};
  };

  Squares()
      : size_(DeclareSize()),
        last_(DeclareDiscreteState("last", {1}, 0.0)),
        in(DeclareInput<Vector>("in", {size_})),
        idle(DeclareInput<Vector>("idle", {1})),
        squares(DeclareCached<&Squares::CalcSquares>(in)),
        total_(DeclareCached<&Squares::CalcTotal>(squares)),
        sum(DeclareOutput<Vector, &Squares::CalcSum>("sum", {1}, total_)),
        largest(DeclareOutput<Vector, &Squares::CalcLargest>("largest", {1}, squares, idle)),
        last(DeclareStateOutput("last", last_)) {
    DeclareUpdate<&Squares::Update>(Every{Period(1, 10)}, Writes(last_), total_);
  }
  mutable int calls{0};
  mutable bool broken{false};

 private:
  void CalcSquares(VectorView x, Work& work) const {
    ++calls;
    if (broken) throw std::runtime_error("broken on purpose");
    work.squares.clear();
    for (const double value : x) work.squares.push_back(value * value);
    ++work.computed;
  }
  void CalcTotal(const Work& work, double& total) const {
    total = 0.0;
    for (const double square : work.squares) total += square;
  }
  void CalcSum(const double& total, MutableVectorView out) const { out[0] = total; }
  void CalcLargest(const Work& work, VectorView /*idle*/, MutableVectorView out) const {
    out[0] = *std::max_element(work.squares.begin(), work.squares.end());
  }
  void Update(const double& total, MutableVectorView next) const { next[0] = total; }

  const Size size_;
  const DiscreteState<Vector> last_;

 public:
  const Input<Vector> in;
  const Input<Vector> idle;
  const Cached<Work> squares;

 private:
  const Cached<double> total_;

 public:
  const Output<Vector> sum;
  const Output<Vector> largest;
  const Output<Vector> last;
};

/// The squares alone, [3, 4] at the input.
class CachedTest : public testing::Test {
 protected:
  CachedTest() {
    auto system = std::make_unique<Squares>();
    squares_ = system.get();
    diagram_ = MakeDiagramOf(std::move(system), {{"in", 2}, {"idle", 1}});
    context_ = std::make_unique<Context>(diagram_->MakeContext());
    squares_->in.Fix(*context_, Vec({3.0, 4.0}));
    squares_->idle.Fix(*context_, Vec({0.0}));
  }
  double Sum() const { return squares_->sum.Eval(*context_)[0]; }
  double Largest() const { return squares_->largest.Eval(*context_)[0]; }

  const Squares* squares_;
  std::unique_ptr<Diagram> diagram_;
  std::unique_ptr<Context> context_;
};

TEST_F(CachedTest, IsComputedOnceForAllThatReadIt) {
  EXPECT_EQ(Sum(), 25.0);
  EXPECT_EQ(Largest(), 16.0);
  EXPECT_EQ(squares_->squares.Eval(*context_).squares, std::vector<double>({9.0, 16.0}));
  EXPECT_EQ(squares_->calls, 1);
}

TEST_F(CachedTest, IsComputedAgainOnlyIfSomethingThatItReadsHasChanged) {
  Sum();
  context_->SetTime(1.0);
  squares_->idle.Fix(*context_, Vec({7.0}));
  EXPECT_EQ(Largest(), 16.0);
  EXPECT_EQ(squares_->calls, 1);
  squares_->in.Fix(*context_, Vec({1.0, 1.0}));
  EXPECT_EQ(Largest(), 1.0);
  EXPECT_EQ(Sum(), 2.0);
  EXPECT_EQ(squares_->calls, 2);
}

TEST_F(CachedTest, IsComputedInPlaceOfTheLastValue) {
  Sum();
  squares_->in.Fix(*context_, Vec({1.0, 2.0}));
  EXPECT_EQ(squares_->squares.Eval(*context_).computed, 2);
  if (!kCountsAllocations) return;
  const std::int64_t before = AllocationCount();
  for (int i = 0; i < 10; ++i) {
    squares_->in.Fix(*context_, Eigen::Vector2d(i, 1.0));
    squares_->sum.Eval(*context_);
  }
  EXPECT_EQ(AllocationCount(), before);
}

TEST_F(CachedTest, IsNoPortThatOthersSee) {
  EXPECT_EQ(squares_->outputs().size(), 3u);
  EXPECT_EQ(squares_->cached().size(), 2u);
  EXPECT_THROW(diagram_->FindOutput("squares"), WiringError);
  EXPECT_THROW(diagram_->FindOutput("system.total"), WiringError);
}

TEST_F(CachedTest, ACopyOfTheContextHasItsOwnValue) {
  Sum();
  const Context copy = *context_;
  squares_->in.Fix(*context_, Vec({1.0, 1.0}));
  EXPECT_EQ(Sum(), 2.0);
  EXPECT_EQ(squares_->sum.Eval(copy)[0], 25.0);
  EXPECT_EQ(squares_->squares.Eval(copy).squares, std::vector<double>({9.0, 16.0}));
  EXPECT_EQ(squares_->calls, 2);  // nothing was computed again for the copy
  *context_ = copy;
  EXPECT_EQ(Largest(), 16.0);
  EXPECT_EQ(squares_->calls, 2);
}

TEST_F(CachedTest, AFailureIsToldOfTheFirstOutputThatReadsIt) {
  squares_->broken = true;
  try {
    Largest();
    FAIL();
  } catch (const SimulationError& error) {
    EXPECT_EQ(error.system, "system");
    EXPECT_EQ(error.port, "sum");
    EXPECT_THAT(error.what(), HasSubstr("broken on purpose"));
  }
  squares_->broken = false;
  EXPECT_EQ(Largest(), 16.0);
}

TEST_F(CachedTest, AnOutputIsFoundNotFiniteWhatItsCachedValueMayBe) {
  squares_->in.Fix(*context_, Vec({1e200, 1.0}));
  EXPECT_EQ(squares_->squares.Eval(*context_).squares[0], INFINITY);
  EXPECT_THROW(Sum(), SimulationError);
}

TEST_F(CachedTest, AnUnfixedInputIsToldOf) {
  const Context fresh = diagram_->MakeContext();
  EXPECT_THROW(squares_->sum.Eval(fresh), SimulationError);
  EXPECT_THROW(squares_->squares.Eval(fresh), SimulationError);
}

TEST_F(CachedTest, UpdatesReadItToo) {
  Simulator simulator(*diagram_, *context_);
  simulator.AdvanceTo(0.05);
  EXPECT_EQ(squares_->last.Eval(simulator.context())[0], 25.0);
}

TEST_F(CachedTest, RunsWithoutTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  Simulator simulator(*diagram_, *context_);
  simulator.Initialize();
  const std::int64_t before = AllocationCount();
  simulator.AdvanceTo(1.0);
  EXPECT_EQ(AllocationCount(), before);
}

TEST_F(CachedTest, OutputsDependOnWhatItReads) {
  const auto depends = [&](const OutputHandle& output, const char* input) {
    const Upstream upstream = diagram_->UpstreamOf(output, Through::kInstant);
    const auto& found = upstream.exported;
    return std::find(found.begin(), found.end(), diagram_->FindInput(input)) != found.end();
  };
  EXPECT_TRUE(depends(squares_->sum, "in"));
  EXPECT_FALSE(depends(squares_->sum, "idle"));
  EXPECT_TRUE(depends(squares_->largest, "idle"));
  const Upstream of_sum = diagram_->UpstreamOf(squares_->sum, Through::kInstant);
  EXPECT_EQ(of_sum.outputs.size(), 1u);  // the cached values are none
}

TEST(CachedInDiagramTest, ALoopThroughItIsAlgebraicAndIsShownByItsPorts) {
  DiagramBuilder builder;
  const auto& squares = builder.Add<Squares>("squares");
  const auto& map = builder.Add<blocks::Map>("map");
  builder.Connect(squares.sum, map.in);
  builder.Connect(map.out, squares.in);
  builder.ExportInput("idle", squares.idle);
  EXPECT_THAT(blocks::ProblemsOf(builder),
              ElementsAre(testing::AnyOf(
                  HasSubstr("loop: squares.sum -> map.in -> map.out -> squares.in -> squares.sum;"),
                  HasSubstr("loop: map.out -> squares.in -> squares.sum -> map.in -> map.out;"))));
}

TEST(CachedInDiagramTest, EachOfANestedDiagramHasItsOwn) {
  DiagramBuilder builder;
  const Squares* inner[2];
  for (const int i : {0, 1}) {
    DiagramBuilder nested;
    inner[i] = &nested.Add<Squares>("squares");
    nested.ExportInput("in", inner[i]->in);
    nested.ExportInput("idle", inner[i]->idle);
    nested.ExportOutput("sum", inner[i]->sum);
    const System& part = builder.AddSystem("part_" + std::to_string(i), nested.Build());
    builder.ExportInput("in_" + std::to_string(i), part.FindInput("in"), 2);
    builder.ExportInput("idle", part.FindInput("idle"));
  }
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("idle").Fix(context, Vec({0.0}));
  diagram->GetInput<Vector>("in_0").Fix(context, Vec({1.0, 2.0}));
  diagram->GetInput<Vector>("in_1").Fix(context, Vec({3.0, 4.0}));
  EXPECT_EQ(inner[0]->sum.Eval(context)[0], 5.0);
  EXPECT_EQ(inner[1]->sum.Eval(context)[0], 25.0);
  EXPECT_EQ(inner[0]->squares.Eval(context).squares[1], 4.0);
  EXPECT_EQ(inner[1]->squares.Eval(context).squares[1], 16.0);
}

TEST(CachedInDiagramTest, OneOfAnotherSystemIsRefused) {
  struct Thief final : System {
    explicit Thief(const Cached<Squares::Work>& work)
        : out(DeclareOutput<Vector, &Thief::Calc>("out", {1}, work)) {}
    void Calc(const Squares::Work&, MutableVectorView value) const { value.setZero(); }
    const Output<Vector> out;
  };
  const Squares squares;
  try {
    const Thief thief(squares.squares);
    FAIL();
  } catch (const WiringError& error) {
    EXPECT_THAT(error.what(), HasSubstr("output 'out': reads; got a cached value of another"));
  }
}

/// Shows the members of a cached value.
class Members final : public System {
 public:
  struct Parts {
    Eigen::VectorXd vector;
    int number{0};
    bool flag{false};
    Label label;
  };
  Members()
      : parts_(DeclareCached<&Members::CalcParts>(kTime)),
        vector(DeclareOutput<Vector, &Parts::vector>("vector", {2}, parts_)),
        number(DeclareOutput<Vector, &Parts::number>("number", {1}, parts_)),
        flag(DeclareOutput<Vector, &Parts::flag>("flag", {1}, parts_)),
        label(DeclareOutput<Label, &Parts::label>("label", {}, parts_)) {}

 private:
  void CalcParts(double t, Parts& parts) const {
    parts = {Vec({t, 2.0 * t}), static_cast<int>(t), t > 1.0, {"at " + std::to_string(t)}};
  }
  const Cached<Parts> parts_;

 public:
  const Output<Vector> vector, number, flag;
  const Output<Label> label;
};

TEST(CachedInDiagramTest, OutputsShowItsMembers) {
  auto system = std::make_unique<Members>();
  const Members& members = *system;
  const auto diagram = MakeDiagramOf(std::move(system));
  Context context = diagram->MakeContext();
  EXPECT_EQ(members.flag.Eval(context)[0], 0.0);
  context.SetTime(3.5);
  EXPECT_EQ(Eigen::VectorXd(members.vector.Eval(context)), Vec({3.5, 7.0}));
  EXPECT_EQ(members.number.Eval(context)[0], 3.0);
  EXPECT_EQ(members.flag.Eval(context)[0], 1.0);
  EXPECT_EQ(members.label.Eval(context).text, "at 3.500000");
}

/// A value that only states hold: neither written nor read as JSON.
struct Memory {
  double value{0.0};
};

}  // namespace cached_test

template <>
struct Signal<cached_test::Memory> {
  static constexpr const char* kName = "Memory";
  static Fault Check(const cached_test::Memory& memory, Look /*look*/) {
    return Fault::UnlessFinite(AllFinite(&memory.value, 1));
  }
};

namespace cached_test {

TEST(SignalsWithoutJsonTest, AreStatesOnly) {
  static_assert(!Shown<Memory> && !Taken<Memory>);
  static_assert(Shown<Label> && Taken<Label> && Shown<Vector> && Taken<Vector>);
  EXPECT_EQ(TypeOf<Memory>().write_json, nullptr);
  EXPECT_EQ(TypeOf<Memory>().read_json, nullptr);
  const auto refusal = [](const FunctionPorts& ports, const auto& callable) -> std::string {
    try {
      MakeBlock(ports, callable);
    } catch (const WiringError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refusal({.inputs = {{"in"}}, .output = {"out", 1}},
                      [](const Memory& memory) { return memory.value; }),
              HasSubstr("input 'in': type; got Memory, which is not read from JSON"));
  EXPECT_THAT(refusal({.output = {"out"}}, [](double t) { return Memory{t}; }),
              HasSubstr("output 'out': type; got Memory, which is not written as JSON"));
}

}  // namespace cached_test
}  // namespace oca
