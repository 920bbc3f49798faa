// SPDX-License-Identifier: BSD-3-Clause
#include "framework/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

#include "framework/error.h"
#include "framework/log.h"
#include "framework/plan.h"

namespace oca {
namespace {

constexpr std::align_val_t kAlignment{64};

}  // namespace

void Context::FreeArena::operator()(std::byte* arena) const { operator delete(arena, kAlignment); }

Context::Context(const Plan* plan)
    : plan_(plan), arena_(static_cast<std::byte*>(operator new(plan->arena_size, kAlignment))) {
  std::memset(arena_.get(), 0, plan->arena_size);
  header().log = &SilentLog();
  header().epoch = 1;
  plan->versions(*this)[Plan::kTimeSource] = 1;
  plan->versions(*this)[Plan::kContinuousSource] = 1;
  for (const Plan::Object& object : plan->objects)
    object.type->construct(arena_.get() + object.offset);
  for (const Plan::StateEntry& state : plan->states) {
    std::byte* const at = arena_.get() + state.slot.offset;
    if (state.type == &kVectorType) {
      for (std::uint32_t i = 0; i < state.slot.size; ++i) {
        reinterpret_cast<double*>(at)[i] = state.info->initial[i];
      }
    } else {
      state.info->initial_value(at);
      state.type->assign(arena_.get() + state.next.offset, at);
    }
    plan->versions(*this)[state.source] = 1;
  }
  // An exported input that nobody fixes must not pass as zero.
  for (const Plan::InputEntry& input : plan->exported_inputs) {
    auto* values = reinterpret_cast<double*>(arena_.get() + input.slot.offset);
    std::fill_n(values, input.slot.size, std::numeric_limits<double>::quiet_NaN());
  }
}

Context::Context(const Context& other)
    : plan_(other.plan_),
      arena_(static_cast<std::byte*>(operator new(other.plan_->arena_size, kAlignment))) {
  std::memcpy(arena_.get(), other.arena_.get(), plan_->plain_size);
  header().profile = nullptr;
  for (const Plan::Object& object : plan_->objects) {
    object.type->construct(arena_.get() + object.offset);
    object.type->assign(arena_.get() + object.offset, other.arena_.get() + object.offset);
  }
}

Context::Context(Context&& other) noexcept : plan_(other.plan_), arena_(std::move(other.arena_)) {}

Context& Context::operator=(const Context& other) {
  if (this == &other) return *this;
  if (plan_ != other.plan_ || !arena_) return *this = Context(other);
  Profile* const profile = header().profile;
  std::memcpy(arena_.get(), other.arena_.get(), plan_->plain_size);
  header().profile = profile;
  for (const Plan::Object& object : plan_->objects) {
    object.type->assign(arena_.get() + object.offset, other.arena_.get() + object.offset);
  }
  return *this;
}

Context& Context::operator=(Context&& other) noexcept {
  if (this != &other) {
    DestroyObjects();
    plan_ = other.plan_;
    arena_ = std::move(other.arena_);
  }
  return *this;
}

Context::~Context() { DestroyObjects(); }

void Context::DestroyObjects() {
  if (!arena_) return;
  for (const Plan::Object& object : plan_->objects)
    object.type->destroy(arena_.get() + object.offset);
}

void Context::SetTime(double time) {
  if (!std::isfinite(time)) {
    throw ConfigError(fmt::format("context: time; got {}; expected a finite number", time));
  }
  if (time == header().time) return;
  header().time = time;
  plan_->MarkChanged(*this, Plan::kTimeSource);
}

VectorView Context::continuous_state() const {
  return {plan_->continuous(*this), plan_->continuous_size};
}

void Context::SetContinuousState(const Eigen::Ref<const Eigen::VectorXd>& state) {
  if (state.size() != plan_->continuous_size || !state.allFinite()) {
    throw ConfigError(fmt::format(
        "context: continuous state; got {} numbers{}; expected {} finite numbers", state.size(),
        state.allFinite() ? "" : ", not all finite", plan_->continuous_size));
  }
  MutableVectorView(plan_->continuous(*this), plan_->continuous_size) = state;
  plan_->MarkChanged(*this, Plan::kContinuousSource);
}

}  // namespace oca
