// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "oca/models/motion/key_points.h"
#include "oca/models/robot/robot_model.h"

namespace oca::planning {

/// A path of a point in the base frame of a robot, m; s from 0 to 1.
using TipPath = std::function<Eigen::Vector3d(double s)>;

/// from + s (to - from)
TipPath LinePath(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// centre + radius (u cos 2 pi s + w sin 2 pi s): once round, counter-clockwise about the normal,
/// from u, the direction across `normal` that is nearest to z (x if the normal is z); w = n x u.
/// throws ModelError if the normal is zero
TipPath CirclePath(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal, double radius);

/// When joints go along a path, s.
struct TipTiming {
  double start{0.0};      ///< of the approach
  double approach{3.0};   ///< from the posture to the path's first point; > 0
  double duration{10.0};  ///< along the path; > 0
};

/// Key points of joints whose link's origin goes along a path, every 0.02 s or less: from `posture`
/// (n; rad or m) to its first point, straight in the joints, then along it, both from rest to rest,
/// s = 10 x^3 - 15 x^4 + 6 x^5. The link's orientation is free. Positions of the joints are found
/// by damped least squares on the kinematics, each from the one before, to 1e-9 m; where that leads
/// nowhere, as from a stretched arm, or beyond a limit, from postures around it, of whose solutions
/// the nearest is taken. The same arguments give the same key points.
/// throws ModelError `path: ...` if the path leaves the reach of the robot, takes a joint beyond
///        its limits or makes one jump, `posture: ...` if that is of another length
/// source Siciliano, Sciavicco, Villani, Oriolo, Robotics, section 3.5
std::vector<motion::KeyPoint> KeyPointsAlong(const robot::RobotModel& model, int link,
                                             const TipPath& path, const Eigen::VectorXd& posture,
                                             const TipTiming& timing);

}  // namespace oca::planning
