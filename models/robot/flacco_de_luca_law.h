// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>

#include "oca/models/robot/avoidance_velocity.h"
#include "oca/models/robot/filtered_inverse.h"
#include "oca/models/robot/proximity.h"

namespace oca::robot {

/// Flacco and De Luca's avoidance: obstacles repulse the tip, and take speed from the joints that
/// would lead the rest of the arm to them.
///
///     risk(d) = 1 / (1 + exp(alpha (2 d / influence_distance - 1)))
///     v = repulsion_speed risk(d) direction            at the control point of a repulsed link
///     upper_j = V_j (1 - risk(d)) where row_j < 0      row = d(distance)/dq of a control point
///     lower_j = -V_j (1 - risk(d)) where row_j > 0     of another link, the least of all counts
///     u = r + J+ v between lower and upper             SaturateInNullspace
///
/// r is `wish`, the joint velocity that follows the request; the points that are repulsed shall
/// move with J r + v. The control point of a link is its nearest point, d its distance, and the
/// direction that of the sum of risk(d_i) normal_i over the link's proximities within
/// influence_distance (the hybrid of the paper: direction of all, size of the nearest). Repulsed
/// are the links that move with the tip link, or every link. V_j is the lesser of the joint's
/// velocity limit and max_joint_velocity.
///
/// Not exactly as published: control points are nearest points of solids instead of points on the
/// arm's axis, and a penetration has its normal instead of a flipped distance vector; the sum of
/// directions weighs with risk, so that what enters has little say (published: unit vectors); the
/// task is the request's own joint motion, of which position and acceleration limits are left to
/// whoever bounds the motion; the pivoting of the repulsive vector against fast obstacles is left
/// out, obstacle velocities are not looked at; a task that the bounds leave no room for is let go
/// by damping instead of scaled. As published, a bound jumps when an entry of a row changes its
/// sign, which joint is held first may change at once, 1/(1 + exp(alpha)) of a joint's speed is
/// left towards an obstacle that is touched, a link whose joints are only held back does not
/// retreat, and the shortest lever holds a joint as much as the longest, so that an arm in deep
/// contact on several links may not come clear.
///
/// source Flacco, Kroeger, De Luca, Khatib, A depth space approach to human-robot collision
///        avoidance, ICRA 2012, eq. (4) to (9); docs/theory.md
struct FlaccoDeLucaLaw {
  int tip;                    ///< the link that is repulsed
  bool all_links;             ///< every link is
  double repulsion_speed;     ///< m/s
  double influence_distance;  ///< m
  double alpha;               ///< steepness of the risk over the distance
  double max_joint_velocity;  ///< rad/s
  Damping damping;            ///< m/rad

  /// Between 0 and 1; 1/2 at half the influence distance, 1 / (1 + exp(-alpha)) at contact.
  double Risk(double distance) const;
  /// X_WL are the poses of the model's links; the share of the result is the largest risk. throws
  /// ModelError if a proximity is of no link of the model
  void Choose(const RobotModel& model, const ProximitySet& set,
              std::span<const Eigen::Isometry3d> X_WL,
              const Eigen::Ref<const Eigen::VectorXd>& wish, AvoidanceVelocity& result) const;
};

}  // namespace oca::robot
