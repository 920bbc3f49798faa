// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "framework/params.h"
#include "framework/system.h"
#include "systems/key_points.h"
#include "systems/trajectory.h"

namespace oca::systems {

enum class SplineKind { kCubic, kQuintic, kC2 };
std::span<const char* const> EnumNames(SplineKind);
std::span<const char* const> EnumNames(Trajectory::Ends);

/// The requested motion: a spline through key points.
///
/// `kind`  cubic    meets velocities (absent: 0, so it rests at the point); velocity continuous
///         quintic  meets velocities and accelerations (absent: 0); acceleration continuous
///         c2       cubic spline with continuous acceleration; `ends` clamped meets the velocities
///                  of the first and last point (absent: 0), natural has no acceleration there
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
///        finite, or tell what `kind` cannot meet; if the file cannot be read; if period < 0
/// source report section 3.4; formulas in trajectory.h
class SplineGenerator final : public System {
 public:
  static constexpr SystemDoc kDoc{"requested motion: a spline through key points",
                                  "position(t) = sum_k c_k ((t - t_i) / (t_{i+1} - t_i))^k",
                                  "De Boor, A Practical Guide to Splines, chapter IV"};
  struct Params {
    SplineKind kind{SplineKind::kCubic};
    Trajectory::Ends ends{Trajectory::Ends::kClamped};
    std::vector<KeyPoint> key_points{};
    std::string file{};
    Period period{};
    std::string unit{"rad"};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example();

  explicit SplineGenerator(const Params& params);

 private:
  const Params params_;
  const Trajectory trajectory_;
  const PortSpec spec_;       ///< of the position
  const PortSpec rate_spec_;  ///< of the velocity
  const PortSpec rate_rate_spec_;
  const DiscreteState<Vector> sampled_position_;  ///< this and the next two if sampled
  const DiscreteState<Vector> sampled_velocity_;
  const DiscreteState<Vector> sampled_acceleration_;

  DiscreteState<Vector> DeclareSample(const char* name, const PortSpec& spec, int derivative);
  template <auto kMethod>
  Output<Vector> DeclareMotion(const char* name, const PortSpec& spec,
                               const DiscreteState<Vector>& sampled);
  void CalcPosition(double time, MutableVectorView out) const;
  void CalcVelocity(double time, MutableVectorView out) const;
  void CalcAcceleration(double time, MutableVectorView out) const;
  void CalcGoal(MutableVectorView out) const;
  void Sample(double time, MutableVectorView next_position, MutableVectorView next_velocity,
              MutableVectorView next_acceleration) const;

 public:
  const Output<Vector> position;
  const Output<Vector> velocity;
  const Output<Vector> acceleration;
  const Output<Vector> goal;
};

}  // namespace oca::systems
