// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/plants/integrator_plant.h"

#include <gmock/gmock.h>

#include <limits>

#include "oca/framework/dataflow/error.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace integrator_plant_test {

using ::testing::HasSubstr;

Eigen::VectorXd One(double value) { return Eigen::VectorXd::Constant(1, value); }

std::string RefusalOf(const IntegratorPlant::Params& params) {
  try {
    IntegratorPlant plant(params);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(IntegratorPlantTest, OrderOneIntegratesTheCommand) {
  SystemBench<IntegratorPlant> bench(
      IntegratorPlant::Params{.initial_position = Eigen::VectorXd(Eigen::Vector2d(1.0, -1.0))});
  bench->command.Fix(bench.context(), Eigen::Vector2d(0.5, 2.0));
  bench.AdvanceTo(2.0);
  EXPECT_NEAR(bench->position.Eval(bench.context())[0], 2.0, 1e-14);
  EXPECT_NEAR(bench->position.Eval(bench.context())[1], 3.0, 1e-14);
  EXPECT_EQ(bench->velocity.Eval(bench.context())[1], 2.0);
}

TEST(IntegratorPlantTest, OrderTwoFallsAlongAParabola) {
  SystemBench<IntegratorPlant> bench(
      IntegratorPlant::Params{.order = 2, .initial_position = 3.0, .initial_velocity = 1.0});
  bench->command.Fix(bench.context(), One(-2.0));
  bench.AdvanceTo(2.0);
  EXPECT_NEAR(bench->position.Eval(bench.context())[0], 3.0 + 2.0 - 4.0, 1e-14);
  EXPECT_NEAR(bench->velocity.Eval(bench.context())[0], 1.0 - 4.0, 1e-14);
}

TEST(IntegratorPlantTest, AStopHoldsTheJointAndLetsItGoBack) {
  SystemBench<IntegratorPlant> bench(IntegratorPlant::Params{.lower = -0.5, .upper = 1.0});
  bench->command.Fix(bench.context(), One(1.0));
  bench.AdvanceTo(0.9);
  EXPECT_NEAR(bench->position.Eval(bench.context())[0], 0.9, 1e-9);
  EXPECT_EQ(bench->velocity.Eval(bench.context())[0], 1.0);
  bench.AdvanceTo(2.0);
  EXPECT_EQ(bench->position.Eval(bench.context())[0], 1.0);
  EXPECT_EQ(bench->velocity.Eval(bench.context())[0], 0.0);
  bench->command.Fix(bench.context(), One(-1.0));
  EXPECT_EQ(bench->velocity.Eval(bench.context())[0], -1.0);
  bench.AdvanceTo(2.25);
  // The state had passed the stop by the error that the integrator may make.
  EXPECT_NEAR(bench->position.Eval(bench.context())[0], 0.75, 1e-4);
  bench.AdvanceTo(9.0);
  EXPECT_EQ(bench->position.Eval(bench.context())[0], -0.5);
}

TEST(IntegratorPlantTest, OneStopLeavesTheOtherSideFree) {
  SystemBench<IntegratorPlant> bench(IntegratorPlant::Params{.upper = 1.0});
  bench->command.Fix(bench.context(), One(-1.0));
  bench.AdvanceTo(50.0);
  EXPECT_NEAR(bench->position.Eval(bench.context())[0], -50.0, 1e-9);
}

TEST(IntegratorPlantTest, OrderTwoStopsAtAStopUntilTheCommandHasBrakedIt) {
  SystemBench<IntegratorPlant> bench(
      IntegratorPlant::Params{.order = 2, .initial_velocity = 1.0, .upper = 0.5});
  bench->command.Fix(bench.context(), One(0.0));
  bench.AdvanceTo(1.0);
  EXPECT_EQ(bench->position.Eval(bench.context())[0], 0.5);
  EXPECT_EQ(bench->velocity.Eval(bench.context())[0], 0.0);
  bench->command.Fix(bench.context(), One(-1.0));
  bench.AdvanceTo(1.9);  // the state brakes from 1 to 0.1
  EXPECT_EQ(bench->velocity.Eval(bench.context())[0], 0.0);
  bench.AdvanceTo(3.0);
  EXPECT_NEAR(bench->velocity.Eval(bench.context())[0], -1.0, 1e-6);
  EXPECT_LT(bench->position.Eval(bench.context())[0], 0.1);
}

TEST(IntegratorPlantTest, RefusesOtherOrders) {
  EXPECT_EQ(RefusalOf({.order = 3}), "order: got 3; expected in [1, 2]");
  EXPECT_EQ(RefusalOf({.order = 0}), "order: got 0; expected in [1, 2]");
}

TEST(IntegratorPlantTest, RefusesAVelocityThatOrderOneCannotHave) {
  EXPECT_THAT(RefusalOf({.initial_velocity = 0.1}), HasSubstr("initial_velocity"));
  EXPECT_EQ(RefusalOf({.order = 2, .initial_velocity = 0.1}), "accepted");
}

TEST(IntegratorPlantTest, RefusesAStartBeyondAStop) {
  EXPECT_EQ(RefusalOf({.initial_position = 1.0, .upper = 1.0}), "accepted");
  EXPECT_THAT(RefusalOf({.initial_position = 1.0, .upper = 0.999}), HasSubstr("above upper"));
  EXPECT_THAT(RefusalOf({.initial_position = -1.0, .lower = -0.999}),
              HasSubstr("lower: above initial_position"));
  EXPECT_THAT(RefusalOf({.lower = 1.0, .upper = -1.0}), HasSubstr("lower: above upper"));
}

TEST(IntegratorPlantTest, RefusesListsOfDifferentLengthAndNaN) {
  EXPECT_THROW(IntegratorPlant({.initial_position = Eigen::VectorXd(Eigen::Vector2d::Zero()),
                                .upper = Eigen::VectorXd(Eigen::Vector3d::Ones())}),
               ConfigError);
  EXPECT_THAT(RefusalOf({.initial_position = std::numeric_limits<double>::quiet_NaN()}),
              HasSubstr("initial_position: got nan; expected a finite number"));
}

}  // namespace integrator_plant_test
}  // namespace oca::systems
