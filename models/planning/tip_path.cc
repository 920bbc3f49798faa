// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/tip_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "oca/models/error.h"
#include "oca/models/random.h"
#include "oca/models/robot/kinematics.h"

namespace oca::planning {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kStep = 0.02;        // s
constexpr double kTolerance = 1e-9;   // m
constexpr double kDamping = 1e-8;     // m^2/rad^2
constexpr double kLongestStep = 0.2;  // rad, of one iteration
constexpr int kIterations = 500;
constexpr int kStarts = 40;                               // beside the posture before
constexpr double kNearestStart = 0.02, kWidening = 1.15;  // rad or m; how far they lie from it
constexpr double kLongestJump = 0.5;  // rad or m, from one point of the path to the next

double Smooth(double x) { return x * x * x * (10.0 + x * (-15.0 + 6.0 * x)); }

void CheckJoints(const robot::RobotModel& model, const VectorXd& q, const Vector3d& p,
                 double error) {
  if (!(error < kTolerance)) {
    throw models::ModelError(
        fmt::format("path: the tip cannot reach ({:.4g}, {:.4g}, {:.4g}); got {:.3g} m "
                    "off; expected a path within reach",
                    p.x(), p.y(), p.z(), error));
  }
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    if (q[i] >= model.lower_limits()[i] && q[i] <= model.upper_limits()[i]) continue;
    throw models::ModelError(
        fmt::format("path: takes joint '{}' to {:.4g}; expected within [{:.4g}, {:.4g}]; another "
                    "posture may do",
                    model.position_names()[static_cast<std::size_t>(i)].text(), q[i],
                    model.lower_limits()[i], model.upper_limits()[i]));
  }
}

/// Moves the joints until the link's origin is at a point.
class TipSolver {
 public:
  TipSolver(const robot::RobotModel& model, int link)
      : model_(model),
        link_(link),
        X_WL_(static_cast<std::size_t>(model.num_links())),
        J_(3, model.num_positions()) {}

  /// Brings the tip to p_B from q: the way on which the joints move the least, or, where that leads
  /// beyond their limits or, as from a stretched arm, nowhere, to the nearest posture found.
  /// throws ModelError if there is none
  void MoveTo(const Vector3d& p_B, VectorXd& q) {
    VectorXd next = q;
    const double error = Solve(p_B, next, false);
    if (!Reaches(next, error)) {
      const std::optional<VectorXd> nearest = NearestFrom(p_B, q);
      if (!nearest) CheckJoints(model_, next, p_B, error);
      next = *nearest;
    }
    q = next;
  }

 private:
  std::optional<VectorXd> NearestFrom(const Vector3d& p_B, const VectorXd& q) {
    std::optional<VectorXd> nearest;
    double least = robot::kUnlimited;
    double spread = 0.0;
    for (int i = 0; i <= kStarts; ++i) {
      VectorXd next = q;
      for (Eigen::Index j = 0; j < q.size(); ++j) next[j] += random_.Uniform(-spread, spread);
      spread = i == 0 ? kNearestStart : kWidening * spread;
      const double error = Solve(p_B, next, true);
      const double change = (next - q).cwiseAbs().maxCoeff();
      if (!Reaches(next, error) || change >= least) continue;
      least = change;
      nearest = next;
    }
    return nearest;
  }

  bool Reaches(const VectorXd& q, double error) const {
    return error < kTolerance && (q.array() >= model_.lower_limits().array()).all() &&
           (q.array() <= model_.upper_limits().array()).all();
  }

  /// Changes q as little as each step needs, within the limits if it is `bound`; returns how far
  /// off the tip is in the end, m.
  double Solve(const Vector3d& p_B, VectorXd& q, bool bound) {
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
      if (bound) q = q.cwiseMax(model_.lower_limits()).cwiseMin(model_.upper_limits());
    }
    return error;
  }

  const robot::RobotModel& model_;
  const int link_;
  std::vector<Eigen::Isometry3d> X_WL_;
  Eigen::Matrix3Xd J_;
  models::Random random_{0};
};

void CheckJump(const robot::RobotModel& model, const VectorXd& before, const VectorXd& q,
               const Vector3d& p) {
  Eigen::Index joint = 0;
  const double jump = (q - before).cwiseAbs().maxCoeff(&joint);
  if (jump <= kLongestJump) return;
  throw models::ModelError(fmt::format(
      "path: at ({:.4g}, {:.4g}, {:.4g}) joint '{}' would have to jump by {:.3g}; "
      "expected a path that the posture before leads to; another posture may do",
      p.x(), p.y(), p.z(), model.position_names()[static_cast<std::size_t>(joint)].text(), jump));
}

}  // namespace

TipPath LinePath(const Vector3d& from, const Vector3d& to) {
  return [from, to](double s) -> Vector3d { return from + s * (to - from); };
}

TipPath CirclePath(const Vector3d& centre, const Vector3d& normal, double radius) {
  if (!(normal.norm() > 1e-9)) {
    throw models::ModelError("normal: got no direction; expected a vector that is not zero");
  }
  const Vector3d n = normal.normalized();
  const Vector3d up = std::abs(n.z()) > 0.999 ? Vector3d::UnitX() : Vector3d::UnitZ();
  const Vector3d u = (up - up.dot(n) * n).normalized();
  const Vector3d w = n.cross(u);
  return [centre, radius, u, w](double s) -> Vector3d {
    const double angle = 2.0 * std::numbers::pi * s;
    return centre + radius * (u * std::cos(angle) + w * std::sin(angle));
  };
}

std::vector<motion::KeyPoint> KeyPointsAlong(const robot::RobotModel& model, int link,
                                             const TipPath& path, const VectorXd& posture,
                                             const TipTiming& timing) {
  if (posture.size() != model.num_positions()) {
    throw models::ModelError(
        fmt::format("posture: got {} numbers; expected {}", posture.size(), model.num_positions()));
  }
  TipSolver solver(model, link);
  VectorXd q = posture;
  CheckJoints(model, q, path(0.0), 0.0);
  solver.MoveTo(path(0.0), q);
  const VectorXd first = q;
  std::vector<motion::KeyPoint> points;
  const auto add = [&](double time, const VectorXd& position) {
    points.push_back({.time = time, .position = position});
  };
  const int approach = static_cast<int>(std::ceil(timing.approach / kStep));
  for (int i = 0; i < approach; ++i) {
    const double x = static_cast<double>(i) / approach;
    add(timing.start + x * timing.approach, posture + Smooth(x) * (first - posture));
  }
  const int steps = static_cast<int>(std::ceil(timing.duration / kStep));
  for (int i = 0; i <= steps; ++i) {
    const double x = static_cast<double>(i) / steps;
    const Vector3d p = path(Smooth(x));
    const VectorXd before = q;
    solver.MoveTo(p, q);
    CheckJump(model, before, q, p);
    add(timing.start + timing.approach + x * timing.duration, q);
  }
  return points;
}

}  // namespace oca::planning
