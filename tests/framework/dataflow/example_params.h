// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"

namespace oca {

enum class Method { kTranspose, kDamped };
inline std::span<const char* const> EnumNames(Method) {
  static constexpr const char* kNames[] = {"transpose", "damped"};
  return kNames;
}

struct Waypoint {
  double time{0.0};
  double position{0.125};
  static void Describe(Fields<Waypoint>& fields) {
    fields.Add("time", &Waypoint::time, "s", "when").Required().AtLeast(0.0);
    fields.Add("position", &Waypoint::position, "rad", "where");
  }
};

/// A field of every type there is.
struct Everything {
  double gain{0.5};
  int count{0};
  bool enabled{false};
  std::string name{"\"quoted\""};
  Method method{Method::kTranspose};
  Period period{1, 100};
  PerComponent limit{1.5};
  Eigen::VectorXd weights{Eigen::VectorXd::Ones(2)};
  Eigen::Vector3d axis{Eigen::Vector3d::UnitX()};
  std::vector<Waypoint> waypoints{{1.0, 2.0}};
  std::vector<std::vector<std::string>> ignore{};
  Waypoint start{};
  std::optional<double> ceiling{};
  double reach{std::numeric_limits<double>::infinity()};
  PerComponent unset{std::numeric_limits<double>::quiet_NaN()};

  static void Describe(Fields<Everything>& fields) {
    using E = Everything;
    fields.Add("gain", &E::gain, "N m^2", "how strong").AtLeast(0.0).AtMost(10.0);
    fields.Add("count", &E::count, "", "how many").Required().AtLeast(1.0);
    fields.Add("enabled", &E::enabled, "", "whether");
    fields.Add("name", &E::name, "", "of what");
    fields.Add("method", &E::method, "", "which way");
    fields.Add("period", &E::period, "s", "how often").Above(0.0);
    fields.Add("limit", &E::limit, "rad/s", "how fast").Above(0.0).AtMost(5.0);
    fields.Add("weights", &E::weights, "", "how heavy");
    fields.Add("axis", &E::axis, "", "about what");
    fields.Add("waypoints", &E::waypoints, "", "by where");
    fields.Add("ignore", &E::ignore, "", "without what");
    fields.Add("start", &E::start, "", "from where");
    fields.Add("ceiling", &E::ceiling, "", "how high");
    fields.Add("reach", &E::reach, "m", "how far");
    fields.Add("unset", &E::unset, "m", "nothing yet");
  }
};

}  // namespace oca
