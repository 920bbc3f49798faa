// SPDX-License-Identifier: BSD-3-Clause
#include "framework/simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "framework/error.h"
#include "framework/log.h"
#include "framework/plan.h"

namespace oca {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Ticks of the common clock up to which a double divided by a double is the nearest time.
constexpr std::int64_t kMostTicks = std::int64_t{1} << 53;

}  // namespace

/// All periods and offsets as whole ticks of one clock, whose rate is their least common multiple.
class Simulator::Clock {
 public:
  struct Beat {
    std::int64_t offset;
    std::int64_t period;
  };

  void Add(const Every& every) {
    everies_.push_back(every);
    for (const std::int64_t denominator :
         {every.period.denominator(), every.offset.denominator()}) {
      const std::int64_t factor = denominator / std::gcd(rate_, denominator);
      if (rate_ > kMostTicks / (factor * 100000)) {
        throw ConfigError(fmt::format(
            "simulator: the period {} shares no clock with the others; expected periods with "
            "small common multiples",
            every.period.ToString()));
      }
      rate_ *= factor;
    }
    beats_.clear();
    for (const Every& each : everies_) beats_.push_back({Ticks(each.offset), Ticks(each.period)});
  }
  double Time(std::size_t beat, std::int64_t count) const {
    return static_cast<double>(beats_[beat].offset + count * beats_[beat].period) /
           static_cast<double>(rate_);
  }
  /// The first count whose time is not before `time`.
  std::int64_t FirstCount(std::size_t beat, double time) const {
    auto count = static_cast<std::int64_t>(
        std::floor((time * static_cast<double>(rate_) - static_cast<double>(beats_[beat].offset)) /
                   static_cast<double>(beats_[beat].period)));
    count = std::max<std::int64_t>(count - 1, 0);
    while (Time(beat, count) < time) ++count;
    return count;
  }

 private:
  std::int64_t Ticks(const Period& period) const {
    return period.numerator() * (rate_ / period.denominator());
  }

  std::int64_t rate_{1};  // ticks a second
  std::vector<Every> everies_;
  std::vector<Beat> beats_;
};

Simulator::Simulator(const Diagram& diagram, const IntegratorOptions& options)
    : Simulator(diagram, diagram.MakeContext(), options) {}

Simulator::Simulator(const Diagram& diagram, Context context, const IntegratorOptions& options)
    : diagram_(diagram), context_(std::move(context)), clock_(std::make_unique<Clock>()) {
  const Plan& plan = diagram_.plan();
  for (const Plan::Group& group : plan.groups) clock_->Add(group.every);
  integrator_ = MakeIntegrator(plan, options);
  due_.reserve(plan.events.size());
  saved_state_.resize(plan.continuous_size);
}

Simulator::~Simulator() = default;

void Simulator::AddPublish(const Period& period, Publish publish) {
  if (!period.positive()) {
    throw ConfigError(fmt::format("publish: period; got {}; expected > 0 s", period.ToString()));
  }
  clock_->Add({period, {}});
  publishes_.push_back({0, std::move(publish)});
}

void Simulator::AddMonitor(Monitor monitor) { monitors_.push_back(std::move(monitor)); }

void Simulator::SetLog(Log* log) {
  static Log silent;
  context_.header().log = log == nullptr ? &silent : log;
}

void Simulator::Initialize() {
  const Plan& plan = diagram_.plan();
  const double start = context_.time();
  const bool resumed = context_.header().initialized != 0;
  initialized_ = true;
  for (std::size_t i = 0; i < publishes_.size(); ++i) {
    publishes_[i].count = clock_->FirstCount(plan.groups.size() + i, start);
    if (resumed && clock_->Time(plan.groups.size() + i, publishes_[i].count) == start) {
      ++publishes_[i].count;
    }
  }
  if (resumed) return;
  for (std::size_t i = 0; i < plan.groups.size(); ++i) {
    plan.group_counts(context_)[i] = clock_->FirstCount(i, start);
  }
  for (const int event : plan.initializations) plan.RunEvent(context_, plan.events[event]);
  for (const int event : plan.initializations) plan.Commit(context_, plan.events[event]);
  context_.header().initialized = 1;
  RunPublishes();
}

