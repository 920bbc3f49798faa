// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "oca/framework/dataflow/error.h"
#include "oca/models/random.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

ObstacleSensor::Params Checked(const ObstacleSensor::Params& params) {
  Validated(params);
  if (!(params.stale_until >= params.stale_from)) {
    throw ConfigError(fmt::format("stale_until: got {} s; expected at least stale_from, {} s",
                                  params.stale_until, params.stale_from));
  }
  return params;
}

/// The longest period of which both are multiples; b may be 0.
Period CommonStep(const Period& a, const Period& b) {
  const std::int64_t denominator = std::lcm(a.denominator(), b.denominator());
  return {std::gcd(a.numerator() * (denominator / a.denominator()),
                   b.numerator() * (denominator / b.denominator())),
          denominator};
}

int StepsOf(const Period& span, const Period& step) {
  return static_cast<int>(std::round(span.seconds() / step.seconds()));
}

Period StepOf(const ObstacleSensor::Params& params) {
  const Period step = CommonStep(params.period, params.latency);
  const double most = std::max(params.latency.seconds(), params.period.seconds()) / step.seconds();
  if (most <= ObstacleSensor::kMostSteps) return step;
  throw ConfigError(
      fmt::format("latency: got {}; expected at most {} times {}, which divides it and the period",
                  params.latency.ToString(), ObstacleSensor::kMostSteps, step.ToString()));
}

// Standard normal. source Box, Muller 1958
Eigen::Vector3d DrawNormal(models::Random& random) {
  Eigen::Vector3d g;
  for (double& x : g) {
    const double r = std::sqrt(-2.0 * std::log(1.0 - random.Unit()));
    x = r * std::cos(2.0 * std::numbers::pi * random.Unit());
  }
  return g;
}

}  // namespace

void ObstacleSensor::Params::Describe(Fields<Params>& fields) {
  using P = Params;
  fields.Add("period", &P::period, "s", "time between samples").Above(0.0).Required();
  fields.Add("latency", &P::latency, "s", "age of what is shown when it comes in").AtLeast(0.0);
  fields.Add("velocities", &P::velocities, "",
             "whether the twists of obstacles are reported; false: as a camera, poses alone");
  fields.Add("dropout", &P::dropout, "", "probability that a sample is lost")
      .AtLeast(0.0)
      .AtMost(1.0);
  fields.Add("position_noise", &P::position_noise, "m", "standard deviation along each axis")
      .AtLeast(0.0);
  fields.Add("angle_noise", &P::angle_noise, "rad", "standard deviation about each axis")
      .AtLeast(0.0);
  fields.Add("stale_from", &P::stale_from, "s", "from when on no sample comes").AtLeast(0.0);
  fields.Add("stale_until", &P::stale_until, "s", "until when").AtLeast(0.0);
  fields.Add("seed", &P::seed, "", "of noise and losses").AtLeast(0.0);
}

ObstacleSensor::Params ObstacleSensor::Example() {
  return {.period = Period(1, 100), .latency = Period(1, 50), .position_noise = 0.005};
}

ObstacleSensor::ObstacleSensor(const Params& params)
    : params_(Checked(params)),
      step_(StepOf(params_)),
      every_(StepsOf(params_.period, step_)),
      steps_(StepsOf(params_.latency, step_)),
      line_(DeclareDiscreteState("line", SensorLine())),
      in(DeclareInput<ObstacleSet>("in")),
      obstacles(DeclareObstacles()) {
  DeclareUpdate<&ObstacleSensor::Sample>(Every{step_}, Writes(line_), kTime, in);
  DeclareRole(BlindSpots{
      .spots =
          [poses = !params_.velocities](const std::string& own_name, bool /*one_robot*/) {
            return std::vector<std::string>{fmt::format("obstacles but as '{}' reports them{}",
                                                        own_name,
                                                        poses ? ", without velocities" : "")};
          },
      .behind = in});
  if (params_.velocities) return;
  DeclareRole(Remarks{.notes = [] {
    return std::vector<std::string>{
        "shows poses without velocities: who reads them without an ObstacleTracker takes what "
        "moves for what stands"};
  }});
}

