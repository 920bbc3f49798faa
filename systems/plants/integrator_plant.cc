// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/plants/integrator_plant.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/require.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

const PerComponent& StartOf(const IntegratorPlant::Params& params) {
  return *params.initial_position.numbers();
}

IntegratorPlant::Params Resolved(IntegratorPlant::Params params, const ModelSet& models) {
  const auto model = RobotOfPostures(models, params.model);
  params.initial_position = NumbersOf(params.initial_position, model.get(), {}, "initial_position");
  return params;
}

IntegratorPlant::Params Checked(IntegratorPlant::Params params) {
  Validated(params);
  params.initial_position = NumbersOf(params.initial_position, nullptr, {}, "initial_position");
  if (params.order == 1 && !params.initial_velocity.values().isZero(0.0)) {
    throw ConfigError(
        "initial_velocity: order 1 has no velocity state; got a value; expected none, or order 2");
  }
  if (params.lower && params.upper) {
    RequireOrdered("lower", *params.lower, "upper", *params.upper);
  }
  if (params.lower) {
    RequireOrdered("lower", *params.lower, "initial_position", StartOf(params));
  }
  if (params.upper) {
    RequireOrdered("initial_position", StartOf(params), "upper", *params.upper);
  }
  return params;
}

/// A joint at its stop is beyond the last number before it.
Limits StopOf(const PerComponent& stop, Limits::Shown shown, const Output<Vector>& position) {
  const double inside = shown == Limits::Shown::kBelow ? kInfinity : -kInfinity;
  std::vector<double> bound;
  for (const double at : stop.values()) bound.push_back(std::nextafter(at, inside));
  return {.shown = shown, .signal = position, .bound = std::move(bound), .how = "at its stop"};
}

}  // namespace

void IntegratorPlant::Params::Describe(Fields<Params>& fields) {
  fields.Add("order", &Params::order, "", "1: the command is a velocity; 2: an acceleration")
      .AtLeast(1)
      .AtMost(2);
  fields.Add(
      "initial_position", &Params::initial_position, "rad",
      "position at the start: a number for all or one a joint; or the name of a state of the "
      "SRDF, or some joints by name, the others at 0");
  fields.Add("initial_velocity", &Params::initial_velocity, "rad/s",
             "velocity at the start, order 2 only");
  fields.Add("lower", &Params::lower, "rad", "lower stop; absent: none");
  fields.Add("upper", &Params::upper, "rad", "upper stop; absent: none");
  fields.Add("model", &Params::model, "",
             "robot whose states and joints initial_position may name; may be left out if there is "
             "but one");
  fields.Add("unit", &Params::unit, "", "unit of the position");
}

IntegratorPlant::IntegratorPlant(const Params& params, const ModelSet& models)
    : IntegratorPlant(Resolved(params, models)) {}

IntegratorPlant::IntegratorPlant(const Params& params)
    : params_(Checked(params)),
      lower_(params_.lower.value_or(-kInfinity)),
      upper_(params_.upper.value_or(kInfinity)),
      spec_{DeclareSize({{"initial_position", &StartOf(params_)},
                         {"initial_velocity", &params_.initial_velocity},
                         {"lower", &lower_},
                         {"upper", &upper_}}),
            Unit(params_.unit)},
      rate_spec_{spec_.size, spec_.unit.Rate()},
      position_(DeclareContinuousState("position", spec_, StartOf(params_))),
      velocity_(DeclareVelocity()),
      command(DeclareInput<Vector>(
          "command", {spec_.size, params_.order == 1 ? rate_spec_.unit : rate_spec_.unit.Rate()})),
      position(DeclareShownPosition()),
      velocity(DeclareShownVelocity()) {
  constexpr auto kFree = &IntegratorPlant::CalcFree;
  if (params_.order == 1) {
    DeclareDerivative<kFree>(position_, command, position_);
  } else {
    DeclareDerivative<kFree>(position_, velocity_, position_);
    DeclareDerivative<kFree>(velocity_, command, position_);
  }
  DeclareRole(Boundary{"the joints"});
  DeclareRole(Plant{.command = command, .position = position, .velocity = velocity});
  DeclareRole(Plots{.id = "speed", .title = "Joint speeds", .signal = velocity});
  if (params_.lower) DeclareRole(StopOf(*params_.lower, Limits::Shown::kBelow, position));
  if (params_.upper) DeclareRole(StopOf(*params_.upper, Limits::Shown::kAbove, position));
}

ContinuousState IntegratorPlant::DeclareVelocity() {
  if (params_.order == 1) return {};
  return DeclareContinuousState("velocity", rate_spec_, params_.initial_velocity);
}

Output<Vector> IntegratorPlant::DeclareShownPosition() {
  if (!limited()) return DeclareStateOutput("position", position_);
  return DeclareOutput<Vector, &IntegratorPlant::CalcShownPosition>("position", spec_, position_);
}

Output<Vector> IntegratorPlant::DeclareShownVelocity() {
  constexpr auto kFree = &IntegratorPlant::CalcFree;
  if (params_.order == 1) {
    return DeclareOutput<Vector, kFree>("velocity", rate_spec_, command, position_);
  }
  if (!limited()) return DeclareStateOutput("velocity", velocity_);
  return DeclareOutput<Vector, kFree>("velocity", rate_spec_, velocity_, position_);
}

void IntegratorPlant::CalcFree(VectorView push, VectorView q, MutableVectorView free) const {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const bool into_stop =
        (q[i] >= upper_[i] && push[i] > 0.0) || (q[i] <= lower_[i] && push[i] < 0.0);
    free[i] = into_stop ? 0.0 : push[i];
  }
}

void IntegratorPlant::CalcShownPosition(VectorView q, MutableVectorView shown) const {
  for (Eigen::Index i = 0; i < q.size(); ++i) shown[i] = std::clamp(q[i], lower_[i], upper_[i]);
}

}  // namespace oca::systems
