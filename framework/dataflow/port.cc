// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/port.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/fixed_text.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/framework/dataflow/schedule.h"

namespace oca {
namespace internal {

Storage Find(const OutputHandle& output, const Context& context) {
  const Schedule& schedule = Schedule::Of(output, context);
  const Schedule::OutputEntry& entry = schedule.output(output);
  if (entry.node >= 0) schedule.Evaluate(context, entry.node);
  return {schedule.arena(context), entry.slot, {}};
}

Storage Find(const CachedHandle& cached, const Context& context) {
  const Schedule& schedule = Schedule::Of(cached, context);
  const int node = schedule.cached(cached);
  schedule.Evaluate(context, node);
  return {schedule.arena(context), schedule.nodes[node].out, {}};
}

Storage Find(const StateHandle& state, const Context& context) {
  const Schedule& schedule = Schedule::Of(state, context);
  return {schedule.arena(context), schedule.state(state).slot, {}};
}

Storage FindExported(const InputHandle& input, const Context& context) {
  const Schedule& schedule = Schedule::Of(input, context);
  const Schedule::InputEntry& entry = schedule.input(input);
  if (entry.source < 0) {
    throw WiringError(fmt::format("{}.{}: only an input that the root diagram exports can be fixed",
                                  schedule.PathOf(*input.system),
                                  input.system->inputs()[input.index].name));
  }
  return {schedule.arena(context), entry.slot, entry.plausible};
}

void MarkChanged(const InputHandle& input, Context& context) {
  const Schedule& schedule = Schedule::Of(input, context);
  schedule.MarkChanged(context, schedule.input(input).source);
}

void MarkChanged(const StateHandle& state, Context& context) {
  const Schedule& schedule = Schedule::Of(state, context);
  schedule.MarkChanged(context, schedule.state(state).source);
}

Fault CheckVector(const double* values, Eigen::Index size, const Storage& at) {
  if (size != static_cast<Eigen::Index>(at.slot.size)) {
    return FaultOf("got {} numbers; expected {}", size, at.slot.size);
  }
  if (!AllFinite(values, at.slot.size)) return Fault::UnlessFinite(false);
  for (const Plausible* const plausible : at.plausible) {
    if (const Fault fault = plausible->Check(values); !fault.ok()) return fault;
  }
  return {};
}

void RequireValid(const char* type, const Fault& fault) {
  if (!fault.ok()) throw ConfigError(fmt::format("{}: {}", type, fault.text()));
}

}  // namespace internal

Unit::Unit(std::string text) : base_(std::move(text)) {
  for (const auto& [ending, rates] : {std::pair("/s", 1), {"/s^2", 2}, {"/s^3", 3}}) {
    const std::size_t length = std::string_view(ending).size();
    if (base_.size() <= length || !base_.ends_with(ending)) continue;
    base_.resize(base_.size() - length);
    rates_ = rates;
    return;
  }
}

std::string Unit::ToString() const {
  if (any()) return "";
  std::string base = variable_ >= 0 ? "u" : base_;
  if (rates_ == 0) return base;
  const std::string power = std::abs(rates_) == 1 ? "s" : fmt::format("s^{}", std::abs(rates_));
  return rates_ > 0 ? base + "/" + power : base + " " + power;
}

Fault Plausible::Check(const double* values) const {
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    if (values[i] >= lower[i] && values[i] <= upper[i]) continue;
    return FaultOf("{}; got {:.6g}; expected {:.6g} to {:.6g}, {}",
                   names[static_cast<std::size_t>(i)], values[i], lower[i], upper[i], rule);
  }
  return {};
}

VectorView ContinuousState::Get(const Context& context) const {
  const internal::Storage at = internal::Find(*this, context);
  return ViewOf<Vector>::Read(at.arena, at.slot);
}

void ContinuousState::Set(Context& context, const Eigen::Ref<const Eigen::VectorXd>& value) const {
  const internal::Storage at = internal::Find(*this, context);
  internal::RequireValid("vector", internal::CheckVector(value.data(), value.size(), at));
  ViewOf<Vector>::Write(at.arena, at.slot) = value;
  internal::MarkChanged(*this, context);
}

}  // namespace oca
