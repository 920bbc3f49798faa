// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/systems/commands/key_points.h"
#include "oca/systems/commands/pose_goal.h"
#include "oca/systems/commands/trajectory_source.h"
#include "oca/systems/signals/model_set.h"

namespace oca::systems {

enum class SplineKind { kCubic, kQuintic, kC2 };
enum class SplineEnds { kClamped, kNatural };
std::span<const char* const> EnumNames(SplineKind);
std::span<const char* const> EnumNames(SplineEnds);

/// How SplineGenerator is parameterised.
struct SplineRequest {
  static constexpr SystemDoc kDoc{"requested motion: a spline through key points",
                                  "position(t) = sum_k c_k ((t - t_i) / (t_{i+1} - t_i))^k",
                                  "De Boor, A Practical Guide to Splines, chapter IV"};
  struct Params {
    SplineKind kind{SplineKind::kCubic};
    SplineEnds ends{SplineEnds::kClamped};
    std::vector<KeyPointParams> key_points{};
    std::string file{};
    std::vector<std::string> joints{};
    std::optional<PoseGoalParams> goal{};
    std::string model{};
    Period period{};
    std::string unit{"rad"};
    static void Describe(Fields<Params>& fields);

    std::vector<motion::KeyPoint> points{};  ///< made of all this; no parameter of files
  };
  static Params Example();
  /// With the points that a robot of the file tells the meaning of, the goal as one more.
  static Params Resolved(Params params, const ModelSet& models);
  static Params Checked(Params params);
  static motion::Trajectory MakeTrajectory(const Params& params);
};

/// The requested motion: a spline through key points.
///
/// `kind`  cubic    meets velocities (absent: 0, so it rests at the point); velocity continuous
///         quintic  meets velocities and accelerations (absent: 0); acceleration continuous
///         c2       cubic spline with continuous acceleration; `ends` clamped meets the velocities
///                  of the first and last point (absent: 0), natural has no acceleration there
///
/// `position` of a key point is a number a joint; or, of the robot that `model` names, a state of
/// its SRDF or some joints by name: the others are as in the point before, in the first one at 0 or
/// the limit nearest to it.
///
/// `goal` is a pose of a link of `model`, in place of a last key point: the joints that reach it
/// are found when the system is made, from those of the key point before, where the spline starts
/// if it is the only one. pose_goal.h says which of them.
///
/// Before the first key point it holds the first position, after the last one the last, with zero
/// rates. `period` 0: the outputs are functions of time. `period` > 0: sampled and held; within
/// [t_k, t_k + period) the outputs are those of t_k + period, what a controller should have
/// reached when the period ends; before the first tick they are those of time 0.
///
/// in    -
/// out   position      n  u
///       velocity      n  u/s
///       acceleration  n  u/s^2
///       goal          n  u      position of the last key point
/// state position, velocity, acceleration  n   if sampled
/// throws ConfigError if the key points are none, not in order of time, of different lengths, not
///        finite, or tell what `kind` cannot meet; if the file cannot be read; if period < 0; if
///        the goal is out of reach, without a key point before or a model
/// source report section 3.4; formulas in models/motion/trajectory.h
using SplineGenerator = TrajectorySource<SplineRequest>;

}  // namespace oca::systems
