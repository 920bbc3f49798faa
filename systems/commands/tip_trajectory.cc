// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/tip_trajectory.h"

#include <fmt/format.h>

#include "oca/models/planning/tip_path.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/config_errors.h"

namespace oca::systems {
namespace {

using Eigen::Vector3d;

void CheckGiven(bool given, bool wanted, const char* key, const char* path) {
  if (given == wanted) return;
  throw ConfigError(fmt::format("{}: got {}; expected {} of a {}", key, given ? "a value" : "none",
                                wanted ? "one" : "none", path));
}

void CheckPathKeys(const TipRequest::Params& params) {
  const bool line = params.path == TipPath::kLine;
  const char* const kind = EnumNames(params.path)[static_cast<std::size_t>(params.path)];
  CheckGiven(params.from.has_value(), line, "from", kind);
  CheckGiven(params.to.has_value(), line, "to", kind);
  CheckGiven(params.centre.has_value(), !line, "centre", kind);
  CheckGiven(params.normal.has_value(), !line, "normal", kind);
  CheckGiven(params.radius.has_value(), !line, "radius", kind);
}

planning::TipPath TipPathOf(const TipRequest::Params& params) {
  return params.path == TipPath::kLine
             ? planning::LinePath(*params.from, *params.to)
             : planning::CirclePath(*params.centre, *params.normal, *params.radius);
}

int TipOf(const robot::RobotModel& model, const std::string& link) {
  try {
    return link.empty() ? model.bodies().back() : model.FindLink(link);
  } catch (const models::ModelError& error) {
    throw ConfigError(fmt::format("link: {}", error.what()));
  }
}

}  // namespace

void TipRequest::Params::Describe(Fields<Params>& fields) {
  using P = Params;
  AddModel(fields);
  fields.Add("link", &P::link, "",
             "whose origin is the tip; the last that a joint moves if left out");
  fields.Add("path", &P::path, "", "what the tip draws");
  fields.Add("from", &P::from, "m", "where a line starts, base frame");
  fields.Add("to", &P::to, "m", "where it ends");
  fields.Add("centre", &P::centre, "m", "of a circle, base frame");
  fields.Add("normal", &P::normal, "", "across the plane of a circle");
  fields.Add("radius", &P::radius, "m", "of a circle").Above(0.0);
  fields
      .Add(
          "posture", &P::posture, "rad",
          "joint positions at the beginning; or the name of a state of the SRDF, or some joints by "
          "name, the others at 0")
      .Required();
  fields.Add("start", &P::start, "s", "when the approach begins").AtLeast(0.0);
  fields.Add("approach", &P::approach, "s", "from the posture to the path").Above(0.0);
  fields.Add("duration", &P::duration, "s", "along the path").Above(0.0).AtMost(3600.0);
  AddSampling(fields);
}

TipRequest::Params TipRequest::Example() {
  Params params;
  params.link = "planar2_tip";
  params.from = Vector3d(0.7, 0.3, 0.0);
  params.to = Vector3d(0.4, 0.6, 0.0);
  params.posture = Eigen::Vector2d(0.1, 0.8);
  return params;
}

TipRequest::Params TipRequest::Resolved(Params params, const ModelSet& models) {
  Validated(params);
  CheckPathKeys(params);
  const auto path = WithConfigErrors([&] { return TipPathOf(params); });
  const auto model = MovableModel(models, params.model);
  const int link = TipOf(*model, params.link);
  const Eigen::VectorXd posture = NumbersOf(params.posture, model.get(), {}, "posture").values();
  params.points = WithConfigErrors([&] {
    return planning::KeyPointsAlong(*model, link, path, posture,
                                    {params.start, params.approach, params.duration});
  });
  return params;
}

TipRequest::Params TipRequest::Checked(Params params) {
  Validated(params);
  if (params.points.empty()) {
    throw ConfigError("path: no robot to draw it; expected a model");
  }
  return params;
}

motion::Trajectory TipRequest::MakeTrajectory(const Params& params) {
  return motion::Trajectory::CubicSpline(params.points, motion::Trajectory::Ends::kClamped);
}

}  // namespace oca::systems
