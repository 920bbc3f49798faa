// SPDX-License-Identifier: BSD-3-Clause
// The simulator's contract, lines 7 and 8: a run that fails says where and when, keeps the last
// good state, and goes on once the cause is gone.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"
#include "tests/framework/simulation/integrator_kinds.h"

namespace oca {
namespace failure_test {

using blocks::Vec;
using testing::ElementsAre;
using testing::HasSubstr;

/// Fails in one of its parts from a given time on, until it is healed.
class Fragile final : public System {
 public:
  enum class Part { kOutput, kUpdate, kReset, kDerivative, kPublish, kInitialization, kNone };
  enum class How { kThrow, kThrowNumber, kNan };

  Fragile(Part part, How how, double from)
      : part_(part),
        how_(how),
        from_(from),
        held_(DeclareDiscreteState("held", {1}, 0.0)),
        x_(DeclareContinuousState("x", {1}, 0.0)),
        x_out(DeclareStateOutput("x", x_)),
        held_out(DeclareStateOutput("held", held_)),
        out(DeclareOutput<Vector, &Fragile::Calc>("out", {1}, kTime)) {
    DeclareInitialization<&Fragile::Initialize>(Writes(held_), kTime, held_);
    DeclareReset<&Fragile::Reset>(kTick, Writes(x_), kTime, x_);
    DeclareUpdate<&Fragile::Update>(kTick, Writes(held_), kTime, held_);
    DeclareDerivative<&Fragile::Derive>(x_, kTime, out);
    DeclarePublish<&Fragile::Publish>(kTick, kTime, held_, x_);
  }
  mutable bool healed{false};
  mutable std::vector<std::pair<double, double>> published;

 private:
  static inline const Every kTick{Period(1, 10)};

  double Break(Part part, double t) const {
    if (part != part_ || healed || t < from_) return 0.0;
    if (how_ == How::kThrow) throw std::runtime_error("broken on purpose");
    if (how_ == How::kThrowNumber) throw 13;
    return std::numeric_limits<double>::quiet_NaN();
  }
  void Calc(double t, MutableVectorView y) const { y[0] = 1.0 + Break(Part::kOutput, t); }
  void Initialize(double t, VectorView now, MutableVectorView next) const {
    next[0] = now[0] + Break(Part::kInitialization, t);
  }
  void Reset(double t, VectorView now, MutableVectorView next) const {
    next[0] = now[0] + Break(Part::kReset, t);
  }
  void Update(double t, VectorView now, MutableVectorView next) const {
    next[0] = now[0] + 1.0 + Break(Part::kUpdate, t);
  }
  void Derive(double t, VectorView y, MutableVectorView derivative) const {
    derivative[0] = y[0] + Break(Part::kDerivative, t);
  }
  void Publish(double t, VectorView held, VectorView) const {
    Break(Part::kPublish, t);
    published.emplace_back(t, held[0]);
  }

  const Part part_;
  const How how_;
  const double from_;
  const DiscreteState<Vector> held_;
  const ContinuousState x_;

