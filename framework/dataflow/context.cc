// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/context.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <utility>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/log.h"
#include "oca/framework/dataflow/schedule.h"

namespace oca {
namespace {

constexpr std::align_val_t kAlignment{64};

}  // namespace

void Context::FreeArena::operator()(std::byte* arena) const { operator delete(arena, kAlignment); }

Context::Context(const Schedule* schedule)
    : schedule_(schedule),
      arena_(static_cast<std::byte*>(operator new(schedule->arena_size, kAlignment))) {
  std::memset(arena_.get(), 0, schedule->arena_size);
  header().log = &SilentLog();
  header().epoch = 1;
  schedule->versions(*this)[Schedule::kTimeSource] = 1;
  schedule->versions(*this)[Schedule::kContinuousSource] = 1;
  for (const Schedule::Object& object : schedule->objects)
    object.type->construct(arena_.get() + object.offset);
  for (const Schedule::StateEntry& state : schedule->states) {
    std::byte* const at = arena_.get() + state.slot.offset;
    if (state.type == &kVectorType) {
      for (std::uint32_t i = 0; i < state.slot.size; ++i) {
        reinterpret_cast<double*>(at)[i] = state.info->initial[i];
      }
    } else {
      state.info->initial_value(at);
      state.type->assign(arena_.get() + state.next.offset, at);
    }
    schedule->versions(*this)[state.source] = 1;
  }
  // An exported input that nobody fixes must not pass as zero.
  for (const Schedule::InputEntry& input : schedule->exported_inputs) {
    auto* values = reinterpret_cast<double*>(arena_.get() + input.slot.offset);
    std::fill_n(values, input.slot.size, std::numeric_limits<double>::quiet_NaN());
  }
}

Context::Context(const Context& other)
    : schedule_(other.schedule_),
      arena_(static_cast<std::byte*>(operator new(other.schedule_->arena_size, kAlignment))) {
  std::memcpy(arena_.get(), other.arena_.get(), schedule_->plain_size);
  header().profile = nullptr;
  for (const Schedule::Object& object : schedule_->objects) {
    object.type->construct(arena_.get() + object.offset);
    object.type->assign(arena_.get() + object.offset, other.arena_.get() + object.offset);
  }
}

Context::Context(Context&& other) noexcept
    : schedule_(other.schedule_), arena_(std::move(other.arena_)) {}

Context& Context::operator=(const Context& other) {
  if (this == &other) return *this;
  if (schedule_ != other.schedule_ || !arena_) return *this = Context(other);
  Profile* const profile = header().profile;
  std::memcpy(arena_.get(), other.arena_.get(), schedule_->plain_size);
  header().profile = profile;
  for (const Schedule::Object& object : schedule_->objects) {
    object.type->assign(arena_.get() + object.offset, other.arena_.get() + object.offset);
  }
  return *this;
}

Context& Context::operator=(Context&& other) noexcept {
  if (this != &other) {
    DestroyObjects();
    schedule_ = other.schedule_;
    arena_ = std::move(other.arena_);
  }
  return *this;
}

Context::~Context() { DestroyObjects(); }

void Context::DestroyObjects() {
  if (!arena_) return;
  for (const Schedule::Object& object : schedule_->objects)
    object.type->destroy(arena_.get() + object.offset);
}

void Context::SetTime(double time) {
  if (!std::isfinite(time)) {
    throw ConfigError(fmt::format("context: time; got {}; expected a finite number", time));
  }
  if (time == header().time) return;
  header().time = time;
  schedule_->MarkChanged(*this, Schedule::kTimeSource);
}

VectorView Context::continuous_state() const {
  return {schedule_->continuous(*this), schedule_->continuous_size};
}

void Context::SetContinuousState(const Eigen::Ref<const Eigen::VectorXd>& state) {
  if (state.size() != schedule_->continuous_size || !state.allFinite()) {
    throw ConfigError(fmt::format(
        "context: continuous state; got {} numbers{}; expected {} finite numbers", state.size(),
        state.allFinite() ? "" : ", not all finite", schedule_->continuous_size));
  }
  MutableVectorView(schedule_->continuous(*this), schedule_->continuous_size) = state;
  schedule_->MarkChanged(*this, Schedule::kContinuousSource);
}

}  // namespace oca
