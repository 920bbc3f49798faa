// SPDX-License-Identifier: BSD-3-Clause
#include "framework/port.h"

#include <fmt/format.h>

#include "framework/error.h"
#include "framework/plan.h"
#include "framework/port_access.h"

namespace oca {
namespace internal {

Location Find(const OutputHandle& output, const Context& context) {
  const Plan& plan = Plan::Of(output, context);
  const Plan::OutputEntry& entry = plan.output(output);
  if (entry.node >= 0) plan.Evaluate(context, entry.node);
  return {plan.arena(context), entry.slot};
}

Location Find(const StateHandle& state, const Context& context) {
  const Plan& plan = Plan::Of(state, context);
  return {plan.arena(context), plan.state(state).slot};
}

Location FindExported(const InputHandle& input, const Context& context) {
  const Plan& plan = Plan::Of(input, context);
  const Plan::InputEntry& entry = plan.input(input);
  if (entry.source < 0) {
    throw WiringError(
        {fmt::format("{}.{}: only an input that the root diagram exports can be fixed",
                     plan.PathOf(*input.system), input.system->inputs()[input.index].name)});
  }
  return {plan.arena(context), entry.slot};
}

void MarkChanged(const InputHandle& input, Context& context) {
  const Plan& plan = Plan::Of(input, context);
  plan.MarkChanged(context, plan.input(input).source);
}

void MarkChanged(const StateHandle& state, Context& context) {
  const Plan& plan = Plan::Of(state, context);
  plan.MarkChanged(context, plan.state(state).source);
}

void CheckVector(const double* values, Eigen::Index size, Slot slot) {
  if (size != static_cast<Eigen::Index>(slot.size)) {
    throw ConfigError(fmt::format("vector: got {} numbers; expected {}", size, slot.size));
  }
  if (!AllFinite(values, static_cast<std::size_t>(size))) {
    throw ConfigError("vector: got a NaN or an infinity; expected finite numbers");
  }
}

void ThrowNotFinite(const char* type) {
  throw ConfigError(fmt::format("{}: got a NaN or an infinity; expected finite numbers", type));
}

}  // namespace internal

VectorView ContinuousState::Get(const Context& context) const {
  const internal::Location at = internal::Find(*this, context);
  return ViewOf<Vector>::Read(at.arena, at.slot);
}

void ContinuousState::Set(Context& context, const Eigen::Ref<const Eigen::VectorXd>& value) const {
  const internal::Location at = internal::Find(*this, context);
  internal::CheckVector(value.data(), value.size(), at.slot);
  ViewOf<Vector>::Write(at.arena, at.slot) = value;
  internal::MarkChanged(*this, context);
}

}  // namespace oca