Output<ObstacleSet> ObstacleSensor::DeclareObstacles() {
  if (steps_ > 0) {
    return DeclareOutput<ObstacleSet, &ObstacleSensor::CalcLate>("obstacles", {}, kTime, line_);
  }
  return DeclareOutput<ObstacleSet, &ObstacleSensor::CalcNow>("obstacles", {}, kTime, in, line_);
}

std::int64_t ObstacleSensor::TickOf(double time) const { return params_.period.CountAt(time); }

bool ObstacleSensor::Lost(std::int64_t tick) const {
  const double time = params_.period.seconds(tick);
  if (time >= params_.stale_from && time < params_.stale_until) return true;
  const std::uint64_t seed = static_cast<std::uint64_t>(params_.seed);
  models::Random random(models::Random::Seed(models::Random::Seed(seed, "dropout"),
                                             static_cast<std::uint64_t>(tick)));
  return random.Unit() < params_.dropout;
}

void ObstacleSensor::AddNoise(std::int64_t tick, ObstacleSet& set) const {
  if (params_.position_noise == 0.0 && params_.angle_noise == 0.0) return;
  const std::uint64_t seed = static_cast<std::uint64_t>(params_.seed);
  models::Random random(
      models::Random::Seed(models::Random::Seed(seed, "noise"), static_cast<std::uint64_t>(tick)));
  for (Obstacle& obstacle : set.obstacles) {
    obstacle.X_WO.translation() += params_.position_noise * DrawNormal(random);
    const Eigen::Vector3d turn = params_.angle_noise * DrawNormal(random);
    if (turn.isZero(0.0)) continue;
    obstacle.X_WO.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() *
                             obstacle.X_WO.linear();
  }
  set.layout = 0;  // nothing stands where it stood
}

/// Makes of the truth at a tick what is reported of it.
void ObstacleSensor::Report(std::int64_t tick, ObstacleSet& set) const {
  AddNoise(tick, set);
  set.stamp = step_.seconds(tick * every_ + steps_);
  if (params_.velocities) return;
  for (Obstacle& obstacle : set.obstacles) {
    obstacle.linear.setZero();
    obstacle.angular.setZero();
    obstacle.velocity_known = false;
  }
}

void ObstacleSensor::CalcLate(double time, const SensorLine& line, ObstacleSet& set) const {
  set = line.coming.stamp && time >= *line.coming.stamp ? line.coming : line.held;
}

void ObstacleSensor::CalcNow(double time, const ObstacleSet& truth, const SensorLine& line,
                             ObstacleSet& set) const {
  const std::int64_t tick = TickOf(time);
  const bool sampled = time == params_.period.seconds(tick) && !Lost(tick);
  set = sampled ? truth : line.held;
  if (sampled) Report(tick, set);
}

void ObstacleSensor::Sample(double time, const ObstacleSet& truth, SensorLine& line) const {
  if (steps_ == 0) {
    const std::int64_t tick = TickOf(time);
    if (Lost(tick)) return;
    line.held = truth;
    Report(tick, line.held);
    return;
  }
  if (line.ring.empty()) {
    line.ring.resize(static_cast<std::size_t>(steps_));
    for (ObstacleSet& set : line.ring) set.obstacles.reserve(truth.obstacles.capacity());
    line.held.obstacles.reserve(truth.obstacles.capacity());
    line.coming.obstacles.reserve(truth.obstacles.capacity());
  }
  const std::int64_t step = step_.CountAt(time);
  if (step % every_ == 0) line.ring[static_cast<std::size_t>(line.next)] = truth;
  line.next = (line.next + 1) % steps_;
  // What is now the oldest comes in at the next step.
  const std::int64_t oldest = step - steps_ + 1;
  if (oldest < 0 || oldest % every_ != 0 || Lost(oldest / every_)) return;
  line.held = line.coming;
  line.coming = line.ring[static_cast<std::size_t>(line.next)];
  Report(oldest / every_, line.coming);
}

}  // namespace oca::systems

namespace oca {

Fault Signal<systems::SensorLine>::Check(const systems::SensorLine& line, Look look) {
  const Fault fault = Signal<systems::ObstacleSet>::Check(line.held, look);
  return fault.ok() ? Signal<systems::ObstacleSet>::Check(line.coming, look) : fault;
}

}  // namespace oca