 public:
  const Output<Vector> x_out, held_out, out;
};
using Part = Fragile::Part;
using How = Fragile::How;

struct Case {
  Part part;
  How how;
  const char* port;
  const char* what;
  double good_until;  // time of the context afterwards, s
};

const char* const kThrown = "broken on purpose";
const char* const kUnknown = "an exception of an unknown type";
const Case kCases[] = {
    {Part::kOutput, How::kThrowNumber, "out", kUnknown, 0.3},
    {Part::kUpdate, How::kThrowNumber, "", kUnknown, 0.4},
    {Part::kDerivative, How::kThrowNumber, "x", kUnknown, 0.3},
    {Part::kOutput, How::kThrow, "out", kThrown, 0.3},
    {Part::kOutput, How::kNan, "out", "the value is not finite", 0.3},
    {Part::kUpdate, How::kThrow, "", kThrown, 0.4},
    {Part::kUpdate, How::kNan, "held", "the new state is not finite", 0.4},
    {Part::kReset, How::kThrow, "", kThrown, 0.4},
    {Part::kReset, How::kNan, "x", "the new state is not finite", 0.4},
    {Part::kDerivative, How::kThrow, "x", kThrown, 0.3},
    {Part::kDerivative, How::kNan, "x", "the derivative is not finite", 0.3},
    {Part::kPublish, How::kThrow, "", kThrown, 0.4},
};

class FailureTest : public testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Integrators, FailureTest, testing::ValuesIn(kAllIntegrators), NameOfKind);

struct Bench {
  Bench(Part part, How how) {
    DiagramBuilder inner;
    fragile = &inner.Add<Fragile>("fragile", part, how, kBroken);
    DiagramBuilder builder;
    builder.AddSystem("arm", inner.Build());
    diagram = builder.Build();
  }
  static constexpr double kBroken = 0.35;
  const Fragile* fragile;
  std::unique_ptr<Diagram> diagram;
};

TEST_P(FailureTest, Line7NamesSystemPortAndTimeAndKeepsTheLastGoodState) {
  for (const Case& failure : kCases) {
    const Bench bench(failure.part, failure.how);
    Simulator simulator(*bench.diagram, {.integrator = GetParam()});
    SCOPED_TRACE(testing::Message()
                 << "part " << static_cast<int>(failure.part) << " " << failure.what);
    for (int attempt = 0; attempt < 3; ++attempt) {
      try {
        simulator.AdvanceTo(1.0);
        FAIL() << "nothing thrown";
      } catch (const SimulationError& error) {
        EXPECT_EQ(error.system, "arm.fragile");
        EXPECT_EQ(error.port, failure.port);
        EXPECT_GE(error.time, Bench::kBroken);
        EXPECT_LE(error.time, 0.4 + 1e-12);
        EXPECT_THAT(error.what(), HasSubstr(failure.what));
      }
      EXPECT_EQ(simulator.context().time(), failure.good_until);
      EXPECT_NEAR(bench.fragile->x_out.Eval(simulator.context())[0], failure.good_until, 1e-6);
      EXPECT_EQ(bench.fragile->held_out.Eval(simulator.context())[0], 4.0);
    }
  }
}

TEST_P(FailureTest, Line7ARunGoesOnOnceTheCauseIsGoneAsIfNothingHadHappened) {
  for (const Case& failure : kCases) {
    const Bench bench(failure.part, failure.how);
    Simulator simulator(*bench.diagram, {.integrator = GetParam()});
    SCOPED_TRACE(testing::Message()
                 << "part " << static_cast<int>(failure.part) << " " << failure.what);
    EXPECT_THROW(simulator.AdvanceTo(1.0), SimulationError);
    bench.fragile->healed = true;
    simulator.AdvanceTo(1.0);
    EXPECT_EQ(bench.fragile->held_out.Eval(simulator.context())[0], 10.0);
    EXPECT_NEAR(bench.fragile->x_out.Eval(simulator.context())[0], 1.0, 1e-6);
    // The record has every instant once, each with the state before the instant's update.
    std::vector<std::pair<double, double>> expected;
    for (int i = 0; i <= 10; ++i) expected.emplace_back(i / 10.0, i);
    EXPECT_EQ(bench.fragile->published, expected);
  }
}

TEST_P(FailureTest, Line7DerivativesThatFailAreNotTriedHundredsOfTimes) {
  int calls = 0;
  const auto diagram =
      MakeDiagramOf(std::make_unique<blocks::Ode>(1.0, [&](double t, double, double) -> double {
        if (t > 0.5) ++calls;
        return t > 0.5 ? std::nan("") : 1.0;
      }));
  Simulator simulator(*diagram, {.integrator = GetParam()});
  diagram->GetInput<Vector>("in").Fix(simulator.context(), Vec({0.0}));
  EXPECT_THROW(simulator.AdvanceTo(1.0), SimulationError);
  EXPECT_EQ(calls, 1);
}

/// What a run of x' = f(t, x) says when it stops, and whether a run that may go further succeeds.
std::string StopOf(const blocks::Ode::Function& f, const IntegratorOptions& options) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Ode>(1.0, f));
  Simulator simulator(*diagram, options);
  diagram->GetInput<Vector>("in").Fix(simulator.context(), Vec({0.0}));
  const Status status = simulator.TryAdvanceTo(10.0);
  return status.ok() ? "" : status.message();
}

