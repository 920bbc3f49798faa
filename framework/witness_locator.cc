// SPDX-License-Identifier: BSD-3-Clause
#include "framework/witness_locator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/error.h"

namespace oca {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Crossings no further apart than this are simultaneous; s, relative beyond 1 s.
constexpr double kSimultaneous = 1e-12;
/// Looks at each step, and the longest time between two, s.
constexpr int kLeastLooks = 4;
constexpr double kLongestBlink = 0.025;
/// How near the ends of a step its slope is felt, as a part of the time between two looks.
constexpr double kProbe = 1e-3;
/// A function that ends its bracket larger than this part of itself has jumped across zero.
constexpr double kJump = 1e-6;
/// So many crossings of one witness within so short a time, s (relative beyond 1 s), are Zeno's.
constexpr std::int64_t kZenoCount = 16;
constexpr double kZenoWindow = 1e-8;

double Resolution(double t) { return kSimultaneous * std::max(1.0, std::fabs(t)); }

double ZenoWindow(double t) { return kZenoWindow * std::max(1.0, std::fabs(t)); }

bool SameSign(double a, double b) { return (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0); }

}  // namespace

WitnessLocator::WitnessLocator(const Plan& plan, const IntegratorOptions& options)
    : plan_(plan),
      max_steps_(options.max_steps),
      end_state_(plan.continuous_size),
      at_(plan.continuous_size),
      start_value_(plan.witnesses.size()),
      start_rest_(plan.witnesses.size()),
      end_value_(plan.witnesses.size()),
      scale_(plan.witnesses.size()),
      crossing_(plan.witnesses.size()) {}

bool WitnessLocator::Advance(Context& context, Integrator* integrator, double to) {
  integrator_ = integrator;
  Start(context);
  try {
    for (int steps = 0; context.time() < to; ++steps) {
      CheckSteps(context, steps);
      begin_ = context.time();
      if (integrator_ != nullptr) {
        integrator_->Step(context, to);
      } else {
        context.SetTime(to);
      }
      if (FindCrossings(context, to)) return true;
    }
  } catch (...) {
    for (std::size_t i = 0; i < start_rest_.size(); ++i) {
      plan_.witness_states(context)[i].rest = start_rest_[i];
    }
    throw;
  }
  return false;
}

void WitnessLocator::CheckSteps(const Context& context, int steps) const {
  if (steps < max_steps_) return;
  throw SimulationError("simulator", "", context.time(),
                        fmt::format("got {} steps since the last event; expected no more "
                                    "(max_steps)",
                                    steps));
}

void WitnessLocator::Start(Context& context) {
  for (std::size_t i = 0; i < start_value_.size(); ++i) {
    double& rest = plan_.witness_states(context)[i].rest;
    const double value = plan_.EvaluateWitness(context, static_cast<int>(i));
    const bool resting = std::fabs(value) <= rest;
    start_value_[i] = resting ? 0.0 : value;
    if (!resting) rest = 0.0;
    start_rest_[i] = rest;
  }
}

bool WitnessLocator::FindCrossings(Context& context, double to) {
  end_ = context.time();
  std::copy_n(plan_.continuous(context), end_state_.size(), end_state_.data());
  double earliest = kNever;
  for (std::size_t i = 0; i < crossing_.size(); ++i) {
    crossing_[i] = FirstCrossing(context, static_cast<int>(i));
    earliest = std::min(earliest, crossing_[i]);
  }
  const double resolution = Resolution(end_);
  // What will cross right after the step belongs to it only if an event is there anyway.
  if (earliest == kNever || (earliest > end_ && end_ < to)) {
    MoveTo(context, end_);
    LeaveRest(context);
    return false;
  }
  double at = earliest;  // the last of the simultaneous ones, so that all have crossed
  for (const double crossing : crossing_) {
    if (crossing <= earliest + resolution) at = std::max(at, crossing);
  }
  if (at >= end_ - resolution) at = end_;
  MoveTo(context, at);
  const double last = at == end_ ? end_ + resolution : at;
  for (std::size_t i = 0; i < crossing_.size(); ++i) {
    if (crossing_[i] <= last) CheckZeno(context, static_cast<int>(i));
  }
  for (std::size_t i = 0; i < crossing_.size(); ++i) {
    if (crossing_[i] <= last) Trigger(context, static_cast<int>(i));
  }
  return true;
}

