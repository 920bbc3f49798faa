// SPDX-License-Identifier: BSD-3-Clause
#include "framework/port.h"

#include <fmt/format.h>

#include "framework/error.h"
#include "framework/fixed_text.h"
#include "framework/plan.h"
#include "framework/port_access.h"

namespace oca {
namespace internal {

Location Find(const OutputHandle& output, const Context& context) {
  const Plan& plan = Plan::Of(output, context);
  const Plan::OutputEntry& entry = plan.output(output);
  if (entry.node >= 0) plan.Evaluate(context, entry.node);
  return {plan.arena(context), entry.slot, {}};
}

Location Find(const StateHandle& state, const Context& context) {
  const Plan& plan = Plan::Of(state, context);
  return {plan.arena(context), plan.state(state).slot, {}};
}

Location FindExported(const InputHandle& input, const Context& context) {
  const Plan& plan = Plan::Of(input, context);
  const Plan::InputEntry& entry = plan.input(input);
  if (entry.source < 0) {
    throw WiringError(
        {fmt::format("{}.{}: only an input that the root diagram exports can be fixed",
                     plan.PathOf(*input.system), input.system->inputs()[input.index].name)});
  }
  return {plan.arena(context), entry.slot, entry.plausible};
}

void MarkChanged(const InputHandle& input, Context& context) {
  const Plan& plan = Plan::Of(input, context);
  plan.MarkChanged(context, plan.input(input).source);
}

void MarkChanged(const StateHandle& state, Context& context) {
  const Plan& plan = Plan::Of(state, context);
  plan.MarkChanged(context, plan.state(state).source);
}

Fault CheckVector(const double* values, Eigen::Index size, const Location& at) {
  if (size != static_cast<Eigen::Index>(at.slot.size)) {
    return FaultOf("got {} numbers; expected {}", size, at.slot.size);
  }
  if (!AllFinite(values, at.slot.size)) return Fault::UnlessFinite(false);
  for (const Plausible* const plausible : at.plausible) {
    if (const Fault fault = plausible->Check(values); !fault.ok()) return fault;
  }
  return {};
}

void ThrowIf(const char* type, const Fault& fault) {
  if (!fault.ok()) throw ConfigError(fmt::format("{}: {}", type, fault.text()));
}

}  // namespace internal

Fault Plausible::Check(const double* values) const {
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    if (values[i] >= lower[i] && values[i] <= upper[i]) continue;
    return FaultOf("{}; got {:.6g}; expected {:.6g} to {:.6g}, {}",
                   names[static_cast<std::size_t>(i)], values[i], lower[i], upper[i], rule);
  }
  return {};
}

VectorView ContinuousState::Get(const Context& context) const {
  const internal::Location at = internal::Find(*this, context);
  return ViewOf<Vector>::Read(at.arena, at.slot);
}

void ContinuousState::Set(Context& context, const Eigen::Ref<const Eigen::VectorXd>& value) const {
  const internal::Location at = internal::Find(*this, context);
  internal::ThrowIf("vector", internal::CheckVector(value.data(), value.size(), at));
  ViewOf<Vector>::Write(at.arena, at.slot) = value;
  internal::MarkChanged(*this, context);
}

}  // namespace oca
