// SPDX-License-Identifier: BSD-3-Clause
// Witness functions against closed forms, 400 random cases for each kind of motion and each
// integrator: none missed, none too many, and each at its time.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "oca/framework/simulation/simulator.h"
#include "tests/framework/dataflow/blocks.h"
#include "tests/framework/simulation/integrator_kinds.h"

namespace oca {
namespace witness_random_test {

constexpr int kCases = 400;
constexpr int kGuards = 3;
constexpr double kTimeError = 1e-10;  // s

struct Crossing {
  double time;
  int guard;
  bool operator<(const Crossing& other) const {
    return std::tie(time, guard) < std::tie(other.time, other.guard);
  }
};

/// x' = f(x) and guards w_i(t, x), whose crossings it notes; a jump of x at each crossing and at
/// each tick of 0.1 s.
class Guarded final : public System {
 public:
  struct Motion {
    Eigen::VectorXd start;
    std::function<void(VectorView, MutableVectorView)> derive;
    std::function<double(int, VectorView)> guard;
    std::array<Direction, kGuards> directions;
    std::function<void(int, MutableVectorView)> jump = [](int, MutableVectorView) {};
    std::function<void(double, MutableVectorView)> jump_at_tick{};
  };

  explicit Guarded(Motion motion)
      : motion_(std::move(motion)),
        x_(DeclareContinuousState("x", {static_cast<int>(motion_.start.size())}, motion_.start)) {
    DeclareDerivative<&Guarded::Derive>(x_, x_);
    DeclareGuard<0>();
    DeclareGuard<1>();
    DeclareGuard<2>();
    if (motion_.jump_at_tick) {
      DeclareReset<&Guarded::JumpAtTick>(Every{Period(1, 10)}, Writes(x_), kTime, x_);
    }
  }
  mutable std::vector<Crossing> crossings;

 private:
  template <int kGuard>
  void DeclareGuard() {
    const Witness witness = DeclareWitness<&Guarded::Guard<kGuard>>(
        "guard" + std::to_string(kGuard), motion_.directions[kGuard], x_);
    DeclareReset<&Guarded::Note<kGuard>>(When{witness}, Writes(x_), kTime, x_);
  }
  void Derive(VectorView x, MutableVectorView derivative) const { motion_.derive(x, derivative); }
  template <int kGuard>
  double Guard(VectorView x) const {
    return motion_.guard(kGuard, x);
  }
  template <int kGuard>
  void Note(double t, VectorView, MutableVectorView next) const {
    crossings.push_back({t, kGuard});
    motion_.jump(kGuard, next);
  }
  void JumpAtTick(double t, VectorView, MutableVectorView next) const {
    motion_.jump_at_tick(t, next);
  }

  const Motion motion_;
  const ContinuousState x_;
};

class WitnessRandomTest : public testing::TestWithParam<IntegratorKind> {
 protected:
  IntegratorOptions Tight() const {
    // BDF adds up more error than it is allowed a step.
    const double tolerance = GetParam() == IntegratorKind::kCvodeBdf ? 1e-14 : 1e-12;
    return {.integrator = GetParam(),
            .relative_tolerance = tolerance,
            .absolute_tolerance = tolerance,
            .max_step = 0.01,
            .fixed_step = GetParam() == IntegratorKind::kFixedRk4 ? 5e-4 : 2e-3};
  }

  void Expect(const Guarded::Motion& motion, double end, const IntegratorOptions& options,
              std::vector<Crossing> expected) const {
    std::sort(expected.begin(), expected.end());
    const auto diagram = MakeDiagramOf(std::make_unique<Guarded>(motion));
    const auto& guarded = static_cast<const Guarded&>(*diagram->FindSystem("system"));
    Simulator simulator(*diagram, options);
    simulator.AdvanceTo(end);
    std::vector<Crossing>& found = guarded.crossings;
    std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
      return std::fabs(a.time - b.time) < kTimeError ? a.guard < b.guard : a.time < b.time;
    });
    ASSERT_EQ(found.size(), expected.size()) << Show(found) << "; expected " << Show(expected);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].guard, expected[i].guard) << expected[i].time;
      EXPECT_NEAR(found[i].time, expected[i].time, kTimeError) << expected[i].guard;
    }
    // Simultaneous crossings are one step.
    const auto same = [](const Crossing& a, const Crossing& b) { return a.time == b.time; };
    expected.erase(std::unique(expected.begin(), expected.end(), same), expected.end());
    EXPECT_EQ(simulator.statistics().crossings, static_cast<int>(expected.size()));
  }

  static std::string Show(const std::vector<Crossing>& crossings) {
    std::string text;
    for (const Crossing& crossing : crossings) {
      text += std::to_string(crossing.guard) + "@" + std::to_string(crossing.time) + " ";
    }
    return text.empty() ? "none" : text;
  }
};
INSTANTIATE_TEST_SUITE_P(Integrators, WitnessRandomTest, testing::ValuesIn(kAllIntegrators),
                         NameOfKind);