void WitnessLocator::LeaveRest(Context& context) {
  for (std::size_t i = 0; i < start_value_.size(); ++i) {
    start_value_[i] = end_value_[i];
    if (end_value_[i] != 0.0) plan_.witness_states(context)[i].rest = 0.0;
  }
}

bool WitnessLocator::Fires(int witness, double before, double after) const {
  const Direction direction = plan_.witnesses[witness].direction;
  return (direction != Direction::kRising && before > 0.0 && after <= 0.0) ||
         (direction != Direction::kFalling && before < 0.0 && after >= 0.0);
}

double WitnessLocator::FirstCrossing(Context& context, int witness) {
  const int looks =
      std::max(kLeastLooks, static_cast<int>(std::ceil((end_ - begin_) / kLongestBlink)));
  const double blink = (end_ - begin_) / looks;
  Look before{begin_, start_value_[witness]}, last = before;
  scale_[witness] = std::fabs(last.w);
  double crossing = kNever;
  for (int k = 1; k <= looks && crossing == kNever; ++k) {
    const Look now = LookAt(context, witness, k == looks ? end_ : begin_ + k * blink);
    if (k == 1 && last.w == 0.0) crossing = CrossingFromRest(context, witness, last, now);
    if (k == 1 && SameSign(last.w, now.w) && std::fabs(last.w) < std::fabs(now.w)) {
      before = last;
      last = LookAt(context, witness, begin_ + kProbe * blink);
    }
    if (before.t < last.t && crossing == kNever) {
      crossing = CrossingInDip(context, witness, before, last, now);
    }
    if (crossing == kNever) crossing = CrossingBetween(context, witness, last, now);
    if (k == looks && crossing == kNever && SameSign(last.w, now.w) &&
        std::fabs(now.w) < std::fabs(last.w)) {
      const Look probe = LookAt(context, witness, end_ - kProbe * blink);
      crossing = CrossingInDip(context, witness, last, probe, now);
    }
    if (k == looks && crossing == kNever) crossing = CrossingAfter(witness, last, now);
    before = last;
    last = now;
  }
  end_value_[witness] = last.w;
  return crossing;
}

double WitnessLocator::CrossingBetween(Context& context, int witness, Look left, Look right) {
  return Fires(witness, left.w, right.w) ? Bracket(context, witness, left, right) : kNever;
}

/// A guard that starts at rest may leave zero and come back before the first look.
double WitnessLocator::CrossingFromRest(Context& context, int witness, Look start, Look next) {
  const double shortest = 0.1 * Resolution(next.t);
  while (next.w != 0.0 && next.t - start.t > shortest) {
    const Look sooner = LookAt(context, witness, 0.5 * (start.t + next.t));
    if (sooner.w != 0.0 && !SameSign(sooner.w, next.w)) {
      return CrossingBetween(context, witness, sooner, next);
    }
    next = sooner;
  }
  return kNever;
}

/// Two crossings between three looks of one sign, |w| being least in the middle.
double WitnessLocator::CrossingInDip(Context& context, int witness, Look left, Look middle,
                                     Look right) {
  if (!SameSign(left.w, middle.w) || !SameSign(middle.w, right.w)) return kNever;
  const double sign = middle.w > 0.0 ? 1.0 : -1.0;
  const Look first = left, last = right;
  for (int i = 0; i < 60; ++i) {
    if (std::fabs(middle.w) > std::fabs(left.w) || std::fabs(middle.w) > std::fabs(right.w)) break;
    const double l = middle.t - left.t, r = right.t - middle.t;
    const double a = (middle.w - left.w) / l, b = (right.w - middle.w) / r;
    const double curvature = (b - a) / (l + r);
    const double slope = (a * r + b * l) / (l + r);  // of the parabola at the middle
    double shift = curvature == 0.0 ? 0.0 : -0.5 * slope / curvature;
    const double least = sign * (middle.w + 0.5 * slope * shift);
    if (i > 2 && least > 0.5 * std::fabs(middle.w)) break;
    const double span = std::max(l, r);
    if (span < Resolution(right.t)) break;
    // Near the middle, or at each third time, the longer side shrinks instead.
    if (std::fabs(shift) < 1e-3 * span || i % 3 == 2) shift = r > l ? 0.38 * r : -0.38 * l;
    const Look next = LookAt(context, witness, middle.t + std::clamp(shift, -0.9 * l, 0.9 * r));
    if (sign * next.w <= 0.0) {
      const double down = CrossingBetween(context, witness, first, next);
      return down < kNever ? down : CrossingBetween(context, witness, next, last);
    }
    if (std::fabs(next.w) < std::fabs(middle.w)) {
      (next.t > middle.t ? left : right) = middle;
      middle = next;
    } else {
      (next.t > middle.t ? right : left) = next;
    }
  }
  return kNever;
}

