// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/obstacle_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "oca/systems/signals/config_errors.h"

namespace oca::systems {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using motion::ScriptedMotion;

/// Refuses keys that a motion's type does not have, and the lack of those that it needs.
class Keys {
 public:
  Keys(const MotionParams& params, const std::string& where)
      : all_{{"velocity", params.velocity.has_value()},
             {"angular_velocity", params.angular_velocity.has_value()},
             {"acceleration", params.acceleration.has_value()},
             {"start", params.start.has_value()},
             {"stop", params.stop.has_value()},
             {"amplitude", params.amplitude.has_value()},
             {"frequency", params.frequency.has_value()},
             {"phase", params.phase.has_value()},
             {"center", params.center.has_value()},
             {"axis", params.axis.has_value()},
             {"waypoints", params.waypoints.has_value()},
             {"file", params.file.has_value()},
             {"smooth", params.smooth.has_value()}},
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

/// Zero if none is given.
Vector3d AngularOf(const MotionParams& params, const std::string& where) {
  if (!params.angular_velocity) return Vector3d::Zero();
  const Eigen::VectorXd& given = params.angular_velocity->values();
  if (given.size() == 3) return given;
  throw ConfigError(fmt::format("{}.angular_velocity: got {}; expected a list of 3 numbers", where,
                                given.size() == 1 ? "a number" : "another length"));
}

ScriptedMotion MakeLinear(const MotionParams& params, const Isometry3d& X_0,
                          const std::string& where) {
  const motion::LinearScript script{*params.velocity, AngularOf(params, where),
                                    params.start.value_or(0.0), params.stop};
  return motion::MakeMotion(script, X_0, where);
}

ScriptedMotion MakeTurning(const MotionParams& params, const Isometry3d& X_0,
                           const std::string& where) {
  const motion::TurningScript script{*params.velocity, AngularOf(params, where),
                                     params.start.value_or(0.0), params.stop};
  return motion::MakeMotion(script, X_0, where);
}

ScriptedMotion MakeAccelerating(const MotionParams& params, const Isometry3d& X_0,
                                const std::string& where) {
  const motion::AcceleratingScript script{params.velocity.value_or(Vector3d::Zero()),
                                          *params.acceleration, params.start.value_or(0.0),
                                          *params.stop};
  return motion::MakeMotion(script, X_0, where);
}

ScriptedMotion MakeCircular(const MotionParams& params, const Isometry3d& X_0,
                            const std::string& where) {
  const PerComponent& given = *params.angular_velocity;
  if (!given.scalar()) {
    throw ConfigError(where + ".angular_velocity: got a list; expected a number, about the axis");
  }
  return motion::MakeMotion(motion::CircularScript{*params.center, *params.axis, given[0]}, X_0,
                            where);
}

ScriptedMotion MakeSinusoidal(const MotionParams& params, const Isometry3d& X_0,
                              const std::string& where) {
  const motion::SinusoidalScript script{*params.amplitude, *params.frequency,
                                        params.phase.value_or(0.0)};
  return motion::MakeMotion(script, X_0, where);
}

std::vector<motion::Waypoint> WaypointsOf(const std::vector<WaypointParams>& params) {
  std::vector<motion::Waypoint> waypoints;
  for (const WaypointParams& point : params) {
    waypoints.push_back({point.time, point.xyz, point.rpy});
  }
  return waypoints;
}

motion::Pace PaceOf(const MotionParams& params) {
  return params.smooth.value_or(false) ? motion::Pace::kSmooth : motion::Pace::kEven;
}

ScriptedMotion MakeOfType(const MotionParams& params, const Isometry3d& X_0,
                          const std::string& where) {
  const Keys keys(params, where);
  switch (params.type) {
    case MotionType::kStatic:
      keys.Check({});
      break;
    case MotionType::kLinear:
      keys.Check({"velocity"}, {"angular_velocity", "start", "stop"});
      return MakeLinear(params, X_0, where);
    case MotionType::kTurning:
      keys.Check({"velocity", "angular_velocity"}, {"start", "stop"});
      return MakeTurning(params, X_0, where);
    case MotionType::kAccelerating:
      keys.Check({"acceleration", "stop"}, {"velocity", "start"});
      return MakeAccelerating(params, X_0, where);
    case MotionType::kSinusoidal:
      keys.Check({"amplitude", "frequency"}, {"phase"});
      return MakeSinusoidal(params, X_0, where);
    case MotionType::kCircular:
      keys.Check({"center", "axis", "angular_velocity"});
      return MakeCircular(params, X_0, where);
    case MotionType::kWaypoints:
      keys.Check({"waypoints"}, {"smooth"});
      return motion::MakeMotion(WaypointsOf(*params.waypoints), X_0, where + ".waypoints",
                                PaceOf(params));
    case MotionType::kCsv:
      keys.Check({"file"}, {"smooth"});
      return motion::MakeMotion(motion::ReadWaypoints(*params.file), X_0, *params.file,
                                PaceOf(params));
  }
  return motion::StandingMotion(X_0);
}

}  // namespace

void WaypointParams::Describe(Fields<WaypointParams>& fields) {
  fields.Add("time", &WaypointParams::time, "s", "when the obstacle is there").Required();
  fields.Add("xyz", &WaypointParams::xyz, "m", "position").Required();
  fields.Add("rpy", &WaypointParams::rpy, "rad", "roll, pitch, yaw; in all waypoints or in none");
}

void MotionParams::Describe(Fields<MotionParams>& fields) {
  using P = MotionParams;
  fields
      .Add("type", &P::type, "",
           "static, linear, turning, accelerating, sinusoidal, circular, waypoints or csv")
      .Required();
  fields.Add("velocity", &P::velocity, "m/s",
             "linear: of the origin; turning, accelerating: at the start");
  fields.Add("angular_velocity", &P::angular_velocity, "rad/s",
             "linear, turning: a vector; circular: a number, about the axis");
  fields.Add("acceleration", &P::acceleration, "m/s^2", "accelerating: until `stop`");
  fields.Add("start", &P::start, "s",
             "linear, turning, accelerating: when it starts to move; 0 if left out");
  fields.Add(
      "stop", &P::stop, "s",
      "linear, turning: when it stops, never if left out; accelerating: from when on it goes "
      "on as fast as then");
  fields.Add("amplitude", &P::amplitude, "m", "sinusoidal: largest offset from the pose");
  fields.Add("frequency", &P::frequency, "Hz", "sinusoidal").Above(0.0);
  fields.Add("phase", &P::phase, "rad", "sinusoidal: at time 0");
  fields.Add("center", &P::center, "m", "circular: a point of the axis");
  fields.Add("axis", &P::axis, "", "circular: direction of the axis");
  fields.Add("waypoints", &P::waypoints, "", "waypoints: in the order of their times");
  fields.Add("smooth", &P::smooth, "",
             "waypoints, csv: from rest to rest, with the least jerk; false if left out");
  fields.Add("file", &P::file, "", "csv: table with columns time,x,y,z[,roll,pitch,yaw]");
}

ScriptedMotion MakeMotion(const MotionParams& params, const Isometry3d& X_0,
                          const std::string& where) {
  return WithConfigErrors([&] { return MakeOfType(params, X_0, where); });
}

}  // namespace oca::systems