class StiffnessTest : public testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Explicit, StiffnessTest,
                         testing::Values(IntegratorKind::kErkDp5, IntegratorKind::kErkBs3,
                                         IntegratorKind::kCvodeAdams),
                         NameOfKind);

TEST_P(StiffnessTest, IsToldApartFromALimitThatIsLow) {
  for (const double tolerance : {1e-3, 1e-6}) {
    const IntegratorOptions options{
        .integrator = GetParam(), .relative_tolerance = tolerance, .max_steps = 2000};
    // A lag of a microsecond behind a slow sine, and an oscillation to be resolved wave by wave.
    EXPECT_THAT(
        StopOf([](double t, double x, double) { return -1e6 * (x - std::cos(t)); }, options),
        testing::AllOf(HasSubstr("stiff system; got a fastest rate of 1e+06 1/s"),
                       HasSubstr("expected the integrator cvode_bdf")));
    EXPECT_THAT(
        StopOf([](double t, double x, double) { return -x + 1e3 * std::cos(1e4 * t); }, options),
        testing::AllOf(HasSubstr("got more than max_steps = 2000"),
                       testing::Not(HasSubstr("stiff"))));
  }
}

TEST(StiffnessOfBdfTest, IsNoHindranceAndItsLimitIsOneOfSteps) {
  const auto stiff = [](double t, double x, double) { return -1e6 * (x - std::cos(t)); };
  EXPECT_EQ(StopOf(stiff, {.integrator = IntegratorKind::kCvodeBdf, .max_steps = 2000}), "");
  EXPECT_THAT(StopOf(stiff, {.integrator = IntegratorKind::kCvodeBdf, .max_steps = 20}),
              HasSubstr("got more than max_steps = 20"));
}

TEST_P(FailureTest, Line7NamesAFailureAtEveryStageOfAStep) {
  for (const bool with_nan : {false, true}) {
    for (int stage = 1; stage <= 16; ++stage) {
      int calls = 0;
      bool healed = false;
      const auto diagram = MakeDiagramOf(
          std::make_unique<blocks::Ode>(1.0, [&](double t, double x, double) -> double {
            if (t > 0.5 && !healed && ++calls == stage) {
              if (!with_nan) throw std::runtime_error("broken on purpose");
              return std::nan("");
            }
            return -x;
          }));
      Simulator simulator(*diagram, {.integrator = GetParam(), .max_step = 0.05});
      diagram->GetInput<Vector>("in").Fix(simulator.context(), Vec({0.0}));
      simulator.AdvanceTo(0.5);
      const Status status = simulator.TryAdvanceTo(1.0);
      ASSERT_FALSE(status.ok()) << stage;
      EXPECT_STREQ(status.system(), "system");
      EXPECT_STREQ(status.port(), "x");
      EXPECT_GE(status.time(), 0.5);
      EXPECT_THAT(status.message(), HasSubstr(with_nan ? "is not finite" : "broken on purpose"));
      EXPECT_EQ(simulator.context().time(), 0.5) << stage;
      healed = true;
      EXPECT_TRUE(simulator.TryAdvanceTo(1.0).ok());
      EXPECT_NEAR(diagram->GetOutput<Vector>("out").Eval(simulator.context())[0], std::exp(-1.0),
                  1e-5);
    }
  }
}