/// A crossing so short after the step that rounding alone may have put it there.
double WitnessLocator::CrossingAfter(int witness, Look last, Look end) const {
  if (!SameSign(last.w, end.w) || !Fires(witness, end.w, 0.0)) return kNever;
  const double approach = (std::fabs(last.w) - std::fabs(end.w)) / (end.t - last.t);
  const double wait = std::fabs(end.w) / approach;
  return approach > 0.0 && wait <= Resolution(end.t) ? end.t + wait : kNever;
}

/// The right end of a bracket of a crossing, by regula falsi (Illinois) and bisection.
double WitnessLocator::Bracket(Context& context, int witness, Look left, Look right) {
  const double before = left.w, width = 0.1 * Resolution(right.t);
  double left_weight = left.w, right_weight = right.w;
  for (int i = 0; right.t - left.t > width && i < 200; ++i) {
    double t = 0.5 * (left.t + right.t);
    if (i % 3 != 2 && right_weight != 0.0) {
      t = left.t + (right.t - left.t) * left_weight / (left_weight - right_weight);
    }
    t = std::clamp(t, left.t + 0.5 * width, right.t - 0.5 * width);
    const Look middle = LookAt(context, witness, t);
    if (Fires(witness, before, middle.w)) {
      right = middle;
      right_weight = middle.w;
      left_weight *= 0.5;
    } else {
      left = middle;
      left_weight = middle.w == 0.0 ? before : middle.w;
      right_weight *= 0.5;
    }
  }
  return right.t;
}

WitnessLocator::Look WitnessLocator::LookAt(Context& context, int witness, double t) {
  MoveTo(context, t);
  const double w = plan_.EvaluateWitness(context, witness);
  scale_[witness] = std::max(scale_[witness], std::fabs(w));
  return {t, std::fabs(w) <= plan_.witness_states(context)[witness].rest ? 0.0 : w};
}

void WitnessLocator::MoveTo(Context& context, double t) {
  if (context.time() == t) return;
  if (integrator_ == nullptr) return context.SetTime(t);
  if (t == end_) return plan_.SetTimeAndState(context, t, end_state_.data());
  integrator_->Interpolate(context, t, at_.data());
  plan_.SetTimeAndState(context, t, at_.data());
}

void WitnessLocator::Trigger(Context& context, int witness) {
  Plan::WitnessState& state = plan_.witness_states(context)[witness];
  const double left_over = std::fabs(plan_.EvaluateWitness(context, witness));
  state.rest = left_over <= kJump * scale_[witness] ? left_over : 0.0;
  state.pending = 1;
  const double t = context.time();
  state.interval = state.count == 0 ? 0.0 : t - state.last;
  state.last = t;
  if (state.count == 0 || t - state.window_start > ZenoWindow(t)) {
    state.window_start = t;
    state.count = 0;
  }
  ++state.count;
}

void WitnessLocator::CheckZeno(const Context& context, int witness) const {
  const Plan::WitnessState& state = plan_.witness_states(context)[witness];
  const double t = context.time();
  if (state.count >= kZenoCount && t - state.window_start <= ZenoWindow(t)) {
    FailZeno(context, witness, state);
  }
}

void WitnessLocator::FailZeno(const Context& context, int witness,
                              const Plan::WitnessState& state) const {
  const double t = context.time();
  const double ratio = (t - state.last) / state.interval;
  const double limit = ratio < 1.0 ? t + (t - state.last) * ratio / (1.0 - ratio) : t;
  throw SimulationError(
      plan_.PathOf(*plan_.witnesses[witness].system), plan_.witnesses[witness].name, t,
      fmt::format("its events accumulate (Zeno) towards t = {:.12g} s; got {} since t = {:.12g} s; "
                  "expected a state that comes to rest, or events further apart",
                  limit, state.count, state.window_start));
}

}  // namespace oca