bool Simulator::AdvanceTo(double time) {
  if (!initialized_) Initialize();
  if (!std::isfinite(time) || time < context_.time()) {
    throw ConfigError(fmt::format("simulator: time to advance to; got {}; expected at least {}",
                                  time, context_.time()));
  }
  // Fixed inputs and states may have been set since the last call.
  restart_ = jumped_ = true;
  while (context_.time() < time) {
    RunStage(System::Stage::kReset);
    RunStage(System::Stage::kUpdate);
    Integrate(std::min(NextEventTime(), time));
    RunPublishes();
    ++statistics_.steps;
    statistics_.integrator = integrator_->statistics();
    bool go_on = true;
    for (const Monitor& monitor : monitors_) go_on &= monitor(context_);
    if (!go_on) return false;
  }
  return true;
}

void Simulator::RunStage(System::Stage stage) {
  const Plan& plan = diagram_.plan();
  std::int64_t* const counts = plan.group_counts(context_);
  const double now = context_.time();
  due_.clear();
  for (std::size_t i = 0; i < plan.groups.size(); ++i) {
    const Plan::Group& group = plan.groups[i];
    if (group.stage != stage || clock_->Time(i, counts[i]) > now) continue;
    due_.insert(due_.end(), group.events.begin(), group.events.end());
  }
  if (due_.empty()) return;
  for (const int event : due_) plan.RunEvent(context_, plan.events[event]);
  for (const int event : due_) {
    const Plan::Change change = plan.Commit(context_, plan.events[event]);
    restart_ |= change != Plan::Change::kNone;
    jumped_ |= change == Plan::Change::kState;
  }
  // Only now, so that a stage that failed is still due.
  for (std::size_t i = 0; i < plan.groups.size(); ++i) {
    if (plan.groups[i].stage == stage && clock_->Time(i, counts[i]) <= now) ++counts[i];
  }
  statistics_.updates += static_cast<std::int64_t>(due_.size());
}

void Simulator::RunPublishes() {
  const Plan& plan = diagram_.plan();
  std::int64_t* const counts = plan.group_counts(context_);
  const double now = context_.time();
  for (std::size_t i = 0; i < plan.groups.size(); ++i) {
    const Plan::Group& group = plan.groups[i];
    if (group.stage != System::Stage::kPublish || clock_->Time(i, counts[i]) > now) continue;
    for (const int event : group.events) plan.RunEvent(context_, plan.events[event]);
    ++counts[i];
    statistics_.publishes += static_cast<std::int64_t>(group.events.size());
  }
  for (std::size_t i = 0; i < publishes_.size(); ++i) {
    OwnPublish& own = publishes_[i];
    if (clock_->Time(plan.groups.size() + i, own.count) > now) continue;
    own.publish(context_);
    ++own.count;
    ++statistics_.publishes;
  }
}

double Simulator::NextEventTime() const {
  const Plan& plan = diagram_.plan();
  const std::int64_t* const counts = plan.group_counts(context_);
  double next = kInfinity;
  for (std::size_t i = 0; i < plan.groups.size(); ++i) {
    next = std::min(next, clock_->Time(i, counts[i]));
  }
  for (std::size_t i = 0; i < publishes_.size(); ++i) {
    next = std::min(next, clock_->Time(plan.groups.size() + i, publishes_[i].count));
  }
  return next;
}

void Simulator::Integrate(double to) {
  const double from = context_.time();
  // A step so small is the rounding of an event's time, not motion; integrators refuse it.
  const double smallest = 4.0 * (std::nextafter(std::fabs(from), kInfinity) - std::fabs(from));
  if (saved_state_.size() == 0 || to - from < smallest) return context_.SetTime(to);
  if (restart_) {
    integrator_->Restart(context_, jumped_);
    restart_ = jumped_ = false;
  }
  saved_state_ = context_.continuous_state();
  try {
    integrator_->IntegrateTo(context_, to);
  } catch (...) {
    context_.SetTime(from);
    context_.SetContinuousState(saved_state_);
    throw;
  }
}

}  // namespace oca
