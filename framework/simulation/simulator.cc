// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/log.h"
#include "oca/framework/dataflow/schedule.h"
#include "oca/framework/simulation/event_clock.h"
#include "oca/framework/simulation/witness_locator.h"

namespace oca {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Simulator::Simulator(const Diagram& diagram, const IntegratorOptions& options)
    : Simulator(diagram, diagram.MakeContext(), options) {}

Simulator::Simulator(const Diagram& diagram, Context context, const IntegratorOptions& options)
    : diagram_(diagram), context_(std::move(context)), clock_(std::make_unique<EventClock>()) {
  const Schedule& schedule = diagram_.schedule();
  CheckContext();
  for (const Schedule::Group& group : schedule.groups) clock_->Add(group.every);
  integrator_ = MakeIntegrationMethod(schedule, options);
  if (!schedule.witnesses.empty()) locator_ = std::make_unique<WitnessLocator>(schedule, options);
  due_.reserve(schedule.events.size());
  saved_state_.resize(schedule.continuous_size);
}

Simulator::~Simulator() = default;

void Simulator::AddPublish(const Period& period, Publish publish) {
  if (!period.positive()) {
    throw ConfigError(fmt::format("publish: period; got {}; expected > 0 s", period.ToString()));
  }
  if (initialized_) throw ConfigError("publish: got one after Initialize; expected it before");
  clock_->Add({period, {}});
  publishes_.push_back({0, std::move(publish)});
}

void Simulator::AddMonitor(Monitor monitor) { monitors_.push_back(std::move(monitor)); }

void Simulator::SetLog(Log* log) {
  log_ = log;
  ConnectLog();
}

void Simulator::SetRealtimeFactor(double factor, WallClock& clock) {
  pacer_.reset();
  if (factor != 0.0) pacer_ = std::make_unique<Pacer>(factor, clock);
}

void Simulator::EnableProfile() {
  profile_ = std::make_unique<Profile>(diagram_.schedule().systems.size());
}

std::vector<SystemTime> Simulator::profile() const {
  std::vector<SystemTime> times;
  if (!profile_) return times;
  for (std::size_t i = 0; i < profile_->entries().size(); ++i) {
    const Profile::Entry& entry = profile_->entries()[i];
    const auto seconds = [](std::chrono::steady_clock::duration time) {
      return std::chrono::duration<double>(time).count();
    };
    times.push_back(
        {diagram_.schedule().paths[i], entry.calls, seconds(entry.time), seconds(entry.slowest)});
    for (std::size_t place = 0; place < Profile::Entry::kClasses; ++place) {
      const std::uint32_t calls = entry.classes[place];
      if (calls > 0) times.back().times.emplace_back(Profile::Entry::TimeOf(place), calls);
    }
  }
  return times;
}

void Simulator::ConnectLog() { context_.header().log = log_ == nullptr ? &SilentLog() : log_; }

void Simulator::CheckContext() const {
  if (context_.schedule_ == &diagram_.schedule() && context_.arena_ != nullptr) return;
  throw WiringError("simulator: context; got one of another diagram; expected one of its own");
}

void Simulator::Initialize() {
  const Schedule& schedule = diagram_.schedule();
  CheckContext();
  ConnectLog();
  schedule.CheckInputsFixed(context_);
  initialized_ = true;
  const double start = context_.time();
  const bool resumed = context_.header().initialized != 0;
  for (std::size_t i = 0; i < publishes_.size(); ++i) {
    publishes_[i].count = clock_->FirstCount(schedule.groups.size() + i, start);
    if (resumed) SkipPublished(i);
  }
  if (resumed) return;
  for (std::size_t i = 0; i < schedule.groups.size(); ++i) {
    schedule.group_counts(context_)[i] = clock_->FirstCount(i, start);
  }
  for (const int event : schedule.initializations)
    schedule.RunEvent(context_, schedule.events[event]);
  for (const int event : schedule.initializations)
    schedule.Commit(context_, schedule.events[event]);
  schedule.CheckStart(context_, true);
  schedule.TakeCapacity(context_);
  context_.header().initialized = 1;
  RunPublishes();
}

void Simulator::SkipPublished(std::size_t i) {
  const std::size_t beat = diagram_.schedule().groups.size() + i;
  if (clock_->Time(beat, publishes_[i].count) == context_.time()) ++publishes_[i].count;
}

void Simulator::FollowTime() {
  const Schedule& schedule = diagram_.schedule();
  const double now = context_.time();
  for (std::size_t i = 0; i < schedule.groups.size(); ++i) {
    std::int64_t& count = schedule.group_counts(context_)[i];
    count = clock_->Follow(i, count, now);
  }
  for (std::size_t i = 0; i < publishes_.size(); ++i) {
    const std::int64_t followed =
        clock_->Follow(schedule.groups.size() + i, publishes_[i].count, now);
    if (followed == publishes_[i].count) continue;
    publishes_[i].count = followed;
    SkipPublished(i);
  }
}

bool Simulator::AdvanceTo(double time) {
  CheckContext();
  if (!std::isfinite(time) || time < context_.time()) {
    throw ConfigError(fmt::format("simulator: time to advance to; got {}; expected at least {}",
                                  time, context_.time()));
  }
  if (!initialized_ || context_.header().initialized == 0) {
    Initialize();
  } else {
    ConnectLog();
    diagram_.schedule().CheckInputsFixed(context_);
  }
  context_.header().profile = profile_.get();
  try {
    const bool went_on = AdvanceSteps(time);
    context_.header().profile = nullptr;
    return went_on;
  } catch (...) {
    context_.header().profile = nullptr;
    throw;
  }
}

Status Simulator::TryAdvanceTo(double time) noexcept {
  try {
    AdvanceTo(time);
    return {};
  } catch (...) {
    return Status::OfCurrentException(context_.time());
  }
}

bool Simulator::AdvanceSteps(double time) {
  FollowTime();
  if (pacer_) pacer_->Start(context_.time());
  RunPublishes();  // what failed at this instant is still due
  // Fixed inputs and states may have been set since the last call.
  restart_ = true;
  while (context_.time() < time) {
    RunStage(System::Stage::kReset);
    RunStage(System::Stage::kUpdate);
    Integrate(std::min(NextEventTime(), time));
    if (pacer_) Pace();
    RunPublishes();
    ++statistics_.steps;
    statistics_.integrator = integrator_->statistics();
    bool go_on = true;
    for (const Monitor& monitor : monitors_) go_on &= monitor(context_);
    if (!go_on) return false;
  }
  return true;
}

void Simulator::Pace() {
  pacer_->WaitFor(context_.time());
  statistics_.overruns = pacer_->overruns();
  statistics_.worst_overrun = pacer_->worst_overrun();
}

void Simulator::RunStage(System::Stage stage) {
  const Schedule& schedule = diagram_.schedule();
  std::int64_t* const counts = schedule.group_counts(context_);
  const double now = context_.time();
  due_.clear();
  for (std::size_t i = 0; i < schedule.groups.size(); ++i) {
    const Schedule::Group& group = schedule.groups[i];
    if (group.stage != stage || clock_->Time(i, counts[i]) > now) continue;
    due_.insert(due_.end(), group.events.begin(), group.events.end());
  }
  AddPending(stage);
  if (due_.empty()) return;
  for (const int event : due_) schedule.RunEvent(context_, schedule.events[event]);
  for (const int event : due_) {
    const Schedule::Change change = schedule.Commit(context_, schedule.events[event]);
    restart_ |= change != Schedule::Change::kNone;
    jumped_ |= change == Schedule::Change::kState;
  }
  // Only now, so that a stage that failed is still due.
  for (std::size_t i = 0; i < schedule.groups.size(); ++i) {
    if (schedule.groups[i].stage == stage && clock_->Time(i, counts[i]) <= now) ++counts[i];
  }
  ForgetPending(stage);
  statistics_.updates += static_cast<std::int64_t>(due_.size());
}

void Simulator::AddPending(System::Stage stage) {
  if (stage != System::Stage::kReset) return;
  const Schedule& schedule = diagram_.schedule();
  for (std::size_t i = 0; i < schedule.witnesses.size(); ++i) {
    if (schedule.witness_states(context_)[i].pending == 0) continue;
    const std::vector<int>& events = schedule.witnesses[i].events;
    due_.insert(due_.end(), events.begin(), events.end());
  }
}

void Simulator::ForgetPending(System::Stage stage) {
  if (stage != System::Stage::kReset) return;
  const Schedule& schedule = diagram_.schedule();
  for (std::size_t i = 0; i < schedule.witnesses.size(); ++i) {
    schedule.witness_states(context_)[i].pending = 0;
  }
}

void Simulator::RunPublishes() {
  const Schedule& schedule = diagram_.schedule();
  std::int64_t* const counts = schedule.group_counts(context_);
  const double now = context_.time();
  for (std::size_t i = 0; i < schedule.groups.size(); ++i) {
    const Schedule::Group& group = schedule.groups[i];
    if (group.stage != System::Stage::kPublish || clock_->Time(i, counts[i]) > now) continue;
    for (const int event : group.events) schedule.RunEvent(context_, schedule.events[event]);
    ++counts[i];
    statistics_.publishes += static_cast<std::int64_t>(group.events.size());
  }
  for (std::size_t i = 0; i < publishes_.size(); ++i) {
    OwnPublish& own = publishes_[i];
    if (clock_->Time(schedule.groups.size() + i, own.count) > now) continue;
    own.publish(context_);
    ++own.count;
    ++statistics_.publishes;
  }
}

double Simulator::NextEventTime() const {
  const Schedule& schedule = diagram_.schedule();
  const std::int64_t* const counts = schedule.group_counts(context_);
  double next = kInfinity;
  for (std::size_t i = 0; i < schedule.groups.size(); ++i) {
    next = std::min(next, clock_->Time(i, counts[i]));
  }
  for (std::size_t i = 0; i < publishes_.size(); ++i) {
    next = std::min(next, clock_->Time(schedule.groups.size() + i, publishes_[i].count));
  }
  return next;
}

void Simulator::Integrate(double to) {
  const Schedule& schedule = diagram_.schedule();
  const double from = context_.time();
  // A step so small is the rounding of an event's time, not motion; integrators refuse it.
  const double smallest = 4.0 * (std::nextafter(std::fabs(from), kInfinity) - std::fabs(from));
  const bool moves = saved_state_.size() > 0 && to - from >= smallest;
  if (!moves && !locator_) return context_.SetTime(to);
  if (restart_ && moves) {
    integrator_->Restart(context_, jumped_);
    restart_ = jumped_ = false;
  }
  saved_state_ = context_.continuous_state();
  try {
    if (!locator_) {
      integrator_->IntegrateTo(context_, to);
    } else if (locator_->Advance(context_, moves ? integrator_.get() : nullptr, to)) {
      restart_ = true;  // the integrator is past the crossing
      ++statistics_.crossings;
    }
  } catch (...) {
    statistics_.integrator = integrator_->statistics();  // what was spent in vain counts
    schedule.SetTimeAndState(context_, from, saved_state_.data());
    ForgetPending(System::Stage::kReset);
    restart_ = true;
    throw;
  }
}

}  // namespace oca
