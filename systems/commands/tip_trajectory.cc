// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/tip_trajectory.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/sensing/model_links.h"

namespace oca::systems {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kStep = 0.02;        // s
constexpr double kTolerance = 1e-9;   // m
constexpr double kDamping = 1e-8;     // m^2/rad^2
constexpr double kLongestStep = 0.2;  // rad, of one iteration
constexpr int kIterations = 500;

double Smooth(double x) { return x * x * x * (10.0 + x * (-15.0 + 6.0 * x)); }

/// The path in the base frame, s from 0 to 1.
class Path {
 public:
  explicit Path(const TipRequest::Params& params) : params_(params) {
    if (params.path != TipPath::kCircle) return;
    const Vector3d n = params.normal->normalized();
    const Vector3d up = std::abs(n.z()) > 0.999 ? Vector3d::UnitX() : Vector3d::UnitZ();
    u_ = (up - up.dot(n) * n).normalized();
    w_ = n.cross(u_);
  }
  Vector3d operator()(double s) const {
    if (params_.path == TipPath::kLine) return *params_.from + s * (*params_.to - *params_.from);
    const double angle = 2.0 * std::numbers::pi * s;
    return *params_.centre + *params_.radius * (u_ * std::cos(angle) + w_ * std::sin(angle));
  }

 private:
  const TipRequest::Params& params_;
  Vector3d u_, w_;
};

/// Moves the joints until the link's origin is at a point.
class TipSolver {
 public:
  TipSolver(const robot::RobotModel& model, int link)
      : model_(model),
        link_(link),
        X_WL_(static_cast<std::size_t>(model.num_links())),
        J_(3, model.num_positions()) {}

  /// Changes q as little as each step needs; returns how far off the tip is in the end, m.
  double Solve(const Vector3d& p_B, VectorXd& q) {
    const Vector3d p_W = model_.X_WB() * p_B;
    double error = 0.0;
    for (int i = 0; i < kIterations; ++i) {
      robot::ForwardKinematics(model_, q, X_WL_);
      const Vector3d tip = X_WL_[static_cast<std::size_t>(link_)].translation();
      error = (p_W - tip).norm();
      if (error < kTolerance) break;
      robot::PointJacobian(model_, X_WL_, link_, tip, J_);
      const Eigen::Matrix3d damped = J_ * J_.transpose() + kDamping * Eigen::Matrix3d::Identity();
      const VectorXd step = J_.transpose() * damped.ldlt().solve(p_W - tip);
      q += step * std::min(1.0, kLongestStep / std::max(step.norm(), 1e-300));
    }
    return error;
  }

 private:
  const robot::RobotModel& model_;
  const int link_;
  std::vector<Eigen::Isometry3d> X_WL_;
  Eigen::Matrix3Xd J_;
};

void CheckGiven(bool given, bool wanted, const char* key, const char* path) {
  if (given == wanted) return;
  throw ConfigError(fmt::format("{}: got {}; expected {} of a {}", key, given ? "a value" : "none",
                                wanted ? "one" : "none", path));
}

void CheckJoints(const robot::RobotModel& model, const VectorXd& q, const Vector3d& p,
                 double error) {
  if (!(error < kTolerance)) {
    throw ConfigError(
        fmt::format("path: the tip cannot reach ({:.4g}, {:.4g}, {:.4g}); got {:.3g} m "
                    "off; expected a path within reach",
                    p.x(), p.y(), p.z(), error));
  }
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (q[i] >= model.lower_limits()[i] && q[i] <= model.upper_limits()[i]) continue;
    throw ConfigError(
        fmt::format("path: takes joint '{}' to {:.4g}; expected within [{:.4g}, {:.4g}]; another "
                    "posture may do",
                    model.position_names()[static_cast<std::size_t>(i)].text(), q[i],
                    model.lower_limits()[i], model.upper_limits()[i]));
  }
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
  fields.Add("model", &P::model, "", "name of the robot; may be left out if there is but one");
  fields.Add("link", &P::link, "",
             "whose origin is the tip; the last that a joint moves if left out");
  fields.Add("path", &P::path, "", "what the tip draws");
  fields.Add("from", &P::from, "m", "where a line starts, base frame");
  fields.Add("to", &P::to, "m", "where it ends");
  fields.Add("centre", &P::centre, "m", "of a circle, base frame");
  fields.Add("normal", &P::normal, "", "across the plane of a circle");
  fields.Add("radius", &P::radius, "m", "of a circle").Above(0.0);
  fields.Add("posture", &P::posture, "rad", "joint positions at the beginning").Required();
  fields.Add("start", &P::start, "s", "when the approach begins").AtLeast(0.0);
  fields.Add("approach", &P::approach, "s", "from the posture to the path").Above(0.0);
  fields.Add("duration", &P::duration, "s", "along the path").Above(0.0).AtMost(3600.0);
  fields
      .Add("period", &P::period, "s",
           "0: continuous in time; > 0: sampled for the end of each period and held")
      .AtLeast(0.0);
  fields.Add("unit", &P::unit, "", "unit of the position");
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
  const bool line = params.path == TipPath::kLine;
  const char* const kind = EnumNames(params.path)[static_cast<std::size_t>(params.path)];
  CheckGiven(params.from.has_value(), line, "from", kind);
  CheckGiven(params.to.has_value(), line, "to", kind);
  CheckGiven(params.centre.has_value(), !line, "centre", kind);
  CheckGiven(params.normal.has_value(), !line, "normal", kind);
  CheckGiven(params.radius.has_value(), !line, "radius", kind);
  if (!line && !(params.normal->norm() > 1e-9)) {
    throw ConfigError("normal: got no direction; expected a vector that is not zero");
  }
  const auto model = MovableModel(models, params.model);
  if (params.posture.size() != model->num_positions()) {
    throw ConfigError(fmt::format("posture: got {} numbers; expected {}", params.posture.size(),
                                  model->num_positions()));
  }
  TipSolver solver(*model, TipOf(*model, params.link));
  const Path path(params);
  VectorXd q = params.posture;
  CheckJoints(*model, q, path(0.0), 0.0);
  CheckJoints(*model, q, path(0.0), solver.Solve(path(0.0), q));
  const VectorXd first = q;
  params.points.clear();
  const auto add = [&](double time, const VectorXd& position) {
    params.points.push_back({.time = time, .position = position});
  };
  const int approach = static_cast<int>(std::ceil(params.approach / kStep));
  for (int i = 0; i < approach; ++i) {
    const double x = static_cast<double>(i) / approach;
    add(params.start + x * params.approach, params.posture + Smooth(x) * (first - params.posture));
  }
  const int steps = static_cast<int>(std::ceil(params.duration / kStep));
  for (int i = 0; i <= steps; ++i) {
    const double x = static_cast<double>(i) / steps;
    const Vector3d p = path(Smooth(x));
    CheckJoints(*model, q, p, solver.Solve(p, q));
    add(params.start + params.approach + x * params.duration, q);
  }
  return params;
}

TipRequest::Params TipRequest::Checked(Params params) {
  Validated(params);
  if (params.points.empty()) {
    throw ConfigError("path: no robot to draw it; expected a model");
  }
  return params;
}

Trajectory TipRequest::MakeTrajectory(const Params& params) {
  return Trajectory::CubicSpline(params.points, Trajectory::Ends::kClamped);
}

}  // namespace oca::systems
