// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/plants/motion_limiter.h"

#include <algorithm>
#include <cmath>

#include "oca/framework/dataflow/json_text.h"
#include "oca/models/robot/motion_limits.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/json_fields.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

// Less than this is rounding, and no news (rad, m).
constexpr double kUnchanged = 1e-12;
// Share of the acceleration limit that catching up brakes with; the rest is the request's own.
constexpr double kCatchUpShare = 0.5;

}  // namespace

/// What becomes of the request of one joint.
struct MotionLimiter::Answer {
  double position;
  double velocity;
  MotionClip clip;
};

void MotionLimiter::Params::Describe(Fields<Params>& fields) {
  AddModel(fields);
  AddControlPeriod(fields);
  fields.Add("enabled", &Params::enabled, "", "false: the request passes unchanged");
}

MotionLimiter::MotionLimiter(const Params& params, const ModelSet& models)
    : params_(Validated(params)),
      model_(MovableModel(models, params.model)),
      c_(DeclareDiscreteState("c", DeltaSpec(*model_), 0.0)),
      r_(DeclareDiscreteState("r", DeltaSpec(*model_), 0.0)),
      v_(DeclareDiscreteState("v", RateSpec(*model_), 0.0)),
      a_(DeclareDiscreteState("a", {model_->num_positions(), RateSpec(*model_).unit.Rate()}, 0.0)),
      started_(DeclareDiscreteState("started", {1, Unit::Any()}, 0.0)),
      // Whatever is requested is answered, so it may be anywhere.
      request(DeclareInput<Vector>("request", DeltaSpec(*model_))),
      measured_position(DeclareOptionalInput<Vector>("measured_position", PositionSpec(*model_))),
      position(DeclareOutput<Vector, &MotionLimiter::CalcPosition>(
          "position", DeltaSpec(*model_), request, c_, r_, v_, a_, started_)),
      velocity(DeclareOutput<Vector, &MotionLimiter::CalcVelocity>(
          "velocity", RateSpec(*model_), request, c_, r_, v_, a_, started_)),
      clips(DeclareOutput<MotionClips, &MotionLimiter::CalcClips>("clips", {}, request, c_, r_, v_,
                                                                  a_, started_)) {
  DeclareInitialization<&MotionLimiter::Start>(Writes(c_, r_), request, measured_position);
  DeclareUpdate<&MotionLimiter::Update>(Every{params_.period}, Writes(c_, r_, v_, a_, started_),
                                        request, position, velocity);
  if (!params_.enabled) return;
  DeclareRole(Limits{.shown = Limits::Shown::kListed,
                     .signal = clips,
                     .member = "clips",
                     .period = params_.period});
}

void MotionLimiter::Start(VectorView asked, std::optional<VectorView> measured, MutableVectorView c,
                          MutableVectorView r) const {
  c = measured ? *measured : asked;
  r = asked;
}

void MotionLimiter::Update(VectorView asked, VectorView command, VectorView rate,
                           MutableVectorView c, MutableVectorView r, MutableVectorView v,
                           MutableVectorView a, MutableVectorView started) const {
  started[0] = 1.0;
  a = (rate - v) / params_.period.seconds();
  v = rate;
  c = command;
  r = asked;
}

