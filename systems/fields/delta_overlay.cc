// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/delta_overlay.h"

#include "oca/systems/signals/roles.h"

namespace oca::systems {
void DeltaOverlay::Params::Describe(Fields<Params>& fields) {
  fields
      .Add("period", &Params::period, "s",
           "control period over which the delta's rate is taken; 0 leaves the rate out")
      .AtLeast(0.0);
  fields.Add("enabled", &Params::enabled, "", "false: the request passes unchanged");
}

DeltaOverlay::DeltaOverlay(const Params& params)
    : params_(Validated(params)),
      size_(DeclareSize()),
      unit_(DeclareUnit()),
      x_(DeclareDiscreteState("x", {size_, unit_}, 0.0)),
      request(DeclareInput<Vector>("request", {size_, unit_})),
      request_velocity(DeclareOptionalInput<Vector>("request_velocity", {size_, unit_.Rate()})),
      delta(DeclareInput<Vector>("delta", {size_, unit_})),
      position(DeclareOutput<Vector, &DeltaOverlay::CalcPosition>("position", {size_, unit_},
                                                                  request, delta)),
      velocity(DeclareOutput<Vector, &DeltaOverlay::CalcVelocity>("velocity", {size_, unit_.Rate()},
                                                                  request_velocity, delta, x_)),
      applied_delta(DeclareOutput<Vector, &DeltaOverlay::CalcApplied>("applied_delta",
                                                                      {size_, unit_}, delta)) {
  if (params_.enabled) {
    DeclareRole(PassesOn{.in = delta, .out = applied_delta});
    DeclareRole(AddsDelta{.delta = delta, .request = request, .period = params_.period});
  }
  if (!params_.period.positive()) return;
  DeclareUpdate<&DeltaOverlay::Update>(Every{params_.period}, Writes(x_), delta);
}

void DeltaOverlay::CalcPosition(VectorView request_value, VectorView delta_value,
                                MutableVectorView sum) const {
  sum = request_value;
  if (params_.enabled) sum += delta_value;
}

void DeltaOverlay::CalcVelocity(std::optional<VectorView> request_rate, VectorView delta_value,
                                VectorView x, MutableVectorView sum) const {
  if (request_rate) {
    sum = *request_rate;
  } else {
    sum.setZero();
  }
  if (params_.enabled && params_.period.positive()) {
    sum += (delta_value - x) / params_.period.seconds();
  }
}

void DeltaOverlay::CalcApplied(VectorView delta_value, MutableVectorView applied) const {
  if (params_.enabled) {
    applied = delta_value;
  } else {
    applied.setZero();
  }
}

void DeltaOverlay::Update(VectorView delta_value, MutableVectorView next) const {
  next = delta_value;
}

}  // namespace oca::systems
