// SPDX-License-Identifier: BSD-3-Clause
#include "oca/framework/simulation/witness_locator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "oca/framework/dataflow/error.h"

namespace oca {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// Crossings no further apart than this are simultaneous; s, relative beyond 1 s.
constexpr double kSimultaneous = 1e-12;
/// Looks at each step, and the longest time between two, s.
constexpr int kLeastLooks = 2;
/// How often the time between two looks is halved near zero.
constexpr int kDepth = 6;
constexpr double kLongestBlink = 0.025;
/// How near a look the slope is felt there, as a part of the time to the next.
constexpr double kProbe = 1e-3;
/// A function that ends its bracket larger than this part of itself has jumped across zero.
constexpr double kJump = 1e-6;
/// So many crossings of one witness within so short a time, s (relative beyond 1 s), are Zeno's.
constexpr std::int64_t kZenoCount = 16;
constexpr double kZenoWindow = 1e-8;
/// So are so many in a row, each sooner by a hundredth or more, that would end within so short a
/// time. Any nearer to the end the integrators' tolerances would let a ball fall through the
/// ground.
constexpr std::int64_t kZenoRow = 32;
constexpr double kSooner = 0.99;
constexpr double kZenoRest = 1e-4;

double Relative(double seconds, double t) { return seconds * std::max(1.0, std::fabs(t)); }
double Resolution(double t) { return Relative(kSimultaneous, t); }

bool SameSign(double a, double b) { return (a > 0.0 && b > 0.0) || (a < 0.0 && b < 0.0); }

}  // namespace

WitnessLocator::WitnessLocator(const Schedule& schedule, const IntegratorOptions& options)
    : schedule_(schedule),
      max_steps_(options.max_steps),
      end_state_(schedule.continuous_size),
      at_(schedule.continuous_size),
      start_value_(schedule.witnesses.size()),
      end_value_(schedule.witnesses.size()),
      scale_(schedule.witnesses.size()),
      crossing_(schedule.witnesses.size()) {}

bool WitnessLocator::Advance(Context& context, IntegrationMethod* integrator, double to) {
  integrator_ = integrator;
  Start(context);
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
    start_value_[i] = Value(context, static_cast<int>(i));
  }
}

/// The witness at the context's time and state; 0 while it is at rest.
double WitnessLocator::Value(Context& context, int witness) const {
  const double w = schedule_.EvaluateWitness(context, witness);
  const Schedule::WitnessState& state = schedule_.witness_states(context)[witness];
  const bool just_crossed =
      state.count > 0 && context.time() - state.last <= 2.0 * Resolution(context.time());
  return just_crossed && std::fabs(w) <= state.rest ? 0.0 : w;
}

