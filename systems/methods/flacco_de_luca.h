// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/filtered_inverse.h"
#include "oca/systems/methods/velocity_methods.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Flacco and De Luca's avoidance, as a baseline: obstacles repulse the tip, and take speed from
/// the joints that would lead the rest of the arm to them.
///
///     risk(d) = 1 / (1 + exp(alpha (2 d / influence_distance - 1)))
///     v = repulsion_speed risk(d) direction            at the control point of a repulsed link
///     upper_j = V_j (1 - risk(d)) where row_j < 0      row = d(distance)/dq of a control point
///     lower_j = -V_j (1 - risk(d)) where row_j > 0     of another link, the least of all counts
///     u = r + J+ v between lower and upper             robot::SaturateInNullspace
///
/// r is `wish`, the joint velocity that follows the request; the points that are repulsed shall
/// move with J r + v. The control point of a link is its nearest point, d its distance, and the
/// direction that of the sum of risk(d_i) normal_i over the link's proximities within
/// influence_distance (the hybrid of the paper: direction of all, size of the nearest). Repulsed
/// are the links that move with the tip link, or with `repulsion: all` every link. V_j is the
/// lesser of the joint's velocity limit and max_joint_velocity.
///
/// Not exactly as published: control points are nearest points of solids instead of points on the
/// arm's axis, and a penetration has its normal instead of a flipped distance vector; the sum of
/// directions weighs with risk, so that what enters has little say (published: unit vectors); the
/// task is the request's own joint motion, of which position and acceleration limits are left to a
/// MotionLimiter; the pivoting of the repulsive vector against fast obstacles is left out, obstacle
/// velocities are not looked at; a task that the bounds leave no room for is let go by damping
/// instead of scaled. As published, a bound jumps when an entry of a row changes its sign, which
/// joint is held first may change at once, 1/(1 + exp(alpha)) of a joint's speed is left towards an
/// obstacle that is touched, a link whose joints are only held back does not retreat, and the
/// shortest lever holds a joint as much as the longest, so that an arm in deep contact on several
/// links may not come clear. It evades by as much as balances the pull of the request: 0.1 m for
/// repulsion_speed 0.5 m/s and a VelocityLoop's position_gain 5 1/s.
///
/// Ports are those of VelocityMethod; share is the largest risk.
///
/// throws ConfigError if there is no such model or link, it has more than 32 joints, or a parameter
///        is out of its bounds; while running if a proximity or a pose is of no link of the model
/// source Flacco, Kroeger, De Luca, Khatib, A depth space approach to human-robot collision
///        avoidance, ICRA 2012, eq. (4) to (9); docs/theory.md
class FlaccoDeLucaLaw {
 public:
  static constexpr SystemDoc kDoc{
      "repulses the tip, and slows the joints that lead the arm to obstacles",
      "v = repulsion_speed / (1 + exp(alpha (2 d / influence_distance - 1))); u = r + J+ v within "
      "bounds V (1 - risk)",
      "Flacco, Kroeger, De Luca, Khatib 2012, ICRA"};
  enum class Repulsion { kTip, kAll };
  friend std::span<const char* const> EnumNames(Repulsion) {
    static constexpr std::array kNames{"tip", "all"};
    return kNames;
  }
  struct Params {
    std::string model{};
    std::string tip{};
    Repulsion repulsion{Repulsion::kTip};
    double repulsion_speed{0.5};
    double influence_distance{0.4};
    double alpha{6.0};
    double max_joint_velocity{2.0};
    double most_damping{0.05};
    double damping_threshold{0.1};
    static void Describe(Fields<Params>& fields);
  };
  static constexpr const char* kHow = "repulsed or held back";

  FlaccoDeLucaLaw(const Params& params, const ModelSet& models);

  const robot::RobotModel& model() const { return *model_; }
  void Choose(const ProximitySet& set, std::span<const Eigen::Isometry3d> X_WL, VectorView wish,
              AvoidanceVelocity& result) const;

  /// Between 0 and 1; 1/2 at half the influence distance, 1 / (1 + exp(-alpha)) at contact.
  double Risk(double distance) const;

 private:
  struct Motion;  ///< the problem of a tick
  const Params params_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const int tip_;
  const robot::Damping damping_;

  /// The distance as it counts: of own links so that they begin to at their range.
  double Seen(const Proximity& proximity) const;
  bool Repulsed(int link) const;
  void AddLink(const ProximitySet& set, std::size_t first, int link,
               std::span<const Eigen::Isometry3d> X_WL, VectorView wish, Motion& motion) const;
};

using FlaccoDeLuca = VelocityMethod<FlaccoDeLucaLaw>;

}  // namespace oca::systems