double MotionLimiter::Wish(double asked, double c, double r, double v,
                           const motion::JointLimits& limits) const {
  const double dt = params_.period.seconds();
  const double lag = std::fabs(r - c);
  // In one division, so that a request without lag passes bit by bit.
  const double whole = (asked - c) / dt;
  if (lag <= kUnchanged) return whole;
  const double a = kCatchUpShare * limits.acceleration;
  const bool jerky = std::isfinite(limits.acceleration) && std::isfinite(limits.jerk);
  double catch_up = motion::LargestStoppableVelocity(lag, a, dt);
  if (jerky) {
    // Distance to a halt from u: u^2 / (2 a) + u T, T the time until the brakes are on.
    const double ramp = a * limits.acceleration / limits.jerk;
    catch_up = std::min(catch_up, std::sqrt(ramp * ramp + 2.0 * a * lag) - ramp);
  }
  const double wish =
      catch_up >= lag / dt ? whole : (asked - r) / dt + std::copysign(catch_up, r - c);
  if (!jerky) return wish;
  // The same again for the velocity: its change must end when the wish is met.
  const double away = wish - v;
  const double change =
      motion::LargestStoppableVelocity(std::fabs(away), kCatchUpShare * limits.jerk, dt);
  return v + std::copysign(std::min(std::fabs(away), change * dt), away);
}

MotionLimiter::Answer MotionLimiter::Answers(VectorView asked, const Past& past,
                                             Eigen::Index joint) const {
  const double dt = params_.period.seconds();
  const double c = past.c[joint];
  const double whole = (asked[joint] - c) / dt;
  Answer answer{asked[joint], whole, {}};
  if (!params_.enabled) return answer;
  if (past.started[0] == 0.0) return {c, 0.0, {}};
  const motion::JointLimits limits = robot::LimitsOf(*model_, joint);
  const motion::VelocityRange range =
      motion::StoppableVelocities(limits, {c, past.v[joint], past.a[joint]}, dt);
  const double wish = Wish(asked[joint], c, past.r[joint], past.v[joint], limits);
  answer.velocity = std::min(std::max(wish, range.lower), range.upper);
  if (answer.velocity == whole) return answer;
  answer.position = c + answer.velocity * dt;
  motion::MotionLimit limit = motion::MotionLimit::kAcceleration;  // of the way to catch up
  if (wish > range.upper) limit = range.upper_limit;
  if (wish < range.lower) limit = range.lower_limit;
  answer.clip = {static_cast<int>(joint), limit, range.yields, answer.position - asked[joint]};
  return answer;
}

void MotionLimiter::CalcPosition(VectorView asked, VectorView c, VectorView r, VectorView v,
                                 VectorView a, VectorView started, MutableVectorView out) const {
  for (Eigen::Index i = 0; i < out.size(); ++i)
    out[i] = Answers(asked, {c, r, v, a, started}, i).position;
}

void MotionLimiter::CalcVelocity(VectorView asked, VectorView c, VectorView r, VectorView v,
                                 VectorView a, VectorView started, MutableVectorView out) const {
  for (Eigen::Index i = 0; i < out.size(); ++i)
    out[i] = Answers(asked, {c, r, v, a, started}, i).velocity;
}

void MotionLimiter::CalcClips(VectorView asked, VectorView c, VectorView r, VectorView v,
                              VectorView a, VectorView started, MotionClips& out) const {
  out.clips.clear();
  out.clips.reserve(static_cast<std::size_t>(asked.size()));
  for (Eigen::Index i = 0; i < asked.size(); ++i) {
    const MotionClip clip = Answers(asked, {c, r, v, a, started}, i).clip;
    if (std::fabs(clip.amount) > kUnchanged) out.clips.push_back(clip);
  }
}

}  // namespace oca::systems

namespace oca {

using systems::MotionClips;

Fault Signal<MotionClips>::Check(const MotionClips& value, Look /*look*/) {
  return Fault::UnlessFinite(
      std::all_of(value.clips.begin(), value.clips.end(),
                  [](const auto& clip) { return std::isfinite(clip.amount); }));
}

void Signal<MotionClips>::WriteJson(const MotionClips& value, std::string& out) {
  systems::Json list = systems::Json::array();
  for (const systems::MotionClip& clip : value.clips) {
    list.push_back({{"joint", clip.joint},
                    {"limit", NameOf(clip.limit)},
                    {"yields", NameOf(clip.yields)},
                    {"amount", clip.amount}});
  }
  out += oca::internal::JsonText(list);
}

}  // namespace oca
