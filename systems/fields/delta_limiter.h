// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// Limits how fast the delta changes, so that the motion asked of the joints stays feasible:
///
///     x_k = x_{k-1} + clamp(delta - x_{k-1}, -step, step),   step = max_joint_velocity * period
///
/// every `period`, starting at x = 0. With `mode: direction` the whole change shrinks instead, by
/// the least factor that keeps every joint within its step, so that the delta moves straight
/// towards where it should be. The change is measured against the previous *limited* delta, so the
/// way back to zero is limited like the way out. If not `enabled`: x_k = delta. The output is the
/// state itself: it stays within a period, and it breaks the loop through the robot.
///
/// in    delta          n  u      raw delta
/// out   limited_delta  n  u      x, held since the last update
/// state x              n  u
/// throws ConfigError if max_joint_velocity or period is not positive
/// source report section 3.4 end; docs/theory.md, Limiter and overlay
class DeltaLimiter final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "limits the rate of the delta that avoidance adds to a trajectory",
      "limited_delta += clamp(delta - limited_delta, +-max_joint_velocity * period)",
      "Jain, Sixt, Exner 2016, section 3.4"};
  enum class Mode { kPerJoint, kDirection };
  friend std::span<const char* const> EnumNames(Mode) {
    static constexpr std::array kNames{"per_joint", "direction"};
    return kNames;
  }
  struct Params {
    PerComponent max_joint_velocity{0.6};
    Period period{};
    bool enabled{true};
    Mode mode{Mode::kPerJoint};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.max_joint_velocity = 0.6, .period = Period(1, 100)}; }

  explicit DeltaLimiter(const Params& params);

 private:
  const Params params_;
  const Size size_;
  const Unit unit_;
  const DiscreteState<Vector> x_;
  void Shrink(VectorView delta_value, VectorView x, MutableVectorView next) const;
  void Update(VectorView delta_value, VectorView x, MutableVectorView next) const;

 public:
  const Input<Vector> delta;
  const Output<Vector> limited_delta;
};

}  // namespace oca::systems
