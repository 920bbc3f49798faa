// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/motion/scripted_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "oca/models/error.h"
#include "oca/models/geometry/rotation.h"

namespace oca::motion {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

void CheckAllFinite(bool finite, const std::string& where) {
  if (!finite)
    throw models::ModelError(where + ": got a NaN or an infinity; expected finite numbers");
}

Quaterniond Turned(const Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0.0) return Quaterniond::Identity();
  return Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

Isometry3d PoseOf(const Vector3d& p, const Quaterniond& rotation) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = p;
  pose.linear() = rotation.toRotationMatrix();
  return pose;
}

void CheckSpan(double start, double stop, const std::string& where) {
  CheckAllFinite(std::isfinite(start), where + ".start");
  CheckAllFinite(!std::isnan(stop), where + ".stop");
  if (start < stop) return;
  throw models::ModelError(
      fmt::format("{}.stop: got {} s; expected more than start, {} s", where, stop, start));
}

/// Share of the way, and of its speed if even, at a share of the time.
struct Progress {
  double way;
  double rate;
};
Progress At(double x, Pace pace) {
  if (pace == Pace::kEven) return {x, 1.0};
  return {x * x * x * (10.0 - 15.0 * x + 6.0 * x * x), 30.0 * x * x * (1.0 - x) * (1.0 - x)};
}

/// A straight piece of a path, from one waypoint on.
struct Piece {
  double time;
  double span;  ///< s; of the last one infinite
  Vector3d p;
  Quaterniond rotation;
  Vector3d velocity;
  Vector3d angular;
};

std::vector<Piece> MakePieces(const std::vector<Waypoint>& waypoints, const Quaterniond& rotation,
                              const std::string& where) {
  if (waypoints.empty()) {
    throw models::ModelError(where + ": got an empty list; expected at least one waypoint");
  }
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const Waypoint& point = waypoints[i];
    const std::string at = fmt::format("{}[{}]", where, i);
    CheckAllFinite(std::isfinite(point.time) && point.xyz.allFinite() &&
                       (!point.rpy || point.rpy->allFinite()),
                   at);
    if (point.rpy.has_value() != waypoints[0].rpy.has_value()) {
      throw models::ModelError(at +
                               ".rpy: got it in some waypoints; expected it in all or in none");
    }
    if (i > 0 && !(point.time > pieces.back().time)) {
      throw models::ModelError(
          fmt::format("{}.time: got {} s; expected more than {} s, the one before", at, point.time,
                      pieces.back().time));
    }
    pieces.push_back({point.time, std::numeric_limits<double>::infinity(), point.xyz,
                      point.rpy ? geometry::FromRollPitchYaw(*point.rpy) : rotation,
                      Vector3d::Zero(), Vector3d::Zero()});
  }
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    const double span = pieces[i + 1].time - pieces[i].time;
    pieces[i].span = span;
    pieces[i].velocity = (pieces[i + 1].p - pieces[i].p) / span;
    Quaterniond turn = pieces[i + 1].rotation * pieces[i].rotation.conjugate();
    if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();  // the shorter way round
    const Eigen::AngleAxisd arc(turn);
    pieces[i].angular = arc.axis() * (arc.angle() / span);
  }
  return pieces;
}

}  // namespace

ScriptedMotion StandingMotion(const Isometry3d& X_0) {
  return {[X_0](double) -> BodyState {
            return {X_0, Vector3d::Zero(), Vector3d::Zero()};
          },
          0.0, 0.0};
}

ScriptedMotion MakeMotion(const LinearScript& script, const Isometry3d& X_0,
                          const std::string& where) {
  const Vector3d velocity = script.velocity;
  const Vector3d angular = script.angular_velocity;
  CheckAllFinite(velocity.allFinite() && angular.allFinite(), where);
  CheckAllFinite(!script.stop || std::isfinite(*script.stop), where + ".stop");
  const double start = script.start;
  const double stop = script.stop.value_or(std::numeric_limits<double>::infinity());
  CheckSpan(start, stop, where);
  const Quaterniond R_0(X_0.linear());
  const auto state = [=, p_0 = Vector3d(X_0.translation())](double time) -> BodyState {
    const double elapsed = std::clamp(time, start, stop) - start;
    const bool moves = time >= start && time < stop;
    return {PoseOf(p_0 + velocity * elapsed, Turned(angular * elapsed) * R_0),
            moves ? velocity : Vector3d::Zero(), moves ? angular : Vector3d::Zero()};
  };
  return {state, velocity.norm(), angular.norm()};
}