using Rng = std::mt19937;
double Uniform(Rng& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}
int Pick(Rng& rng, int count) { return std::uniform_int_distribution<int>(0, count - 1)(rng); }
std::array<Direction, kGuards> RandomDirections(Rng& rng) {
  std::array<Direction, kGuards> directions{};
  for (Direction& direction : directions) direction = static_cast<Direction>(Pick(rng, 3));
  return directions;
}
bool Counts(Direction direction, bool rises) {
  return direction == Direction::kBoth || (direction == Direction::kRising) == rises;
}

/// A polynomial by its sign at minus infinity and its simple roots.
struct Polynomial {
  double sign;
  std::vector<double> roots;
  double operator()(double s) const {
    double value = sign;
    for (const double root : roots) value *= root - s;
    return value;
  }
};

/// Up to four roots no closer than 0.1 ms; some at 0, where the guard starts at rest, some at
/// ticks, some where another guard has one.
Polynomial RandomPolynomial(Rng& rng, const std::vector<double>& others) {
  Polynomial polynomial{Pick(rng, 2) == 0 ? -1.0 : 1.0, {}};
  const int count = Pick(rng, 5);
  while (static_cast<int>(polynomial.roots.size()) < count) {
    double root = Uniform(rng, 0.0, 1.0);
    const int kind = Pick(rng, 8);
    if (kind == 0) root = 0.0;
    if (kind == 1) root = (1 + Pick(rng, 9)) / 10.0;
    if (kind == 2 && !others.empty()) root = others[Pick(rng, static_cast<int>(others.size()))];
    if (kind == 3 && !polynomial.roots.empty()) {
      root = polynomial.roots.back() + Uniform(rng, 2e-4, 2e-3);
    }
    bool apart = root < 0.9999;
    for (const double other : polynomial.roots) apart &= std::fabs(root - other) > 1e-4;
    for (const double other : others) {
      apart &= root == other || std::fabs(root - other) > 1e-6;
    }
    if (apart) polynomial.roots.push_back(root);
  }
  std::sort(polynomial.roots.begin(), polynomial.roots.end());
  return polynomial;
}

TEST_P(WitnessRandomTest, PolynomialsCrossAtTheirRoots) {
  Rng rng(20240611);
  for (int i = 0; i < kCases && !HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "case " << i);
    std::array<Polynomial, kGuards> guards;
    std::vector<double> roots;
    Guarded::Motion motion{blocks::Vec({0.0}), [](VectorView, MutableVectorView d) { d[0] = 1.0; },
                           [&](int guard, VectorView x) { return guards[guard](x[0]); },
                           RandomDirections(rng)};
    if (Pick(rng, 2) == 0) motion.jump_at_tick = [](double, MutableVectorView) {};
    std::vector<Crossing> expected;
    for (int guard = 0; guard < kGuards; ++guard) {
      guards[guard] = RandomPolynomial(rng, roots);
      bool rises = guards[guard].sign < 0.0;
      for (const double root : guards[guard].roots) {
        roots.push_back(root);
        if (root > 0.0 && Counts(motion.directions[guard], rises))
          expected.push_back({root, guard});
        rises = !rises;
      }
    }
    IntegratorOptions options{.integrator = GetParam()};
    options.fixed_step = 0.05;
    Expect(motion, 1.0, options, expected);
  }
}

