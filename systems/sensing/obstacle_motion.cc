// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/sensing/rotation.h"

namespace oca::systems {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Refuses keys that a motion's type does not have, and the lack of those that it needs.
class Keys {
 public:
  Keys(const MotionParams& params, const std::string& where)
      : all_{{"velocity", params.velocity.has_value()},
             {"angular_velocity", params.angular_velocity.has_value()},
             {"start", params.start.has_value()},
             {"stop", params.stop.has_value()},
             {"amplitude", params.amplitude.has_value()},
             {"frequency", params.frequency.has_value()},
             {"phase", params.phase.has_value()},
             {"center", params.center.has_value()},
             {"axis", params.axis.has_value()},
             {"waypoints", params.waypoints.has_value()},
             {"file", params.file.has_value()}},
        type_(kMotionTypeNames[static_cast<int>(params.type)]),
        where_(where) {}

  void Check(const std::vector<std::string>& required,
             const std::vector<std::string>& optional = {}) const {
    const auto in = [](const std::vector<std::string>& keys, const std::string& key) {
      return std::find(keys.begin(), keys.end(), key) != keys.end();
    };
    for (const auto& [key, present] : all_) {
      if (!present && in(required, key)) {
        throw ConfigError(
            fmt::format("{}.{}: got none; expected one, motion {} needs it", where_, key, type_));
      }
      if (present && !in(required, key) && !in(optional, key)) {
        throw ConfigError(
            fmt::format("{}.{}: got a value; expected none in motion {}", where_, key, type_));
      }
    }
  }

 private:
  std::vector<std::pair<std::string, bool>> all_;
  std::string type_;
  std::string where_;
};

void CheckAllFinite(bool finite, const std::string& where) {
  if (!finite) throw ConfigError(where + ": got a NaN or an infinity; expected finite numbers");
}

double FiniteOr(const std::optional<double>& value, double otherwise, const std::string& where) {
  if (!value) return otherwise;
  CheckAllFinite(std::isfinite(*value), where);
  return *value;
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

Motion MakeLinear(const MotionParams& params, const Isometry3d& X_0, const std::string& where) {
  const Vector3d velocity = *params.velocity;
  Vector3d angular = Vector3d::Zero();
  if (params.angular_velocity) {
    const Eigen::VectorXd& given = params.angular_velocity->values();
    if (given.size() != 3) {
      throw ConfigError(fmt::format("{}.angular_velocity: got {}; expected a list of 3 numbers",
                                    where, given.size() == 1 ? "a number" : "another length"));
    }
    angular = given;
  }
  CheckAllFinite(velocity.allFinite() && angular.allFinite(), where);
  const double start = FiniteOr(params.start, 0.0, where + ".start");
  const double stop =
      FiniteOr(params.stop, std::numeric_limits<double>::infinity(), where + ".stop");
  if (!(start < stop)) {
    throw ConfigError(
        fmt::format("{}.stop: got {} s; expected more than start, {} s", where, stop, start));
  }
  const Quaterniond R_0(X_0.linear());
  const auto state = [=, p_0 = Vector3d(X_0.translation())](double time) -> MotionState {
    const double elapsed = std::clamp(time, start, stop) - start;
    const bool moves = time >= start && time < stop;
    return {PoseOf(p_0 + velocity * elapsed, Turned(angular * elapsed) * R_0),
            moves ? velocity : Vector3d::Zero(), moves ? angular : Vector3d::Zero()};
  };
  return {state, velocity.norm(), angular.norm()};
}

Motion MakeSinusoidal(const MotionParams& params, const Isometry3d& X_0, const std::string& where) {
  const Vector3d amplitude = *params.amplitude;
  const double frequency = *params.frequency;
  const double phase = FiniteOr(params.phase, 0.0, where + ".phase");
  CheckAllFinite(amplitude.allFinite() && std::isfinite(frequency), where);
  if (!(frequency > 0.0)) {
    throw ConfigError(fmt::format("{}.frequency: got {} Hz; expected > 0", where, frequency));
  }
  const double rate = 2.0 * std::numbers::pi * frequency;
  const auto state = [=](double time) -> MotionState {
    MotionState now;
    now.X_FO = X_0;
    now.X_FO.translation() += amplitude * std::sin(rate * time + phase);
    now.linear = amplitude * (rate * std::cos(rate * time + phase));
    return now;
  };
  return {state, rate * amplitude.norm(), 0.0};
}

Motion MakeCircular(const MotionParams& params, const Isometry3d& X_0, const std::string& where) {
  const PerComponent& given = *params.angular_velocity;
  if (!given.scalar()) {
    throw ConfigError(where + ".angular_velocity: got a list; expected a number, about the axis");
  }
  const Vector3d center = *params.center;
  CheckAllFinite(center.allFinite() && params.axis->allFinite() && std::isfinite(given[0]), where);
  if (params.axis->norm() == 0.0) {
    throw ConfigError(where + ".axis: got length 0; expected a direction");
  }
  const Vector3d angular = given[0] * params.axis->normalized();
  const Quaterniond R_0(X_0.linear());
  const Vector3d arm = X_0.translation() - center;
  const auto state = [=](double time) -> MotionState {
    const Quaterniond turn = Turned(angular * time);
    const Vector3d arm_now = turn * arm;
    return {PoseOf(center + arm_now, turn * R_0), angular.cross(arm_now), angular};
  };
  return {state, angular.cross(arm).norm(), angular.norm()};
}

/// A straight piece of a path, from one waypoint on.
struct Piece {
  double time;
  Vector3d p;
  Quaterniond rotation;
  Vector3d velocity;
  Vector3d angular;
};

std::vector<Piece> MakePieces(const std::vector<WaypointParams>& waypoints,
                              const Quaterniond& rotation, const std::string& where) {
  if (waypoints.empty()) {
    throw ConfigError(where + ": got an empty list; expected at least one waypoint");
  }
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const WaypointParams& point = waypoints[i];
    const std::string at = fmt::format("{}[{}]", where, i);
    CheckAllFinite(std::isfinite(point.time) && point.xyz.allFinite() &&
                       (!point.rpy || point.rpy->allFinite()),
                   at);
    if (point.rpy.has_value() != waypoints[0].rpy.has_value()) {
      throw ConfigError(at + ".rpy: got it in some waypoints; expected it in all or in none");
    }
    if (i > 0 && !(point.time > pieces.back().time)) {
      throw ConfigError(fmt::format("{}.time: got {} s; expected more than {} s, the one before",
                                    at, point.time, pieces.back().time));
    }
    pieces.push_back({point.time, point.xyz, point.rpy ? FromRollPitchYaw(*point.rpy) : rotation,
                      Vector3d::Zero(), Vector3d::Zero()});
  }
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    const double span = pieces[i + 1].time - pieces[i].time;
    pieces[i].velocity = (pieces[i + 1].p - pieces[i].p) / span;
    Quaterniond turn = pieces[i + 1].rotation * pieces[i].rotation.conjugate();
    if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();  // the shorter way round
    const Eigen::AngleAxisd arc(turn);
    pieces[i].angular = arc.axis() * (arc.angle() / span);
  }
  return pieces;
}

