// SPDX-License-Identifier: BSD-3-Clause
// Every integrator on every problem: no more than five times the error of SUNDIALS by itself.
#include "tests/verification/problems.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/framework/simulation/integrator_kinds.h"
#include "tests/verification/yardstick.h"

namespace oca::verification {
namespace problems_test {

/// Where rounding takes over: a hundred units in the last place of 1.
constexpr double kRounding = 2e-14;
constexpr double kGate = 5.0;

using Case = std::pair<std::string, IntegratorKind>;

std::string NameOf(const testing::TestParamInfo<Case>& info) {
  const auto& [problem, kind] = info.param;
  return problem + "_" + EnumNames(kind)[static_cast<std::size_t>(kind)];
}

/// Every problem with every integrator; stiff ones with cvode_bdf alone.
std::vector<Case> Cases(std::span<const IntegratorKind> kinds) {
  std::vector<Case> cases;
  for (const Problem& problem : Problems()) {
    for (const IntegratorKind kind : kinds) {
      if (problem.stiff && kind != IntegratorKind::kCvodeBdf) continue;
      cases.emplace_back(problem.name, kind);
    }
  }
  return cases;
}

constexpr IntegratorKind kFixedIntegrators[] = {IntegratorKind::kFixedDp5,
                                                IntegratorKind::kFixedRk4};

class ProblemTest : public testing::TestWithParam<Case> {
 protected:
  const Problem& problem() const { return ProblemNamed(GetParam().first); }
  IntegratorKind kind() const { return GetParam().second; }
};

class AdaptiveProblemTest : public ProblemTest {};
INSTANTIATE_TEST_SUITE_P(All, AdaptiveProblemTest, testing::ValuesIn(Cases(kAdaptiveIntegrators)),
                         NameOf);

TEST_P(AdaptiveProblemTest, ErrsNoMoreThanFiveTimesWhatSundialsItselfErrs) {
  for (const double tolerance : {1e-6, 1e-9}) {
    const IntegratorOptions options = WithTolerance(problem(), kind(), tolerance);
    const Outcome ours = Simulate(problem(), options);
    const Outcome theirs = Measure(problem(), options);
    EXPECT_LE(ours.error, kGate * theirs.error + kRounding) << tolerance << " " << theirs.error;
    // A yardstick that is itself far off would gate nothing.
    EXPECT_LT(theirs.error, 2e4 * tolerance) << tolerance;
    EXPECT_LE(ours.calls, 2 * theirs.calls + 50) << tolerance;
  }
}

class FixedProblemTest : public ProblemTest {
 protected:
  IntegratorOptions Steps(int a_second) const {
    return {.integrator = kind(), .fixed_step = 1.0 / a_second};
  }
};
INSTANTIATE_TEST_SUITE_P(All, FixedProblemTest, testing::ValuesIn(Cases(kFixedIntegrators)),
                         NameOf);

TEST_P(FixedProblemTest, ErrsWhatSundialsWithEqualStepsErrs) {
  for (const int a_second : {100, 1000}) {
    const Outcome ours = Simulate(problem(), Steps(a_second));
    const Outcome theirs = Measure(problem(), Steps(a_second));
    EXPECT_LE(ours.error, kGate * theirs.error + kRounding) << a_second << " " << theirs.error;
  }
}

TEST(ObservedOrderTest, IsFiveAndFour) {
  for (const auto& [name, steps] : OrderCases()) {
    for (const int from : {steps, 2 * steps}) {
      const Problem& problem = ProblemNamed(name);
      EXPECT_NEAR(ObservedOrder(problem, IntegratorKind::kFixedDp5, from), 5.0, 0.45) << name;
      EXPECT_NEAR(ObservedOrder(problem, IntegratorKind::kFixedRk4, from), 4.0, 0.45) << name;
    }
  }
}

TEST(YardstickTest, AnErrorOfTheProblemIsSeen) {
  // The checker itself: a frequency off by a millionth must fail the gate at 1e-9.
  Problem wrong = ProblemNamed("sine");
  wrong.derive = [](double t, const double*, double, double* d) { d[0] = std::sin(3.000003 * t); };
  const IntegratorOptions options = WithTolerance(wrong, IntegratorKind::kErkDp5, 1e-9);
  EXPECT_GT(Simulate(wrong, options).error,
            100.0 * Measure(ProblemNamed("sine"), options).error + kRounding);
}

TEST(ProblemsTest, EveryPlantHasItsProblem) {
  for (const PlantCase& plant : PlantCases()) EXPECT_EQ(ProblemNamed(plant.name).plant, &plant);
}

}  // namespace problems_test
}  // namespace oca::verification