ScriptedMotion MakeMotion(const TurningScript& script, const Isometry3d& X_0,
                          const std::string& where) {
  const Vector3d v = script.velocity;
  const Vector3d w = script.angular_velocity;
  CheckAllFinite(v.allFinite() && w.allFinite(), where);
  CheckAllFinite(!script.stop || std::isfinite(*script.stop), where + ".stop");
  const double start = script.start;
  const double stop = script.stop.value_or(std::numeric_limits<double>::infinity());
  CheckSpan(start, stop, where);
  const double rate = w.norm();
  const Quaterniond R_0(X_0.linear());
  const auto state = [=, p_0 = Vector3d(X_0.translation())](double time) -> BodyState {
    const double s = std::clamp(time, start, stop) - start;
    const bool moves = time >= start && time < stop;
    const double angle = rate * s;
    // The integrals of sin and 1 - cos, by their series where these would cancel.
    const bool little = angle < 1e-3;
    const double sideways = little ? 0.5 * s * s * (1.0 - angle * angle / 12.0)
                                   : (1.0 - std::cos(angle)) / (rate * rate);
    const double back = little ? s * s * s / 6.0 * (1.0 - angle * angle / 20.0)
                               : (angle - std::sin(angle)) / (rate * rate * rate);
    const Vector3d p = p_0 + s * v + sideways * w.cross(v) + back * w.cross(w.cross(v));
    const Quaterniond turn = Turned(w * s);
    return {PoseOf(p, turn * R_0), moves ? Vector3d(turn * v) : Vector3d::Zero(),
            moves ? w : Vector3d::Zero()};
  };
  return {state, v.norm(), rate};
}

ScriptedMotion MakeMotion(const AcceleratingScript& script, const Isometry3d& X_0,
                          const std::string& where) {
  const Vector3d v = script.velocity;
  const Vector3d a = script.acceleration;
  CheckAllFinite(v.allFinite() && a.allFinite(), where);
  CheckAllFinite(std::isfinite(script.stop), where + ".stop");
  CheckSpan(script.start, script.stop, where);
  const double start = script.start;
  const double span = script.stop - start;
  const auto state = [=](double time) -> BodyState {
    BodyState now;
    now.X_FO = X_0;
    if (time < start) return now;
    const double s = std::min(time - start, span);
    const double after = time - start - s;
    now.linear = v + s * a;
    now.X_FO.translation() += s * v + 0.5 * s * s * a + after * now.linear;
    return now;
  };
  return {state, std::max(v.norm(), (v + span * a).norm()), 0.0};
}

ScriptedMotion MakeMotion(const SinusoidalScript& script, const Isometry3d& X_0,
                          const std::string& where) {
  const Vector3d amplitude = script.amplitude;
  const double phase = script.phase;
  CheckAllFinite(std::isfinite(phase), where + ".phase");
  CheckAllFinite(amplitude.allFinite() && std::isfinite(script.frequency), where);
  if (!(script.frequency > 0.0)) {
    throw models::ModelError(
        fmt::format("{}.frequency: got {} Hz; expected > 0", where, script.frequency));
  }
  const double rate = 2.0 * std::numbers::pi * script.frequency;
  const auto state = [=](double time) -> BodyState {
    BodyState now;
    now.X_FO = X_0;
    now.X_FO.translation() += amplitude * std::sin(rate * time + phase);
    now.linear = amplitude * (rate * std::cos(rate * time + phase));
    return now;
  };
  return {state, rate * amplitude.norm(), 0.0};
}

ScriptedMotion MakeMotion(const CircularScript& script, const Isometry3d& X_0,
                          const std::string& where) {
  const Vector3d center = script.center;
  CheckAllFinite(
      center.allFinite() && script.axis.allFinite() && std::isfinite(script.angular_velocity),
      where);
  if (script.axis.norm() == 0.0) {
    throw models::ModelError(where + ".axis: got length 0; expected a direction");
  }
  const Vector3d angular = script.angular_velocity * script.axis.normalized();
  const Quaterniond R_0(X_0.linear());
  const Vector3d arm = X_0.translation() - center;
  const auto state = [=](double time) -> BodyState {
    const Quaterniond turn = Turned(angular * time);
    const Vector3d arm_now = turn * arm;
    return {PoseOf(center + arm_now, turn * R_0), angular.cross(arm_now), angular};
  };
  return {state, angular.cross(arm).norm(), angular.norm()};
}

ScriptedMotion MakeMotion(const std::vector<Waypoint>& waypoints, const Isometry3d& X_0,
                          const std::string& where, Pace pace) {
  const auto pieces = MakePieces(waypoints, Quaterniond(X_0.linear()), where);
  double fastest = 0.0, turning = 0.0;
  for (const Piece& piece : pieces) {
    fastest = std::max(fastest, piece.velocity.norm());
    turning = std::max(turning, piece.angular.norm());
  }
  const auto state = [pieces, pace](double time) {
    const auto after =
        std::upper_bound(pieces.begin(), pieces.end(), time,
                         [](double t, const Piece& piece) { return t < piece.time; });
    if (after == pieces.begin()) {
      return BodyState{PoseOf(after->p, after->rotation), Vector3d::Zero(), Vector3d::Zero()};
    }
    const Piece& piece = *(after - 1);
    double elapsed = time - piece.time;
    double rate = 1.0;
    if (pace == Pace::kSmooth && std::isfinite(piece.span)) {
      const Progress progress = At(elapsed / piece.span, pace);
      elapsed = progress.way * piece.span;
      rate = progress.rate;
    }
    return BodyState{PoseOf(piece.p + piece.velocity * elapsed,
                            Turned(piece.angular * elapsed) * piece.rotation),
                     rate * piece.velocity, rate * piece.angular};
  };
  const double most = pace == Pace::kSmooth ? At(0.5, pace).rate : 1.0;
  return {state, most * fastest, most * turning};
}

}  // namespace oca::motion
