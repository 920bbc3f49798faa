// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/dataflow/control_loop.h"

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <numeric>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/log.h"
#include "oca/framework/dataflow/schedule.h"

namespace oca {
namespace {

/// How many times `period` goes into `span`; throws ConfigError unless that is a whole number.
std::int64_t Ratio(const Period& span, const Period& period, const std::string& system) {
  const std::int64_t over = std::gcd(span.numerator(), period.numerator());
  const std::int64_t under = std::gcd(span.denominator(), period.denominator());
  const std::int64_t whole = span.numerator() / over;
  const std::int64_t factor = period.denominator() / under;
  const bool divides = span.denominator() == under && period.numerator() == over;
  constexpr std::int64_t kMost = std::numeric_limits<std::int32_t>::max();
  if (!divides || std::abs(whole) > kMost || factor > kMost || std::abs(whole) * factor > kMost) {
    throw ConfigError(
        fmt::format("control loop: {}: events; got them every {}; expected whole multiples of {}",
                    system, span.ToString(), period.ToString()));
  }
  return whole * factor;
}

}  // namespace

ControlLoop::ControlLoop(const Diagram& diagram, const Period& period)
    : schedule_(diagram.schedule()), context_(diagram.MakeContext()), period_(period) {
  if (!period.positive()) {
    throw ConfigError(
        fmt::format("control loop: period; got {}; expected > 0 s", period.ToString()));
  }
  for (const Schedule::Derivative& derivative : schedule_.derivatives) {
    throw ConfigError(
        fmt::format("control loop: {}.{}; got a continuous state; expected discrete ones only, "
                    "a Simulator integrates",
                    schedule_.PathOf(*derivative.system), derivative.state));
  }
  for (const Schedule::Witness& witness : schedule_.witnesses) {
    throw ConfigError(
        fmt::format("control loop: {}.{}; got a witness function; expected none, a Simulator "
                    "locates crossings",
                    schedule_.PathOf(*witness.system), witness.name));
  }
  for (std::size_t i = 0; i < schedule_.groups.size(); ++i) {
    const Schedule::Group& group = schedule_.groups[i];
    const std::string system = schedule_.PathOf(*schedule_.events[group.events.front()].system);
    const std::int64_t offset = Ratio(group.every.offset, period, system);
    const std::int64_t multiple = Ratio(group.every.period, period, system);
    beats_.push_back({offset, multiple});
    schedule_.group_counts(context_)[i] = beats_[i].FirstCount(0);
  }
  due_.reserve(schedule_.events.size());
}

void ControlLoop::Watch(const OutputHandle& output) {
  Schedule::Of(output, context_);
  const int node = schedule_.output(output).node;
  if (node >= 0) watched_.push_back(node);
}

void ControlLoop::SetLog(Log* log) { context_.header().log = log == nullptr ? &SilentLog() : log; }

void ControlLoop::Initialize() {
  if (initialized_) throw ConfigError("control loop: Initialize; got it twice; expected it once");
  schedule_.CheckInputsFixed(context_);
  for (const int event : schedule_.initializations)
    schedule_.RunEvent(context_, schedule_.events[event]);
  for (const int event : schedule_.initializations)
    schedule_.Commit(context_, schedule_.events[event]);
  schedule_.CheckStart(context_, true);
  schedule_.TakeCapacity(context_);
  for (const Schedule::Event& event : schedule_.events) {
    if (event.stage != System::Stage::kPublish) continue;
    schedule_.PullRange(context_, event.pull_begin, event.pull_end);
  }
  ComputeWatched();
  context_.header().initialized = 1;
  initialized_ = true;
}

Status ControlLoop::Refuse(const InputHandle& input, std::string_view what) const noexcept {
  std::array<char, 256> text;
  if (!schedule_.Imports(input)) {
    if (input.system == nullptr) {
      return Status::Failure("", "", time(),
                             "control loop: input; got a handle that was made by default; expected "
                             "an input that the diagram exports");
    }
    const auto& ports = input.system->inputs();
    const bool known = input.index >= 0 && input.index < std::ssize(ports);
    const std::string_view own = known ? ports[input.index].name : std::string_view("?");
    const auto end = fmt::format_to_n(text.data(), text.size(),
                                      "control loop: input '{}'; got one that the diagram does not "
                                      "export; expected one that it does",
                                      own);
    return Status::Failure("", own, time(), {text.data(), std::min(end.size, text.size())});
  }
  const std::string& name = input.system->inputs()[input.index].name;
  const auto end =
      fmt::format_to_n(text.data(), text.size(), "input {} at t = {} s: {}", name, time(), what);
  return Status::Failure("", name, time(), {text.data(), std::min(end.size, text.size())});
}

Status ControlLoop::Set(const Input<Vector>& input,
                        const Eigen::Ref<const Eigen::VectorXd>& value) noexcept {
  if (!schedule_.Imports(input)) return Refuse(input, "");
  const Schedule::InputEntry& entry = schedule_.input(input);
  const internal::Storage at{schedule_.arena(context_), entry.slot, entry.plausible};
  if (const Fault fault = internal::CheckVector(value.data(), value.size(), at); !fault.ok()) {
    return Refuse(input, fault.text());
  }
  ViewOf<Vector>::Write(at.arena, at.slot) = value;
  schedule_.MarkChanged(context_, entry.source);
  return {};
}

Status ControlLoop::Tick() noexcept {
  if (!initialized_) {
    return Status::Failure("", "", time(), "control loop: Tick; got it before Initialize");
  }
  const double now = static_cast<double>(ticks_ * period_.numerator()) /
                     static_cast<double>(period_.denominator());
  try {
    context_.SetTime(now);
    RunPublishes();
    RunStage(System::Stage::kReset);
    RunStage(System::Stage::kUpdate);
    ComputeWatched();
    ++ticks_;
    return {};
  } catch (...) {
    ++ticks_;
    return Status::OfCurrentException(now);
  }
}

std::int64_t ControlLoop::Beat::FirstCount(std::int64_t tick) const {
  return tick <= offset ? 0 : (tick - offset + multiple - 1) / multiple;
}

bool ControlLoop::Due(std::size_t group) const {
  const Beat& beat = beats_[group];
  return beat.offset + schedule_.group_counts(context_)[group] * beat.multiple <= ticks_;
}

void ControlLoop::RunPublishes() {
  for (std::size_t i = 0; i < beats_.size(); ++i) {
    const Schedule::Group& group = schedule_.groups[i];
    if (group.stage != System::Stage::kPublish || !Due(i)) continue;
    for (const int event : group.events) schedule_.RunEvent(context_, schedule_.events[event]);
    schedule_.group_counts(context_)[i] = beats_[i].FirstCount(ticks_ + 1);
  }
}

void ControlLoop::RunStage(System::Stage stage) {
  due_.clear();
  for (std::size_t i = 0; i < beats_.size(); ++i) {
    const Schedule::Group& group = schedule_.groups[i];
    if (group.stage != stage || !Due(i)) continue;
    due_.insert(due_.end(), group.events.begin(), group.events.end());
  }
  for (const int event : due_) schedule_.RunEvent(context_, schedule_.events[event]);
  for (const int event : due_) schedule_.Commit(context_, schedule_.events[event]);
  // Only now, so that a stage that failed is still due.
  for (std::size_t i = 0; i < beats_.size(); ++i) {
    if (schedule_.groups[i].stage != stage || !Due(i)) continue;
    schedule_.group_counts(context_)[i] = beats_[i].FirstCount(ticks_ + 1);
  }
}

void ControlLoop::ComputeWatched() {
  for (const int node : watched_) schedule_.Evaluate(context_, node);
}

internal::Storage ControlLoop::Locate(const OutputHandle& output) const noexcept {
  return {schedule_.arena(context_), schedule_.output(output).slot, {}};
}

}  // namespace oca