Motion MakePath(const std::vector<WaypointParams>& waypoints, const Isometry3d& X_0,
                const std::string& where) {
  const auto pieces = MakePieces(waypoints, Quaterniond(X_0.linear()), where);
  double fastest = 0.0, turning = 0.0;
  for (const Piece& piece : pieces) {
    fastest = std::max(fastest, piece.velocity.norm());
    turning = std::max(turning, piece.angular.norm());
  }
  const auto state = [pieces](double time) {
    const auto after =
        std::upper_bound(pieces.begin(), pieces.end(), time,
                         [](double t, const Piece& piece) { return t < piece.time; });
    if (after == pieces.begin()) {
      return MotionState{PoseOf(after->p, after->rotation), Vector3d::Zero(), Vector3d::Zero()};
    }
    const Piece& piece = *(after - 1);
    const double elapsed = time - piece.time;
    return MotionState{PoseOf(piece.p + piece.velocity * elapsed,
                              Turned(piece.angular * elapsed) * piece.rotation),
                       piece.velocity, piece.angular};
  };
  return {state, fastest, turning};
}

}  // namespace

void WaypointParams::Describe(Fields<WaypointParams>& fields) {
  fields.Add("time", &WaypointParams::time, "s", "when the obstacle is there").Required();
  fields.Add("xyz", &WaypointParams::xyz, "m", "position").Required();
  fields.Add("rpy", &WaypointParams::rpy, "rad", "roll, pitch, yaw; in all waypoints or in none");
}

void MotionParams::Describe(Fields<MotionParams>& fields) {
  using P = MotionParams;
  fields.Add("type", &P::type, "", "static, linear, sinusoidal, circular, waypoints or csv")
      .Required();
  fields.Add("velocity", &P::velocity, "m/s", "linear: of the origin");
  fields.Add("angular_velocity", &P::angular_velocity, "rad/s",
             "linear: a vector; circular: a number, about the axis");
  fields.Add("start", &P::start, "s", "linear: when it starts to move; 0 if left out");
  fields.Add("stop", &P::stop, "s", "linear: when it stops; never if left out");
  fields.Add("amplitude", &P::amplitude, "m", "sinusoidal: largest offset from the pose");
  fields.Add("frequency", &P::frequency, "Hz", "sinusoidal").Above(0.0);
  fields.Add("phase", &P::phase, "rad", "sinusoidal: at time 0");
  fields.Add("center", &P::center, "m", "circular: a point of the axis");
  fields.Add("axis", &P::axis, "", "circular: direction of the axis");
  fields.Add("waypoints", &P::waypoints, "", "waypoints: in the order of their times");
  fields.Add("file", &P::file, "", "csv: table with columns time,x,y,z[,roll,pitch,yaw]");
}

Motion MakeMotion(const MotionParams& params, const Isometry3d& X_0, const std::string& where) {
  const Keys keys(params, where);
  switch (params.type) {
    case MotionType::kStatic:
      keys.Check({});
      break;
    case MotionType::kLinear:
      keys.Check({"velocity"}, {"angular_velocity", "start", "stop"});
      return MakeLinear(params, X_0, where);
    case MotionType::kSinusoidal:
      keys.Check({"amplitude", "frequency"}, {"phase"});
      return MakeSinusoidal(params, X_0, where);
    case MotionType::kCircular:
      keys.Check({"center", "axis", "angular_velocity"});
      return MakeCircular(params, X_0, where);
    case MotionType::kWaypoints:
      keys.Check({"waypoints"});
      return MakePath(*params.waypoints, X_0, where + ".waypoints");
    case MotionType::kCsv:
      keys.Check({"file"});
      return MakePath(ReadWaypoints(*params.file), X_0, *params.file);
  }
  return {[X_0](double) -> MotionState {
            return {X_0, Vector3d::Zero(), Vector3d::Zero()};
          },
          0.0, 0.0};
}

}  // namespace oca::systems
