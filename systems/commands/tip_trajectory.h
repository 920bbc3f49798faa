// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/models/motion/key_points.h"
#include "oca/systems/commands/posture.h"
#include "oca/systems/commands/trajectory_source.h"
#include "oca/systems/signals/model_set.h"

namespace oca::systems {

enum class TipPath { kLine, kCircle };
inline std::span<const char* const> EnumNames(TipPath) {
  static constexpr std::array kNames{"line", "circle"};
  return kNames;
}

/// How TipTrajectory is parameterised.
struct TipRequest {
  static constexpr SystemDoc kDoc{
      "requested motion: the tip draws a line or a circle",
      "p_tip(q(t)) = from + s (to - from), or centre + radius (u cos 2 pi s + w sin 2 pi s)",
      "Siciliano, Sciavicco, Villani, Oriolo, Robotics, section 3.5"};
  struct Params {
    std::string model{};
    std::string link{};
    TipPath path{TipPath::kLine};
    std::optional<Eigen::Vector3d> from{};
    std::optional<Eigen::Vector3d> to{};
    std::optional<Eigen::Vector3d> centre{};
    std::optional<Eigen::Vector3d> normal{};
    std::optional<double> radius{};
    Posture posture{};
    double start{0.0};
    double approach{3.0};
    double duration{10.0};
    Period period{};
    std::string unit{"rad"};
    static void Describe(Fields<Params>& fields);

    std::vector<motion::KeyPoint>
        points{};  ///< what Resolved made of all this; no parameter of files
  };
  static Params Example();
  static Params Resolved(Params params, const ModelSet& models);
  static Params Checked(Params params);
  static motion::Trajectory MakeTrajectory(const Params& params);
};

/// The requested motion of joints whose tip, the origin of `link`, draws a line or a circle in the
/// base frame of the robot; its orientation is free.
///
/// From `start` on the joints go within `approach` from `posture` to the path's first point, then
/// within `duration` along the path, from rest to rest, by planning::KeyPointsAlong. A circle
/// starts where it is nearest to z and goes round once, counter-clockwise about the normal
/// (planning::CirclePath). The key points, every 0.02 s, are joined by a spline with continuous
/// acceleration: between them the tip is off by some 1e-6 m.
///
/// Ports and `period` are those of TrajectorySource. All is computed when the system is made.
/// throws ConfigError for a path that is not wholly given, leaves the robot's reach or would take a
///        joint beyond its limits; a posture of the wrong length; times that are not positive
using TipTrajectory = TrajectorySource<TipRequest>;

}  // namespace oca::systems
