// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/systems/commands/key_points.h"
#include "oca/systems/commands/trajectory_source.h"

namespace oca::systems {

/// How LinearInterpolator is parameterised.
struct LinearRequest {
  static constexpr SystemDoc kDoc{"requested motion: straight lines between key points",
                                  "position = p_i + (p_{i+1} - p_i) (t - t_i) / (t_{i+1} - t_i)",
                                  "Jain, Sixt, Exner 2016, fake controller"};
  struct Params {
    std::vector<KeyPointParams> key_points{};
    std::string file{};
    std::vector<std::string> joints{};
    std::string model{};
    Period period{};
    std::string unit{"rad"};
    static void Describe(Fields<Params>& fields);

    std::vector<motion::KeyPoint> points{};  ///< made of all this; no parameter of files
  };
  static Params Example();
  /// With the points that a robot of the file tells the meaning of.
  static Params Resolved(Params params, const ModelSet& models);
  static Params Checked(Params params);
  static motion::Trajectory MakeTrajectory(const Params& params);
};

/// The requested motion of the report's fake controller: straight lines between key points.
///
///     position = p_i + (p_{i+1} - p_i) (t - t_i) / (t_{i+1} - t_i)
///
/// The velocity is constant between key points, the acceleration 0. Ports, holding at the ends and
/// sampling with `period` are those of SplineGenerator, so that one may replace the other; the
/// velocities and accelerations of key points are accepted and not used.
///
/// in    -
/// out   position      n  u
///       velocity      n  u/s
///       acceleration  n  u/s^2  0
///       goal          n  u      position of the last key point
/// state position, velocity, acceleration  n   if sampled
/// throws ConfigError if the key points are none, not in order of time, of different lengths or
///        not finite; if the file cannot be read; if period < 0
/// source report section 4.1 (fake controller)
using LinearInterpolator = TrajectorySource<LinearRequest>;

}  // namespace oca::systems
