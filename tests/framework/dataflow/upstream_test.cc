// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/upstream.h"

#include <gmock/gmock.h>

#include "tests/framework/dataflow/blocks.h"

namespace oca {
namespace upstream_test {

using testing::ElementsAre;
using testing::IsEmpty;

/// clock -> map -> sum -> delay -> last, sum <- u from outside; ode <- delay -> ode
class UpstreamTest : public testing::Test {
 protected:
  UpstreamTest() {
    DiagramBuilder builder;
    const auto& clock = builder.Add<blocks::Clock>("clock");
    const auto& map = builder.Add<blocks::Map>("map");
    const auto& sum = builder.Add<blocks::Sum>("sum");
    const auto& delay = builder.Add<blocks::Delay>("delay", Every{Period(1, 10)});
    const auto& last = builder.Add<blocks::Map>("last");
    const auto& ode =
        builder.Add<blocks::Ode>("ode", 0.0, [](double, double, double u) { return u; });
    builder.Connect(clock.value, map.in);
    builder.Connect(map.out, sum.in0);
    builder.ExportInput("u", sum.in1);
    builder.Connect(sum.out, delay.in);
    builder.Connect(delay.out, last.in);
    builder.Connect(delay.out, ode.in);
    diagram_ = builder.Build();
  }
  Upstream Of(const char* output, Through through) const {
    return diagram_->UpstreamOf(diagram_->FindOutput(output), through);
  }
  std::vector<std::string> PathsOf(const Upstream& upstream) const {
    std::vector<std::string> paths;
    for (const Upstream::Entry& entry : upstream.outputs) {
      paths.push_back(std::to_string(entry.connections) + " " + diagram_->PathOf(entry.output));
    }
    return paths;
  }
  std::unique_ptr<Diagram> diagram_;
};

TEST_F(UpstreamTest, AtTheInstantStopsAtStates) {
  const Upstream upstream = Of("last.out", Through::kInstant);
  EXPECT_THAT(PathsOf(upstream), ElementsAre("0 last.out", "1 delay.out"));
  ASSERT_EQ(upstream.states.size(), 1u);
  EXPECT_EQ(upstream.states[0].system, diagram_->FindSystem("delay"));
  EXPECT_FALSE(upstream.time);
  EXPECT_FALSE(upstream.of_time_alone());
}

TEST_F(UpstreamTest, ThroughStatesGoesOnToWhatUpdatesRead) {
  const Upstream upstream = Of("last.out", Through::kStates);
  EXPECT_THAT(PathsOf(upstream),
              ElementsAre("0 last.out", "1 delay.out", "2 sum.out", "3 map.out", "4 clock.value"));
  EXPECT_THAT(upstream.exported, ElementsAre(diagram_->FindInput("u")));
  EXPECT_TRUE(upstream.time);
}

TEST_F(UpstreamTest, ThroughStatesGoesOnToWhatDerivativesRead) {
  const Upstream upstream = Of("ode.out", Through::kStates);
  EXPECT_THAT(PathsOf(upstream),
              ElementsAre("0 ode.out", "1 delay.out", "2 sum.out", "3 map.out", "4 clock.value"));
  EXPECT_EQ(upstream.states.size(), 2u);
  EXPECT_THAT(PathsOf(Of("ode.out", Through::kInstant)), ElementsAre("0 ode.out"));
}

TEST_F(UpstreamTest, KnowsWhatTimeAloneMoves) {
  EXPECT_TRUE(Of("map.out", Through::kInstant).of_time_alone());
  EXPECT_FALSE(Of("sum.out", Through::kInstant).of_time_alone());  // u
  EXPECT_THAT(Of("map.out", Through::kStates).exported, IsEmpty());
}

TEST_F(UpstreamTest, OfAnInputBeginsWithItsDriver) {
  const auto of = [&](const char* input) {
    return diagram_->UpstreamOf(diagram_->FindInput(input), Through::kInstant);
  };
  EXPECT_THAT(PathsOf(of("last.in")), ElementsAre("1 delay.out"));
  EXPECT_THAT(of("sum.in1").exported, ElementsAre(diagram_->FindInput("u")));
  EXPECT_THAT(of("u").exported, ElementsAre(diagram_->FindInput("u")));
  EXPECT_THAT(of("sum.in1").outputs, IsEmpty());
}

/// held = state, which a reset writes when in crosses zero; free = in; other input read by nobody.
class Latch final : public System {
 public:
  Latch()
      : state(DeclareDiscreteState("state", {1}, 0.0)),
        in(DeclareInput<Vector>("in", {1})),
        unread(DeclareInput<Vector>("unread", {1})),
        held(DeclareStateOutput("held", state)),
        twice(DeclareOutput<Vector, &Latch::Twice>("twice", {1}, held)) {
    const Witness crossing = DeclareWitness<&Latch::Cross>("crossing", Direction::kBoth, in);
    DeclareReset<&Latch::Set>(When{crossing}, Writes(state), kTime);
  }

 private:
  double Cross(VectorView value) const { return value[0]; }
  void Set(double t, MutableVectorView next) const { next[0] = t; }
  void Twice(VectorView value, MutableVectorView out) const { out = 2.0 * value; }

 public:
  const DiscreteState<Vector> state;
  const Input<Vector> in, unread;
  const Output<Vector> held, twice;
};

TEST(UpstreamOfEventsTest, FollowsWitnessesAndOwnOutputsButNoInputThatNothingReads) {
  DiagramBuilder builder;
  const auto& clock = builder.Add<blocks::Clock>("clock");
  const auto& source = builder.Add<blocks::Source>("source", blocks::Vec({1.0}));
  const auto& latch = builder.Add<Latch>("latch");
  builder.Connect(clock.value, latch.in);
  builder.Connect(source.value, latch.unread);
  const auto diagram = builder.Build();
  const Upstream upstream = diagram->UpstreamOf(latch.twice, Through::kStates);
  std::vector<std::string> paths;
  for (const auto& entry : upstream.outputs) paths.push_back(diagram->PathOf(entry.output));
  EXPECT_THAT(paths, ElementsAre("latch.twice", "latch.held", "clock.value"));
  EXPECT_EQ(upstream.outputs[1].connections, 0);
}

TEST(UpstreamOfLoopsTest, EndsInALoopAndListsEachOnce) {
  DiagramBuilder builder;
  const auto& map = builder.Add<blocks::Map>("map");
  const auto& delay = builder.Add<blocks::Delay>("delay", Every{Period(1, 10)});
  builder.Connect(map.out, delay.in);
  builder.Connect(delay.out, map.in);
  const auto diagram = builder.Build();
  const Upstream upstream = diagram->UpstreamOf(map.out, Through::kStates);
  EXPECT_EQ(upstream.outputs.size(), 2u);
  EXPECT_EQ(upstream.states.size(), 1u);
}

}  // namespace upstream_test
}  // namespace oca
