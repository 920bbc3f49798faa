// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/plants/joint_servo.h"

#include <gtest/gtest.h>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/commands/spline_generator.h"
#include "oca/systems/fields/delta_limiter.h"
#include "oca/systems/fields/delta_overlay.h"
#include "oca/systems/plants/integrator_plant.h"
#include "tests/systems/system_bench.h"

namespace oca::systems {
namespace joint_servo_test {

Eigen::VectorXd One(double value) { return Eigen::VectorXd::Constant(1, value); }

JointServo::Params Deadbeat() { return {.mode = ServoMode::kDeadbeat, .period = Period(1, 100)}; }

/// Generator -> overlay -> deadbeat servo -> plant, the delta through the limiter.
struct Chain {
  Chain() {
    DiagramBuilder builder;
    generator = &builder.Add<SplineGenerator>(
        "generator", SplineGenerator::Params{.key_points = {{.time = 0.0, .position = One(0.2)},
                                                            {.time = 1.0, .position = One(1.0)}},
                                             .period = Period(1, 100)});
    overlay = &builder.Add<DeltaOverlay>("overlay", DeltaOverlay::Params{.period = Period(1, 100)});
    limiter = &builder.Add<DeltaLimiter>(
        "limiter", DeltaLimiter::Params{.max_joint_velocity = 0.6, .period = Period(1, 100)});
    servo = &builder.Add<JointServo>("servo", Deadbeat());
    plant =
        &builder.Add<IntegratorPlant>("plant", IntegratorPlant::Params{.initial_position = 0.2});
    builder.Connect(generator->position, overlay->request);
    builder.Connect(generator->velocity, overlay->request_velocity);
    builder.Connect(limiter->limited_delta, overlay->delta);
    builder.Connect(overlay->position, servo->position);
    builder.Connect(overlay->velocity, servo->velocity);
    builder.Connect(plant->position, servo->measured_position);
    builder.Connect(servo->command, plant->command);
    builder.ExportInput("delta", limiter->delta);
    diagram = builder.Build();
    simulator = std::make_unique<Simulator>(*diagram);
    limiter->delta.Fix(simulator->context(), One(0.1));
  }
  const SplineGenerator* generator;
  const DeltaOverlay* overlay;
  const DeltaLimiter* limiter;
  const JointServo* servo;
  const IntegratorPlant* plant;
  std::unique_ptr<Diagram> diagram;
  std::unique_ptr<Simulator> simulator;
};

TEST(JointServoTest, DeadbeatReachesRequestPlusDeltaAtTheEndOfEachPeriod) {
  Chain chain;
  const auto request = motion::Trajectory::CubicHermite(
      {{.time = 0.0, .position = One(0.2)}, {.time = 1.0, .position = One(1.0)}});
  for (int k = 0; k < 120; ++k) {
    chain.simulator->AdvanceTo((k + 1) * 0.01);
    // delta_k of the tick that began the period: 0.006 a tick up to 0.1.
    const double delta = std::min(0.006 * (k + 1), 0.1);
    EXPECT_NEAR(chain.plant->position.Eval(chain.simulator->context())[0],
                request.Evaluate((k + 1) * 0.01, 0)[0] + delta, 1e-13)
        << k;
  }
}

TEST(JointServoTest, OverlayAddsTheRateOfTheLimitedDelta) {
  Chain chain;
  chain.simulator->AdvanceTo(0.055);
  EXPECT_NEAR(chain.overlay->velocity.Eval(chain.simulator->context())[0],
              chain.generator->velocity.Eval(chain.simulator->context())[0] + 0.6, 1e-12);
  chain.simulator->AdvanceTo(0.355);
  EXPECT_NEAR(chain.overlay->velocity.Eval(chain.simulator->context())[0],
              chain.generator->velocity.Eval(chain.simulator->context())[0], 1e-12);
}

TEST(JointServoTest, DeadbeatHoldsWhatItSampledAtTheTick) {
  SystemBench<JointServo> bench(Deadbeat());
  bench->position.Fix(bench.context(), One(1.0));
  bench->measured_position.Fix(bench.context(), One(0.75));
  bench.simulator().Initialize();
  EXPECT_DOUBLE_EQ(bench->command.Eval(bench.context())[0], 25.0);
  bench.AdvanceTo(0.005);
  bench->measured_position.Fix(bench.context(), One(0.8));
  EXPECT_DOUBLE_EQ(bench->command.Eval(bench.context())[0], 25.0);
  bench.AdvanceTo(0.015);
  EXPECT_DOUBLE_EQ(bench->command.Eval(bench.context())[0], 20.0);
}

TEST(JointServoTest, SecondOrderWeighsBothErrors) {
  SystemBench<JointServo> bench(JointServo::Params{
      .mode = ServoMode::kSecondOrder, .natural_frequency = 20.0, .damping_ratio = 0.5});
  bench->position.Fix(bench.context(), One(1.0));
  bench->measured_position.Fix(bench.context(), One(0.9));
  Typed<Vector>(bench->measured_velocity).Fix(bench.context(), One(0.5));
  // 400 * 0.1 + 20 * (0 - 0.5)
  EXPECT_NEAR(bench->command.Eval(bench.context())[0], 30.0, 1e-12);
}

TEST(JointServoTest, SecondOrderTracksAVelocityTarget) {
  DiagramBuilder builder;
  const auto& servo =
      builder.Add<JointServo>("servo", JointServo::Params{.mode = ServoMode::kSecondOrder,
                                                          .natural_frequency = 2.0,
                                                          .damping_ratio = 1.0});
  builder.ExportInput("position", servo.position);
  builder.ExportInput("velocity", servo.velocity);
  builder.ExportInput("measured_position", servo.measured_position);
  builder.ExportInput("measured_velocity", servo.measured_velocity);
  const auto diagram = builder.Build();
  Context context = diagram->MakeContext();
  diagram->GetInput<Vector>("position").Fix(context, One(1.0));
  diagram->GetInput<Vector>("velocity").Fix(context, One(3.0));
  diagram->GetInput<Vector>("measured_position").Fix(context, One(0.5));
  diagram->GetInput<Vector>("measured_velocity").Fix(context, One(0.0));
  // 4 * 0.5 + 4 * 3
  EXPECT_DOUBLE_EQ(servo.command.Eval(context)[0], 14.0);
}

TEST(JointServoTest, SecondOrderNeedsTheMeasuredVelocityAndDeadbeatDoesNot) {
  for (const ServoMode mode : {ServoMode::kSecondOrder, ServoMode::kDeadbeat}) {
    DiagramBuilder builder;
    const auto& servo =
        builder.Add<JointServo>("servo", JointServo::Params{.mode = mode, .period = Period(1, 10)});
    builder.ExportInput("position", servo.position);
    builder.ExportInput("measured_position", servo.measured_position);
    if (mode == ServoMode::kDeadbeat) {
      EXPECT_NO_THROW(builder.Build());
    } else {
      EXPECT_THROW(builder.Build(), WiringError);
    }
  }
}

TEST(JointServoTest, RefusesDeadbeatWithoutAPeriod) {
  EXPECT_THROW(JointServo({.mode = ServoMode::kDeadbeat, .period = Period()}), ConfigError);
  EXPECT_NO_THROW(JointServo({.mode = ServoMode::kSecondOrder, .period = Period()}));
}

TEST(JointServoTest, RefusesGainsWithoutSense) {
  EXPECT_THROW(JointServo({.mode = ServoMode::kSecondOrder, .natural_frequency = 0.0}),
               ConfigError);
  EXPECT_THROW(JointServo({.mode = ServoMode::kSecondOrder, .damping_ratio = -0.1}), ConfigError);
  EXPECT_NO_THROW(JointServo({.mode = ServoMode::kSecondOrder, .damping_ratio = 0.0}));
}

}  // namespace joint_servo_test
}  // namespace oca::systems
