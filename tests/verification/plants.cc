// SPDX-License-Identifier: BSD-3-Clause
#include "tests/verification/plants.h"

#include <stdexcept>
#include <utility>

#include "oca/systems/basics/first_order_lag.h"
#include "oca/systems/basics/gain.h"
#include "oca/systems/basics/integrator.h"
#include "oca/systems/basics/ramp_source.h"
#include "oca/systems/basics/sine_source.h"
#include "oca/systems/basics/step_source.h"
#include "oca/systems/basics/sum.h"
#include "oca/systems/basics/zero_order_hold.h"
#include "oca/systems/plants/integrator_plant.h"
#include "oca/systems/plants/joint_servo.h"

namespace oca::verification {
namespace {

using namespace systems;  // NOLINT: this file is made of nothing else

/// sin(2 pi t), sampled every millisecond, into an integrator: sum_k sin(2 pi k / 1000) / 1000.
Plant HeldSineIntoIntegrator() {
  DiagramBuilder builder;
  const auto& sine = builder.Add<SineSource>("sine", SineSource::Params{});
  const auto& hold =
      builder.Add<ZeroOrderHold>("hold", ZeroOrderHold::Params{.period = Period(1, 1000)});
  const auto& integrator = builder.Add<Integrator>("integrator", Integrator::Params{});
  builder.Connect(sine.value, hold.in);
  builder.Connect(hold.out, integrator.in);
  return {builder.Build(), 0.25, {{integrator.out, 0.1586544194927752230}}};
}

/// Time constant 0.05 s behind the source S.
template <class S>
Plant Lag(const typename S::Params& params, double end, double answer) {
  DiagramBuilder builder;
  const auto& source = builder.Add<S>("source", params);
  const auto& lag = builder.Add<FirstOrderLag>("lag", FirstOrderLag::Params{.time_constant = 0.05});
  builder.Connect(source.value, lag.in);
  return {builder.Build(), end, {{lag.out, answer}}};
}

Plant LagOfStep() { return Lag<StepSource>({}, 0.1, 0.8646647167633873); }
Plant LagOfRamp() { return Lag<RampSource>({}, 1.0, 0.9500000001030577); }
Plant LagOfSine() { return Lag<SineSource>({}, 1.0, -0.2859382869574926); }

Plant LagOfStaircase() {
  DiagramBuilder builder;
  const auto& sine = builder.Add<SineSource>("sine", SineSource::Params{});
  const auto& hold =
      builder.Add<ZeroOrderHold>("hold", ZeroOrderHold::Params{.period = Period(1, 100)});
  const auto& lag = builder.Add<FirstOrderLag>("lag", FirstOrderLag::Params{.time_constant = 0.05});
  builder.Connect(sine.value, hold.in);
  builder.Connect(hold.out, lag.in);
  return {builder.Build(), 1.0, {{lag.out, -0.3153806041411361}}};
}

/// Natural frequency 20 rad/s, unit step, at 0.2 s.
Plant ServoStep(double damping_ratio, double position, double velocity) {
  DiagramBuilder builder;
  const auto& step = builder.Add<StepSource>("step", StepSource::Params{});
  const auto& servo =
      builder.Add<JointServo>("servo", JointServo::Params{.mode = ServoMode::kSecondOrder,
                                                          .natural_frequency = 20.0,
                                                          .damping_ratio = damping_ratio});
  const auto& plant = builder.Add<IntegratorPlant>("plant", IntegratorPlant::Params{.order = 2});
  builder.Connect(step.value, servo.position);
  builder.Connect(plant.position, servo.measured_position);
  builder.Connect(plant.velocity, servo.measured_velocity);
  builder.Connect(servo.command, plant.command);
  return {builder.Build(), 0.2, {{plant.position, position}, {plant.velocity, velocity}}};
}

Plant ServoHalfDamped() { return ServoStep(0.5, 1.153122768414049, -0.9905975948382963); }
Plant ServoCritical() { return ServoStep(1.0, 0.9084218055563291, 1.465251111098734); }

/// command = -25 position - 8 velocity, sampled at 100 Hz, on a double integrator from (1, 0).
Plant SampledPd() {
  DiagramBuilder builder;
  const auto& plant = builder.Add<IntegratorPlant>(
      "plant", IntegratorPlant::Params{.order = 2, .initial_position = 1.0});
  const auto& stiffness = builder.Add<Gain>("stiffness", Gain::Params{.gain = 25.0});
  const auto& damping = builder.Add<Gain>("damping", Gain::Params{.gain = 8.0});
  const auto& sum = builder.Add<Sum>("sum", Sum::Params{.signs = Eigen::Vector2d(-1.0, -1.0)});
  const auto& hold =
      builder.Add<ZeroOrderHold>("hold", ZeroOrderHold::Params{.period = Period(1, 100)});
  builder.Connect(plant.position, stiffness.in);
  builder.Connect(plant.velocity, damping.in);
  builder.Connect(stiffness.out, sum.in[0]);
  builder.Connect(damping.out, sum.in[1]);
  builder.Connect(sum.out, hold.in);
  builder.Connect(hold.out, plant.command);
  return {builder.Build(),
          1.0,
          {{plant.position, -0.01413515785034790}, {plant.velocity, -0.01477991753288962}}};
}

}  // namespace

const std::vector<PlantCase>& PlantCases() {
  static const std::vector<PlantCase> cases{
      {"held_sine_into_integrator", HeldSineIntoIntegrator, true},
      {"lag_of_step", LagOfStep, false},
      {"lag_of_ramp", LagOfRamp, false},
      {"lag_of_sine", LagOfSine, false},
      {"lag_of_staircase", LagOfStaircase, false},
      {"servo_half_damped", ServoHalfDamped, false},
      {"servo_critical", ServoCritical, false},
      {"sampled_pd", SampledPd, true}};
  return cases;
}

const PlantCase& PlantNamed(const std::string& name) {
  for (const PlantCase& plant : PlantCases()) {
    if (plant.name == name) return plant;
  }
  throw std::out_of_range("no plant " + name);
}

}  // namespace oca::verification