TEST(TryAdvanceToTest, TellsWhatTheCallerGotWrongToo) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Counter>(Every{Period(1, 10)}));
  Simulator simulator(*diagram);
  EXPECT_TRUE(simulator.TryAdvanceTo(1.0).ok());
  const Status status = simulator.TryAdvanceTo(0.5);
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(status.message(), HasSubstr("got 0.5; expected at least 1"));
  EXPECT_TRUE(simulator.TryAdvanceTo(2.0).ok());
  EXPECT_EQ(diagram->GetOutput<Vector>("value").Eval(simulator.context())[0], 20.0);
}

TEST(FailureOfStartTest, Line7AFailedInitializationIsTriedAgain) {
  const auto owned =
      MakeDiagramOf(std::make_unique<Fragile>(Part::kInitialization, How::kThrow, 0.0));
  const auto& fragile = static_cast<const Fragile&>(*owned->FindSystem("system"));
  Simulator simulator(*owned);
  EXPECT_THROW(simulator.Initialize(), SimulationError);
  EXPECT_THROW(simulator.AdvanceTo(1.0), SimulationError);
  EXPECT_TRUE(fragile.published.empty());
  fragile.healed = true;
  simulator.AdvanceTo(0.1);
  EXPECT_THAT(fragile.published, ElementsAre(std::pair(0.0, 0.0), std::pair(0.1, 1.0)));
}

TEST(FailureOfStartTest, Line7AnExceptionOfAPublishOfItsOwnReachesTheCallerAndLosesNothing) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Counter>(Every{Period(1, 10)}));
  Simulator simulator(*diagram);
  bool full = true;
  std::vector<double> written;
  simulator.AddPublish(Period(1, 5), [&](const Context& context) {
    if (full && context.time() > 0.3) throw std::runtime_error("disk full");
    written.push_back(diagram->GetOutput<Vector>("value").Eval(context)[0]);
  });
  EXPECT_THROW(simulator.AdvanceTo(1.0), std::runtime_error);
  EXPECT_EQ(simulator.context().time(), 0.4);
  full = false;
  simulator.AdvanceTo(1.0);
  EXPECT_THAT(written, ElementsAre(0.0, 2.0, 4.0, 6.0, 8.0, 10.0));
}

TEST(FailureOfStartTest, AFailedEvaluationIsNotTakenFromTheCache) {
  const auto diagram = MakeDiagramOf(std::make_unique<Fragile>(Part::kOutput, How::kNan, 0.0));
  const auto& fragile = static_cast<const Fragile&>(*diagram->FindSystem("system"));
  const Context context = diagram->MakeContext();
  EXPECT_THROW(fragile.out.Eval(context), SimulationError);
  EXPECT_THROW(fragile.out.Eval(context), SimulationError);
  fragile.healed = true;
  EXPECT_EQ(fragile.out.Eval(context)[0], 1.0);
}

TEST(FailureOfStartTest, AnObjectThatSaysItIsNotFiniteIsRefused) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::LabelSink>());
  Context context = diagram->MakeContext();
  const auto in = diagram->GetInput<Label>("in");
  in.Fix(context, Label{"fine"});
  EXPECT_EQ(diagram->GetOutput<Label>("out").Eval(context).text, "fine");
  EXPECT_THROW(in.Fix(context, Label{"nan"}), ConfigError);
}

TEST(FailureOfStartTest, AVectorThatIsNotFiniteIsRefusedWhereItIsFixed) {
  const auto diagram = MakeDiagramOf(std::make_unique<blocks::Map>());
  Context context = diagram->MakeContext();
  EXPECT_THROW(diagram->GetInput<Vector>("in").Fix(context, Vec({HUGE_VAL})), ConfigError);
  EXPECT_THROW(diagram->GetInput<Vector>("in").Fix(context, Vec({std::nan("")})), ConfigError);
}

}  // namespace failure_test
}  // namespace oca
