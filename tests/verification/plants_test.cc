// SPDX-License-Identifier: BSD-3-Clause
// The product's own blocks, wired to plants whose answer is known to 15 digits. problems_test.cc
// holds their errors against those of SUNDIALS itself.
#include "tests/verification/plants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/simulation/simulator.h"
#include "tests/framework/simulation/integrator_kinds.h"

namespace oca::verification {
namespace plants_test {

constexpr double kRounding = 1e-14;

/// The largest error of a plant's answers.
double ErrorOf(const PlantCase& plant_case, const IntegratorOptions& options) {
  const Plant plant = plant_case.make();
  Simulator simulator(*plant.diagram, options);
  simulator.AdvanceTo(plant.end);
  double error = 0.0;
  for (const Plant::Answer& answer : plant.answers) {
    error = std::max(error, std::fabs(answer.output.Eval(simulator.context())[0] - answer.value));
  }
  return error;
}

IntegratorOptions WithTolerance(IntegratorKind kind, double relative) {
  return {
      .integrator = kind, .relative_tolerance = relative, .absolute_tolerance = 1e-3 * relative};
}

using CaseAndKind = std::tuple<PlantCase, IntegratorKind>;

std::string NameOf(const testing::TestParamInfo<CaseAndKind>& info) {
  const auto& [plant, kind] = info.param;
  return plant.name + "_" + EnumNames(kind)[static_cast<std::size_t>(kind)];
}

class PlantTest : public testing::TestWithParam<CaseAndKind> {
 protected:
  const PlantCase& plant() const { return std::get<0>(GetParam()); }
  IntegratorKind kind() const { return std::get<1>(GetParam()); }
};

class AdaptivePlantTest : public PlantTest {};
INSTANTIATE_TEST_SUITE_P(
    All, AdaptivePlantTest,
    testing::Combine(testing::ValuesIn(PlantCases()),
                     testing::Values(IntegratorKind::kErkDp5, IntegratorKind::kErkBs3,
                                     IntegratorKind::kCvodeAdams, IntegratorKind::kCvodeBdf)),
    NameOf);

TEST_P(AdaptivePlantTest, ErrorFollowsTheTolerance) {
  const double loose = ErrorOf(plant(), WithTolerance(kind(), 1e-4));
  const double tight = ErrorOf(plant(), WithTolerance(kind(), 1e-10));
  if (loose < kRounding) {
    EXPECT_TRUE(plant().polynomial);
    EXPECT_LT(tight, kRounding);
    return;
  }
  // Six decades of tolerance, and at least three of error whatever cancels on the way.
  EXPECT_GT(loose / tight, 1e3);
}

class FixedPlantTest : public PlantTest {};
INSTANTIATE_TEST_SUITE_P(All, FixedPlantTest,
                         testing::Combine(testing::ValuesIn(PlantCases()),
                                          testing::Values(IntegratorKind::kFixedDp5,
                                                          IntegratorKind::kFixedRk4)),
                         NameOf);

TEST_P(FixedPlantTest, AMillisecondStepSuffices) {
  const double bound = kind() == IntegratorKind::kFixedDp5 ? 1e-11 : 5e-8;
  EXPECT_LT(ErrorOf(plant(), {.integrator = kind(), .fixed_step = 1e-3}),
            plant().polynomial ? kRounding : bound);
}

TEST(PlantCasesTest, AnAnswerReadAMillisecondEarlyIsOffByAsMuchAsItShould) {
  // The checker itself: it must tell a right answer from a nearby wrong one.
  const Plant plant = PlantNamed("lag_of_step").make();
  Simulator simulator(*plant.diagram, WithTolerance(IntegratorKind::kErkDp5, 1e-9));
  simulator.AdvanceTo(plant.end - 1e-3);
  const double early = plant.answers[0].output.Eval(simulator.context())[0];
  EXPECT_NEAR(plant.answers[0].value - early, std::exp(-2.0) * (std::exp(0.02) - 1.0), 1e-9);
}

}  // namespace plants_test
}  // namespace oca::verification
