// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "oca/models/geometry/obstacle.h"

namespace oca::sensing {

/// What is known of the poses that come in, and of what moves.
struct BodyFilterSettings {
  double position_noise{0.005};       ///< m; standard deviation along each axis
  double angle_noise{0.01};           ///< rad; about each axis
  double acceleration_density{5e-5};  ///< m^2/s^3; of what goes straight
  double turning_density{0.5};        ///< m^2/s^5; of the jerk of what turns or gets faster
  double erratic_density{60.0};  ///< m^2/s^5; of the jerk of what does so in another way each time
  double spin_density{0.1};      ///< rad^2/s^3; of angular accelerations
  double switching{0.05};        ///< 1/s; how often what rests or goes straight changes its way
  double turning_end{0.3};       ///< 1/s; how often anything else does
  double prior_speed{0.5};       ///< m/s; standard deviation, of what is seen for the first time
  double fastest{10.0};          ///< m/s; a pose that would take more is not believed
};

/// What became of a pose.
enum class PoseUse {
  kFirst,    ///< the body starts with it, or starts anew, after poses that were not believed
  kUsed,     ///< as foreseen
  kTurn,     ///< used, and farther off than its covariance allows: the body has changed its way
  kNotNew,   ///< of the time of the last one
  kLate,     ///< of a time before the last one; left out
  kRefused,  ///< too far off for anything that moves; left out
};

/// All that is known of one body.
struct BodyTrack {
  static constexpr int kModes = 5;           ///< as in BodyFilter
  using Mean = Eigen::Matrix<double, 9, 1>;  ///< position, velocity, acceleration
  using Covariance = Eigen::Matrix<double, 9, 9>;
  struct Mode {
    Mean mean{Mean::Zero()};
    Covariance covariance{Covariance::Zero()};
    double weight{0.0};  ///< its probability
  };

  double time{0.0};  ///< s; of the last pose that was used
  std::array<Mode, kModes> modes{};
  double turn{0.0};  ///< rad/s; at which its velocity turns, if it does
  Eigen::Quaterniond rotation{Eigen::Quaterniond::Identity()};
  Eigen::Vector3d angular{Eigen::Vector3d::Zero()};           ///< rad/s
  Eigen::Matrix2d angle_covariance{Eigen::Matrix2d::Zero()};  ///< of angle and rate, of each axis
  Eigen::Vector3d doubted{Eigen::Vector3d::Zero()};           ///< where the last one was refused, m
  double doubted_at{0.0};                                     ///< s
  int refused{0};                                             ///< poses, one after the other
  double nis{0.0};  ///< innovation^T S^-1 innovation of the last position; of chi-square (3)
};

/// Velocity, angular velocity, acceleration and covariances of a body from its poses: an
/// interacting multiple model of five Kalman filters,
///
///     rests               p' = w
///     goes straight       p'' = w                      w white, of the densities of the settings
///     turns, accelerates  p''' = -turn^2 p' + w        turn = |v x a| / |v|^2 of its own estimate
///     is erratic          the same with a larger w
///     falls               p'' = g + w
///
/// between which a body changes at the rates of the settings; for turn = 0 the third is that of
/// constant acceleration. Rotations are filtered apart, with white angular acceleration.
///
/// Poses are looked at in the order of their times. If the normalised innovation squared exceeds
/// its bound of 99.99 %, the velocity is taken to have jumped: its covariance grows by what is
/// needed to get there. What would take more than `fastest` is refused, and starts the body anew
/// when a second pose agrees.
/// source Blom, Bar-Shalom, The interacting multiple model algorithm, IEEE TAC 33 (8), 1988;
///        Bar-Shalom, Li, Kirubarajan, Estimation with applications to tracking and navigation,
///        2001, sections 6.2, 6.3, 11.6, 11.7; Li, Jilkov, Survey of maneuvering target tracking,
///        part I, IEEE TAES 39 (4), 2003, eq. (77): the turn in space
class BodyFilter {
 public:
  /// The settings are positive.
  explicit BodyFilter(const BodyFilterSettings& settings) : settings_(settings) {}

  /// Begins with a pose at a time, s.
  void Start(double time, const Eigen::Isometry3d& X_WO, BodyTrack& track) const;
  /// Takes a pose of a time into account. No heap.
  PoseUse Update(double time, const Eigen::Isometry3d& X_WO, BodyTrack& track) const;
  /// State and estimate at a time that is not before that of the track. What rests with more than
  /// 90 % has velocity 0, and what turns by less than three standard deviations does not turn.
  void Tell(const BodyTrack& track, double time, geometry::Obstacle& obstacle,
            geometry::ObstacleEstimate& estimate) const;

 private:
  using Modes = std::array<BodyTrack::Mode, BodyTrack::kModes>;
  Modes Mixed(const BodyTrack& track, double dt) const;
  void Advance(double dt, double turn, Modes& modes) const;
  void UpdatePosition(const Eigen::Vector3d& position, BodyTrack& track, Modes& modes) const;
  void UpdateRotation(double dt, const Eigen::Quaterniond& rotation, BodyTrack& track) const;

  const BodyFilterSettings settings_;
};

}  // namespace oca::sensing