bool WitnessLocator::FindCrossings(Context& context, double to) {
  end_ = context.time();
  std::copy_n(schedule_.continuous(context), end_state_.size(), end_state_.data());
  double earliest = kNever;
  for (std::size_t i = 0; i < crossing_.size(); ++i) {
    crossing_[i] = FirstCrossing(context, static_cast<int>(i));
    earliest = std::min(earliest, crossing_[i]);
  }
  const double resolution = Resolution(end_);
  // What will cross right after the step belongs to it only if an event is there anyway.
  if (earliest == kNever || (earliest > end_ && end_ < to)) {
    MoveTo(context, end_);
    start_value_ = end_value_;
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

bool WitnessLocator::Fires(int witness, double before, double after) const {
  const Direction direction = schedule_.witnesses[witness].direction;
  return (direction != Direction::kRising && before > 0.0 && after <= 0.0) ||
         (direction != Direction::kFalling && before < 0.0 && after >= 0.0);
}

/// Where the witness first crosses in the present step, s; infinity if it does not.
double WitnessLocator::FirstCrossing(Context& context, int witness) {
  const Look start{begin_, start_value_[witness]};
  scale_[witness] = std::fabs(start.w);
  const Look end = LookAt(context, witness, end_);
  end_value_[witness] = end.w;
  const double blinks = std::ceil((end_ - begin_) / kLongestBlink);
  const double crossing =
      Scan(context, witness, start, end, std::max(kLeastLooks, static_cast<int>(blinks)));
  return crossing < kNever ? crossing : CrossingAfter(context, witness, end);
}

/// The first crossing in (left, right], with so many looks.
double WitnessLocator::Scan(Context& context, int witness, Look left, Look right, int looks) {
  const double begin = left.t, blink = (right.t - left.t) / looks;
  if (blink < Resolution(right.t)) return kNever;
  for (int k = 1; k <= looks; ++k) {
    const Look now = k == looks ? right : LookAt(context, witness, begin + k * blink);
    const double crossing = Crossing(context, witness, left, now, kDepth);
    if (crossing < kNever) return crossing;
    left = now;
  }
  return kNever;
}

double WitnessLocator::Crossing(Context& context, int witness, Look left, Look right, int depth) {
  if (left.w == 0.0) return CrossingFromRest(context, witness, left, right);
  if (SameSign(left.w, right.w)) return CrossingAndBack(context, witness, left, right, depth);
  const auto [before, after] = Bracket(context, witness, left, right);
  // Of three crossings between two looks any may have been bracketed.
  const double sooner = Scan(context, witness, left, before, kLeastLooks);
  if (sooner < kNever) return sooner;
  if (Fires(witness, before.w, after.w)) return after.t;
  return CrossingFromRest(context, witness, {after.t, 0.0}, right);
}

/// A guard that starts at rest may leave zero and come back before the next look.
double WitnessLocator::CrossingFromRest(Context& context, int witness, Look start, Look next) {
  const double shortest = 0.1 * Resolution(next.t);
  double crossing = kNever;
  while (next.t - start.t > shortest) {
    const Look sooner = LookAt(context, witness, 0.5 * (start.t + next.t));
    if (sooner.w != 0.0) {
      crossing = std::min(crossing, Crossing(context, witness, sooner, next, kDepth - 1));
    } else if (next.w == 0.0) {
      break;  // it stays there
    }
    next = sooner;
  }
  return crossing;
}

/// Crossings between two looks of one sign. Where a parabola through the middle stays well away
/// from zero there are none; elsewhere each half is searched.
double WitnessLocator::CrossingAndBack(Context& context, int witness, Look left, Look right,
                                       int depth) {
  if (right.t - left.t < Resolution(right.t)) return kNever;
  const Look middle = LookAt(context, witness, 0.5 * (left.t + right.t));
  if (SameSign(left.w, middle.w)) {
    const double bend = std::fabs(middle.w - 0.5 * (left.w + right.w));
    const bool away = std::min(std::fabs(left.w), std::fabs(right.w)) > 4.0 * bend;
    // Three looks may lie on a line by chance, so the first halves are looked at in any case.
    if (away && depth < kDepth) return kNever;
    if (depth <= 0) return CrossingInDip(context, witness, left, right);
  }
  const double crossing = Crossing(context, witness, left, middle, depth - 1);
  return crossing < kNever ? crossing : Crossing(context, witness, middle, right, depth - 1);
}

/// As above, by going down from the nearer end, if it goes down there.
double WitnessLocator::CrossingInDip(Context& context, int witness, Look left, Look right) {
  const bool nearer_left = std::fabs(left.w) < std::fabs(right.w);
  const double probe = kProbe * (right.t - left.t);
  Look lowest = LookAt(context, witness, nearer_left ? left.t + probe : right.t - probe);
  if (SameSign(lowest.w, left.w)) {
    if (std::fabs(lowest.w) >= std::min(std::fabs(left.w), std::fabs(right.w))) return kNever;
    lowest = Minimum(context, witness, left, lowest, right);
    if (SameSign(lowest.w, left.w)) return kNever;
  }
  const double crossing = Crossing(context, witness, left, lowest, 0);
  return crossing < kNever ? crossing : Crossing(context, witness, lowest, right, 0);
}

/// Goes down |w| from three looks of one sign, |w| being least in the middle, by parabolas and
/// golden sections, until the sign changes or the minimum plainly lies above zero.
WitnessLocator::Look WitnessLocator::Minimum(Context& context, int witness, Look left, Look middle,
                                             Look right) {
  for (int i = 0; i < 60; ++i) {
    const double l = middle.t - left.t, r = right.t - middle.t, span = std::max(l, r);
    const double a = (middle.w - left.w) / l, b = (right.w - middle.w) / r;
    const double slope = (a * r + b * l) / (l + r), curvature = (b - a) / (l + r);
    double shift = curvature == 0.0 ? 0.0 : -0.5 * slope / curvature;
    const double least = (middle.w + 0.5 * slope * shift) / middle.w;
    if (span < Resolution(right.t) || (i > 4 && least > 0.9)) break;
    // Near the middle, and each third time, the longer side shrinks instead.
    if (std::fabs(shift) < 1e-3 * span || i % 3 == 2) shift = r > l ? 0.38 * r : -0.38 * l;
    const Look next = LookAt(context, witness, middle.t + std::clamp(shift, -0.9 * l, 0.9 * r));
    if (!SameSign(next.w, middle.w)) return next;
    if (std::fabs(next.w) < std::fabs(middle.w)) {
      (next.t > middle.t ? left : right) = middle;
      middle = next;
    } else {
      (next.t > middle.t ? right : left) = next;
    }
  }
  return middle;
}

/// A crossing so short after the step that rounding alone may have put it there.
double WitnessLocator::CrossingAfter(Context& context, int witness, Look end) {
  if (end.w == 0.0 || !Fires(witness, end.w, 0.0)) return kNever;
  const double resolution = Resolution(end.t);
  const double back = std::min(1e3 * resolution, end_ - begin_);
  const double fall = std::fabs(end.w) / scale_[witness];
  // |w| is no steeper than a million times what the whole step shows.
  if (fall > 1e6 * resolution / (end_ - begin_)) return kNever;
  const Look last = LookAt(context, witness, end.t - back);
  const double approach = (std::fabs(last.w) - std::fabs(end.w)) / back;
  const double wait = std::fabs(end.w) / approach;
  const bool soon = SameSign(last.w, end.w) && approach > 0.0 && wait <= resolution;
  return soon ? end.t + wait : kNever;
}

/// A bracket of one sign change, by regula falsi (Illinois) and bisection.
std::pair<WitnessLocator::Look, WitnessLocator::Look> WitnessLocator::Bracket(Context& context,
                                                                              int witness,
                                                                              Look left,
                                                                              Look right) {
  const double width = 0.1 * Resolution(right.t);
  double left_weight = left.w, right_weight = right.w;
  for (int i = 0; right.t - left.t > width && i < 200; ++i) {
    double t = 0.5 * (left.t + right.t);
    if (i % 3 != 2 && right_weight != 0.0) {
      t = left.t + (right.t - left.t) * left_weight / (left_weight - right_weight);
    }
    t = std::clamp(t, left.t + 0.5 * width, right.t - 0.5 * width);
    const Look middle = LookAt(context, witness, t);
    if (SameSign(left.w, middle.w)) {
      left = middle;
      left_weight = middle.w;
      right_weight *= 0.5;
    } else {
      right = middle;
      right_weight = middle.w;
      left_weight *= 0.5;
    }
  }
  return {left, right};
}

WitnessLocator::Look WitnessLocator::LookAt(Context& context, int witness, double t) {
  MoveTo(context, t);
  const double w = Value(context, witness);
  scale_[witness] = std::max(scale_[witness], std::fabs(w));
  return {t, w};
}

void WitnessLocator::MoveTo(Context& context, double t) {
  if (context.time() == t) return;
  if (integrator_ == nullptr) return context.SetTime(t);
  if (t == end_) return schedule_.SetTimeAndState(context, t, end_state_.data());
  integrator_->Interpolate(context, t, at_.data());
  schedule_.SetTimeAndState(context, t, at_.data());
}

void WitnessLocator::Trigger(Context& context, int witness) {
  Schedule::WitnessState& state = schedule_.witness_states(context)[witness];
  const double left_over = std::fabs(schedule_.EvaluateWitness(context, witness));
  state.rest = left_over <= kJump * scale_[witness] ? left_over : 0.0;
  state.pending = 1;
  const double t = context.time();
  state.row = IntervalTo(state, t) < kSooner * state.interval ? state.row + 1 : 0;
  state.interval = IntervalTo(state, t);
  state.last = t;
  if (state.count == 0 || t - state.window_start > Relative(kZenoWindow, t)) {
    state.window_start = t;
    state.count = 0;
  }
  ++state.count;
}

double WitnessLocator::IntervalTo(const Schedule::WitnessState& state, double t) {
  return state.count == 0 ? 0.0 : t - state.last;
}

void WitnessLocator::CheckZeno(const Context& context, int witness) const {
  const Schedule::WitnessState& state = schedule_.witness_states(context)[witness];
  const double t = context.time(), interval = IntervalTo(state, t);
  const bool crowd =
      state.count >= kZenoCount && t - state.window_start <= Relative(kZenoWindow, t);
  const bool sooner = interval < kSooner * state.interval;
  // What is left of a geometric series.
  const double rest = sooner ? interval * interval / (state.interval - interval) : 0.0;
  if (!crowd && !(sooner && state.row >= kZenoRow && rest < Relative(kZenoRest, t))) return;
  throw SimulationError(
      schedule_.PathOf(*schedule_.witnesses[witness].system), schedule_.witnesses[witness].name, t,
      fmt::format("its events accumulate (Zeno) towards t = {:.12g} s; got {} in a row, the last "
                  "{:.3g} s apart; expected a state that comes to rest, or events further apart",
                  t + rest, crowd ? state.count : state.row, interval));
}

}  // namespace oca
