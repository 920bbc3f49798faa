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

ScriptedMotion MakeLinear(const MotionParams& params, const Isometry3d& X_0,
                          const std::string& where) {
  Vector3d angular = Vector3d::Zero();
  if (params.angular_velocity) {
    const Eigen::VectorXd& given = params.angular_velocity->values();
    if (given.size() != 3) {
      throw ConfigError(fmt::format("{}.angular_velocity: got {}; expected a list of 3 numbers",
                                    where, given.size() == 1 ? "a number" : "another length"));
    }
    angular = given;
  }
  const motion::LinearScript script{*params.velocity, angular, params.start.value_or(0.0),
                                    params.stop};
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
    case MotionType::kSinusoidal:
      keys.Check({"amplitude", "frequency"}, {"phase"});
      return MakeSinusoidal(params, X_0, where);
    case MotionType::kCircular:
      keys.Check({"center", "axis", "angular_velocity"});
      return MakeCircular(params, X_0, where);
    case MotionType::kWaypoints:
      keys.Check({"waypoints"});
      return motion::MakeMotion(WaypointsOf(*params.waypoints), X_0, where + ".waypoints");
    case MotionType::kCsv:
      keys.Check({"file"});
      return motion::MakeMotion(motion::ReadWaypoints(*params.file), X_0, *params.file);
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

ScriptedMotion MakeMotion(const MotionParams& params, const Isometry3d& X_0,
                          const std::string& where) {
  return WithConfigErrors([&] { return MakeOfType(params, X_0, where); });
}

}  // namespace oca::systems
