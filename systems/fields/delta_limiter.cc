// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/delta_limiter.h"

#include <cmath>

#include "oca/systems/signals/roles.h"

namespace oca::systems {
void DeltaLimiter::Params::Describe(Fields<Params>& fields) {
  fields
      .Add("max_joint_velocity", &Params::max_joint_velocity, "rad/s",
           "largest rate of the delta, one number or one a joint")
      .Above(0.0);
  fields.Add("period", &Params::period, "s", "time between updates").Above(0.0).Required();
  fields.Add("enabled", &Params::enabled, "", "false: the delta is held, but not limited");
  fields.Add("mode", &Params::mode, "", "each joint alone, or the whole change by one factor");
}

DeltaLimiter::DeltaLimiter(const Params& params)
    : params_(Validated(params)),
      size_(DeclareSize({{"max_joint_velocity", &params_.max_joint_velocity}})),
      unit_(DeclareUnit()),
      x_(DeclareDiscreteState("x", {size_, unit_}, 0.0)),
      delta(DeclareInput<Vector>("delta", {size_, unit_})),
      limited_delta(DeclareStateOutput("limited_delta", x_)) {
  DeclareUpdate<&DeltaLimiter::Update>(Every{params_.period}, Writes(x_), delta, x_);
  DeclareRole(CarriesDelta{.in = delta, .out = limited_delta});
  if (!params_.enabled) return;
  const Eigen::VectorXd& bound = params_.max_joint_velocity.values();
  DeclareRole(Limits{.shown = Limits::Shown::kRate,
                     .signal = limited_delta,
                     .bound = {bound.begin(), bound.end()},
                     .period = params_.period});
}

void DeltaLimiter::Shrink(VectorView delta_value, VectorView x, MutableVectorView next) const {
  double factor = 1.0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double step = params_.max_joint_velocity[i] * params_.period.seconds();
    const double change = std::fabs(delta_value[i] - x[i]);
    if (change * factor > step) factor = step / change;
  }
  if (factor == 1.0) {
    next = delta_value;
  } else {
    next = x + factor * (delta_value - x);
  }
}

void DeltaLimiter::Update(VectorView delta_value, VectorView x, MutableVectorView next) const {
  if (!params_.enabled) {
    next = delta_value;
    return;
  }
  if (params_.mode == Mode::kDirection) return Shrink(delta_value, x, next);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double step = params_.max_joint_velocity[i] * params_.period.seconds();
    const double change = delta_value[i] - x[i];
    // Within reach it becomes the delta itself, not x + (delta - x), which may round.
    next[i] = std::fabs(change) <= step ? delta_value[i] : x[i] + std::copysign(step, change);
  }
}

}  // namespace oca::systems
