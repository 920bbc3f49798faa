// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::robot {

/// Bounds how far the solids of a robot's links travel while its joints move.
///
/// No point of a solid travels farther than
///
///     E(L) = E_0,   E_{k-1} = E_k + |path_k| (a_k + E_k)   for a revolute joint k,
///                   E_{k-1} = E_k + |path_k|               for a prismatic one,
///
/// from the joint that carries link L, where E = 0, to the root. path_k is the path that joint k
/// goes (rad, m; |q1 - q0| if it does not turn round), and a_k the largest distance of the link's
/// solids from the joint's axis at the start. For the distance of a point to axis k changes only by
/// what the joints beyond k do, which is at most E_k; what the joint itself turns is added to it.
/// The bound holds for any order and any timing of the joints' motions.
class TravelBound {
 public:
  explicit TravelBound(const RobotModel& model);

  /// `X_WL` poses at the start, `path` one entry a position (>= 0), `travel` one a link, m; 0 for a
  /// link without solids. No heap.
  void Calc(std::span<const Eigen::Isometry3d> X_WL, const Eigen::Ref<const Eigen::VectorXd>& path,
            std::span<double> travel) const;

  /// The same for two links of the robot relative to each other, m: only joints between them count,
  /// for what moves both alike leaves their distance as it is. No heap.
  double Between(std::span<const Eigen::Isometry3d> X_WL,
                 const Eigen::Ref<const Eigen::VectorXd>& path, int link, int other) const;

 private:
  struct Ball {
    int link;
    Eigen::Vector3d centre;  // in the link's frame
    double radius;
  };
  /// Of one solid, relative to the link `root` before it; 0: the robot's root.
  double TravelOf(const Ball& ball, int root, std::span<const Eigen::Isometry3d> X_WL,
                  const Eigen::Ref<const Eigen::VectorXd>& path) const;

  const RobotModel* model_;
  std::vector<Ball> balls_;
};

/// Least distance that two bodies can have had between two instants at which it was `before` and
/// `after`, if their points moved by no more than `travel` relative to each other (all m):
///
///     min over s of max(before - s, after - (travel - s)) = (before + after - travel) / 2
///
/// and not above either of the two. It is exact for bodies that approach head-on.
double LeastDistanceBetween(double before, double after, double travel);

}  // namespace oca::robot