TEST_P(WitnessRandomTest, AnOscillatorPassesLevelsWhenTheCosineDoes) {
  Rng rng(20240612);
  for (int i = 0; i < kCases && !HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "case " << i);
    const double omega = Uniform(rng, 2.0, 9.0), phase = Uniform(rng, 0.0, 6.2);
    // An order of 3 takes its time at this tolerance.
    const double end = GetParam() == IntegratorKind::kErkBs3 ? 0.2 : 0.7;
    std::array<double, kGuards> levels{};
    for (double& level : levels) level = Uniform(rng, -0.99, 0.99);
    // With the level at the start, the guard begins at rest.
    if (Pick(rng, 4) == 0) levels[0] = std::cos(phase);
    const Guarded::Motion motion{blocks::Vec({std::cos(phase), -std::sin(phase)}),
                                 [&](VectorView x, MutableVectorView d) {
                                   d[0] = omega * x[1];
                                   d[1] = -omega * x[0];
                                 },
                                 [&](int guard, VectorView x) { return x[0] - levels[guard]; },
                                 RandomDirections(rng)};
    std::vector<Crossing> expected;
    for (int guard = 0; guard < kGuards; ++guard) {
      for (int turn = 0; turn < 4; ++turn) {
        for (const double side : {-1.0, 1.0}) {
          const double angle = 2.0 * std::numbers::pi * turn + side * std::acos(levels[guard]);
          const double time = (angle - phase) / omega;
          const bool rises = std::sin(angle) < 0.0;
          if (time > 1e-9 && time < end && Counts(motion.directions[guard], rises)) {
            expected.push_back({time, guard});
          }
        }
      }
    }
    Expect(motion, end, Tight(), expected);
  }
}

TEST_P(WitnessRandomTest, AWalkerThatTurnsAndIsThrownCrossesWhereArithmeticSays) {
  Rng rng(20240613);
  for (int i = 0; i < kCases && !HasFailure(); ++i) {
    SCOPED_TRACE(testing::Message() << "case " << i);
    // x' = v between walls; the walls turn it, a tick throws it, sometimes over a wall or onto the
    // middle, where its guard then rests.
    const double wall = Uniform(rng, 0.05, 0.3);
    std::array<double, 12> thrown{};
    for (double& to : thrown) to = Pick(rng, 4) == 0 ? 0.0 : Uniform(rng, -1.3, 1.3) * wall;
    const double speed = Uniform(rng, 0.5, 4.0);
    Guarded::Motion motion{blocks::Vec({0.0, speed}),
                           [](VectorView x, MutableVectorView d) {
                             d[0] = x[1];
                             d[1] = 0.0;
                           },
                           [&](int guard, VectorView x) { return x[0] - (guard - 1) * wall; },
                           {Direction::kFalling, Direction::kBoth, Direction::kRising}};
    motion.jump = [](int guard, MutableVectorView x) {
      if (guard != 1) x[1] = -x[1];
    };
    motion.jump_at_tick = [&](double t, MutableVectorView x) {
      x[0] = thrown[static_cast<std::size_t>(std::lround(10.0 * t))];
    };
    std::vector<Crossing> expected;
    double x = 0.0, v = speed;
    for (int tick = 0; tick < 5; ++tick) {
      double t = tick / 10.0;
      x = thrown[tick];
      for (;;) {
        // The next of the three lines ahead; one that it stands on is not ahead.
        int next = -1;
        for (int guard = 0; guard < kGuards; ++guard) {
          const double ahead = ((guard - 1) * wall - x) / v;
          const bool counts = guard == 1 || (guard == 0 ? v < 0.0 : v > 0.0);
          if (ahead > 1e-15 && counts && (next < 0 || ahead < ((next - 1) * wall - x) / v)) {
            next = guard;
          }
        }
        const double time = next < 0 ? 1e9 : t + ((next - 1) * wall - x) / v;
        if (time > (tick + 1) / 10.0) {
          break;
        }
        expected.push_back({time, next});
        x = (next - 1) * wall;
        t = time;
        if (next != 1) v = -v;
      }
    }
    Expect(motion, 0.5, {.integrator = GetParam(), .fixed_step = 0.013}, expected);
  }
}

}  // namespace witness_random_test
}  // namespace oca
