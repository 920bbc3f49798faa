// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/spline_generator.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/sensing/model_links.h"

namespace oca::systems {
namespace {

[[noreturn]] void RefuseUnused(std::size_t point, const char* what, const char* kind,
                               const char* expected) {
  throw ConfigError(
      fmt::format("key_points[{}].{}: a {} spline does not meet it; got a value; "
                  "expected {}",
                  point, what, kind, expected));
}

/// Numbers that the spline would silently ignore are refused.
void CheckUsed(const SplineRequest::Params& params) {
  const auto& points = params.points;
  const char* const kind = EnumNames(params.kind)[static_cast<std::size_t>(params.kind)];
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].acceleration && params.kind != SplineKind::kQuintic) {
      RefuseUnused(i, "acceleration", kind, "none, or kind quintic");
    }
    if (!points[i].velocity || params.kind != SplineKind::kC2) continue;
    const bool inside = i > 0 && i + 1 < points.size();
    if (inside) RefuseUnused(i, "velocity", kind, "one at the first and last point only");
    if (params.ends == SplineEnds::kNatural) {
      RefuseUnused(i, "velocity", kind, "none, or ends clamped");
    }
  }
}

}  // namespace

std::span<const char* const> EnumNames(SplineKind) {
  static constexpr const char* kNames[] = {"cubic", "quintic", "c2"};
  return kNames;
}

std::span<const char* const> EnumNames(SplineEnds) {
  static constexpr const char* kNames[] = {"clamped", "natural"};
  return kNames;
}

void SplineRequest::Params::Describe(Fields<Params>& fields) {
  fields.Add("kind", &Params::kind, "", "what is continuous, and what is met at key points");
  fields.Add("ends", &Params::ends, "", "of a c2 spline: clamped or natural");
  AddKeyPoints(fields);
  fields.Add("goal", &Params::goal, "", "pose to end at, reached from the last key point");
  AddSampling(fields);
}

SplineRequest::Params SplineRequest::Example() {
  return {.key_points = {{.time = 0.0, .position = Eigen::Vector2d(0.0, 1.0)},
                         {.time = 1.0, .position = Eigen::Vector2d(0.5, -1.0)}}};
}

SplineRequest::Params SplineRequest::Resolved(Params params, const ModelSet& models) {
  params.points = KeyPointsFrom(params.key_points, params.file, params.joints,
                                RobotOfPostures(models, params.model).get());
  if (!params.goal) return params;
  const auto model = MovableModel(models, params.model);
  params.points.push_back(KeyPointAt(*params.goal, params.points.back(), model));
  params.goal.reset();
  return params;
}

SplineRequest::Params SplineRequest::Checked(Params params) {
  Validated(params);
  if (params.goal) {
    throw ConfigError("goal: a pose of a link; got no models; expected the model it is of");
  }
  if (params.points.empty()) {
    params.points = KeyPointsFrom(params.key_points, params.file, params.joints);
  }
  CheckUsed(params);
  return params;
}

motion::Trajectory SplineRequest::MakeTrajectory(const Params& params) {
  using motion::Trajectory;
  switch (params.kind) {
    case SplineKind::kCubic:
      return Trajectory::CubicHermite(params.points);
    case SplineKind::kQuintic:
      return Trajectory::QuinticHermite(params.points);
    case SplineKind::kC2:
      return Trajectory::CubicSpline(params.points, params.ends == SplineEnds::kClamped
                                                        ? Trajectory::Ends::kClamped
                                                        : Trajectory::Ends::kNatural);
  }
  throw ConfigError(fmt::format("kind: unknown; got {}; expected cubic, quintic or c2",
                                static_cast<int>(params.kind)));
}

}  // namespace oca::systems
