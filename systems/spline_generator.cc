// SPDX-License-Identifier: BSD-3-Clause
#include "systems/spline_generator.h"

#include <fmt/format.h>

#include "framework/error.h"
#include "systems/require.h"

namespace oca::systems {
namespace {

SplineGenerator::Params Checked(SplineGenerator::Params params) {
  RequireNotNegative("period", params.period);
  params.key_points = KeyPointsFrom(params.key_points, params.file);
  return params;
}

[[noreturn]] void RefuseUnused(std::size_t point, const char* what, const char* kind,
                               const char* expected) {
  throw ConfigError(
      fmt::format("key_points[{}].{}: a {} spline does not meet it; got a value; "
                  "expected {}",
                  point, what, kind, expected));
}

/// Numbers that the spline would silently ignore are refused.
void CheckUsed(const SplineGenerator::Params& params) {
  const auto& points = params.key_points;
  const char* const kind = EnumNames(params.kind)[static_cast<std::size_t>(params.kind)];
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].acceleration && params.kind != SplineKind::kQuintic) {
      RefuseUnused(i, "acceleration", kind, "none, or kind quintic");
    }
    if (!points[i].velocity || params.kind != SplineKind::kC2) continue;
    const bool inside = i > 0 && i + 1 < points.size();
    if (inside) RefuseUnused(i, "velocity", kind, "one at the first and last point only");
    if (params.ends == Trajectory::Ends::kNatural) {
      RefuseUnused(i, "velocity", kind, "none, or ends clamped");
    }
  }
}

Trajectory Interpolated(const SplineGenerator::Params& params) {
  CheckUsed(params);
  switch (params.kind) {
    case SplineKind::kCubic:
      return Trajectory::CubicHermite(params.key_points);
    case SplineKind::kQuintic:
      return Trajectory::QuinticHermite(params.key_points);
    case SplineKind::kC2:
      return Trajectory::CubicSpline(params.key_points, params.ends);
  }
  throw ConfigError(fmt::format("kind: unknown; got {}; expected cubic, quintic or c2",
                                static_cast<int>(params.kind)));
}

}  // namespace

std::span<const char* const> EnumNames(SplineKind) {
  static constexpr const char* kNames[] = {"cubic", "quintic", "c2"};
  return kNames;
}

std::span<const char* const> EnumNames(Trajectory::Ends) {
  static constexpr const char* kNames[] = {"clamped", "natural"};
  return kNames;
}

void SplineGenerator::Params::Describe(Fields<Params>& fields) {
  fields.Add("kind", &Params::kind, "", "what is continuous, and what is met at key points");
  fields.Add("ends", &Params::ends, "", "of a c2 spline: clamped or natural");
  fields.Add("key_points", &Params::key_points, "", "points in order of time");
  fields.Add("file", &Params::file, "", "CSV file of key points (time, p1..pn) instead");
  fields
      .Add("period", &Params::period, "s",
           "0: continuous in time; > 0: sampled for the end of each period and held")
      .AtLeast(0.0);
  fields.Add("unit", &Params::unit, "", "unit of the position");
}

SplineGenerator::Params SplineGenerator::Example() {
  return {.key_points = {{.time = 0.0, .position = Eigen::Vector2d(0.0, 1.0)},
                         {.time = 1.0, .position = Eigen::Vector2d(0.5, -1.0)}}};
}

SplineGenerator::SplineGenerator(const Params& params)
    : params_(Checked(params)),
      trajectory_(Interpolated(params_)),
      spec_{static_cast<int>(trajectory_.size()), Unit(params_.unit)},
      rate_spec_{spec_.size, spec_.unit.Rate()},
      rate_rate_spec_{spec_.size, rate_spec_.unit.Rate()},
      sampled_position_(DeclareSample("position", spec_, 0)),
      sampled_velocity_(DeclareSample("velocity", rate_spec_, 1)),
      sampled_acceleration_(DeclareSample("acceleration", rate_rate_spec_, 2)),
      position(DeclareMotion<&SplineGenerator::CalcPosition>("position", spec_, sampled_position_)),
      velocity(
          DeclareMotion<&SplineGenerator::CalcVelocity>("velocity", rate_spec_, sampled_velocity_)),
      acceleration(DeclareMotion<&SplineGenerator::CalcAcceleration>(
          "acceleration", rate_rate_spec_, sampled_acceleration_)),
      goal(DeclareOutput<Vector, &SplineGenerator::CalcGoal>("goal", spec_)) {
  if (!params_.period.positive()) return;
  DeclareUpdate<&SplineGenerator::Sample>(
      Every{params_.period}, Writes(sampled_position_, sampled_velocity_, sampled_acceleration_),
      kTime);
}

DiscreteState<Vector> SplineGenerator::DeclareSample(const char* name, const PortSpec& spec,
                                                     int derivative) {
  if (!params_.period.positive()) return {};
  return DeclareDiscreteState(name, spec, trajectory_.Evaluate(0.0, derivative));
}

template <auto kMethod>
Output<Vector> SplineGenerator::DeclareMotion(const char* name, const PortSpec& spec,
                                              const DiscreteState<Vector>& sampled) {
  if (params_.period.positive()) return DeclareStateOutput(name, sampled);
  return DeclareOutput<Vector, kMethod>(name, spec, kTime);
}

void SplineGenerator::CalcPosition(double time, MutableVectorView out) const {
  trajectory_.Evaluate(time, 0, out);
}

void SplineGenerator::CalcVelocity(double time, MutableVectorView out) const {
  trajectory_.Evaluate(time, 1, out);
}

void SplineGenerator::CalcAcceleration(double time, MutableVectorView out) const {
  trajectory_.Evaluate(time, 2, out);
}

void SplineGenerator::CalcGoal(MutableVectorView out) const { out = trajectory_.goal(); }

void SplineGenerator::Sample(double time, MutableVectorView next_position,
                             MutableVectorView next_velocity,
                             MutableVectorView next_acceleration) const {
  const double end = time + params_.period.seconds();
  trajectory_.Evaluate(end, 0, next_position);
  trajectory_.Evaluate(end, 1, next_velocity);
  trajectory_.Evaluate(end, 2, next_acceleration);
}

}  // namespace oca::systems
