// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "oca/models/name.h"
#include "oca/models/planning/band_curve.h"
#include "oca/models/robot/clearance.h"

namespace oca::planning {

/// A body around the robot, whose pose X_WB is known at every time.
struct BandBody {
  models::Name name;
  std::shared_ptr<const geometry::Collider> collider;
  std::function<Eigen::Isometry3d(double time)> pose;
  bool stands;
  /// Of its position, m^2: distances count less by geometry::Uncertainty. Empty: known exactly.
  std::function<Eigen::Matrix3d(double time)> covariance{};

  robot::PlacedBody At(double time) const {
    if (!covariance) return {collider, pose(time)};
    return {collider, pose(time), covariance(time)};
  }
};

bool Moves(std::span<const BandBody> bodies);

/// The requested motion: its `derivative` (0, 1, 2) at `time` into `out`.
using BandRequest =
    std::function<void(double time, int derivative, Eigen::Ref<Eigen::VectorXd> out)>;

struct BandSettings {
  double margin{0.1};            ///< m; distances below it cost
  double clear_distance{0.04};   ///< m; a band that keeps it is clear
  double trust_distance{0.03};   ///< m; a band that keeps it from what stands need not be helped
  double flying_distance{0.01};  ///< m; nor one that keeps this from what moves
  double clearance{1e4};         ///< 1/m^2; price of a missing margin
  double smoothness{0.02};       ///< s^4/rad^2; price of an acceleration of the deviation
  double nearness{0.1};          ///< 1/rad^2; price of a deviation
  double calm{0.1};              ///< s^2/rad^2; price of a speed of the deviation
  double limits{1e3};            ///< price of the square of an excess
  double limit_share{0.9};       ///< of the velocity and acceleration limits that a band may use
};

/// What is true of a band on a grid of times that is finer than that of its optimisation.
struct BandCheck {
  double min_distance;  ///< m, as it counts; or the margin, if all is farther
  double distance;      ///< m; of the same pair, as it is
  double time{0.0};     ///< s, of the nearest
  models::Name link{};  ///< the nearest pair
  models::Name body{};  ///< of no meaning if min_distance is the margin
  /// m s; integral of what lacks to clear_distance, and of 0.05 m times what is exceeded of limits
  /// (units as in BandOptimizer) that the request does not exceed
  double violation{0.0};
  double first{0.0};  ///< s; first and last time at which it is not clear
  double last{0.0};
  /// s; first time below trust_distance or beyond such a limit
  double touch{std::numeric_limits<double>::infinity()};
  double way{0.0};  ///< rad; that the joints go, all together
  bool clear() const { return !(violation > 0.0); }
};

/// A band of configurations along a requested motion, which bodies push away and which pulls itself
/// back and straight: the deviation x(t), a BandCurve, that minimises
///
///     integral of  clearance sum_pairs max(margin - rho, 0)^2 + nearness |x|^2 + calm |x'|^2 +
///                  smoothness |x''|^2 + limits |excess|^2   dt
///
/// where rho is the distance of a link and a body at request + x and at that time, and excess what
/// positions exceed of their limits less 0.02, in units of 0.1 rad or m, and what velocities and
/// accelerations exceed of limit_share of their limits, in shares of these. Distances of own links
/// count so that each pair is asked for its range where others are for clear_distance
/// (robot::Clearance::KeepOwn). Solved by
/// damped Gauss-Newton steps with the analytic rows n^T J of the distances; the normal equations
/// are banded and solved in blocks. The state at the start is fixed, the end fixed or free.
/// source Quinlan, Khatib, Elastic bands, ICRA 1993; Ratliff et al., CHOMP, ICRA 2009;
///        Madsen, Nielsen, Tingleff, Methods for non-linear least squares problems, 2004
class BandOptimizer {
 public:
  /// `own`: the ranges of own links, if these are looked at.
  BandOptimizer(std::shared_ptr<const robot::RobotModel> model, const BandSettings& settings,
                bool self_collision = false, const robot::OwnRanges& own = {});

  const robot::RobotModel& model() const { return *model_; }
  const BandSettings& settings() const { return settings_; }

  /// Takes what is requested and what stands and moves around, for bands on the grid of `curve`.
  void Prepare(const BandCurve& curve, const BandRequest& request, std::span<const BandBody> bodies,
               bool end_fixed);
  /// Whether the deviation at the end of the grid stays what it is.
  void FixEnd(bool fixed);
  /// The cost of a band of that grid.
  double Cost(const BandCurve& curve);
  /// Half the gradient of the cost in the free control points; for tests.
  Eigen::VectorXd HalfGradient(const BandCurve& curve);
  /// Improves a band by at most `most` steps; its cost. Never makes it dearer.
  double Relax(BandCurve& curve, int most);
  BandCheck Check(const BandCurve& curve);
  /// The nearest distance of a configuration at a time, up to the margin; after Prepare.
  double Distance(const Eigen::VectorXd& q, double time);

  /// How the nearest distance changes with the joints there, into `row`; false if nothing is near.
  bool DistanceGradient(const Eigen::VectorXd& q, double time, Eigen::VectorXd& row);

  int num_samples() const { return static_cast<int>(samples_.size()); }
  long evaluations() const { return evaluations_; }  ///< of configurations, since the start

 private:
  struct Sample {
    double time;
    double weight;  ///< s
    BandCurve::Basis basis;
    int first_pose;  ///< of the bodies in poses_
    Eigen::VectorXd request[3];
  };
  /// Lower block band of the normal equations and the right side.
  struct Normal {
    double cost{0.0};
    std::vector<Eigen::MatrixXd> blocks;  ///< row i: blocks (i, i), (i, i - 1), ... (i, i - 3)
    Eigen::VectorXd right;
  };

  int Variable(int control) const;
  void AddSamples(const BandCurve& curve, const BandRequest& request);
  Sample MakeSample(const BandCurve& curve, const BandRequest& request, double time, double weight);
  void Linearize(const Eigen::MatrixXd& controls, bool rows, Normal& normal);
  void AddClearance(bool rows);
  /// Positions, velocities or accelerations that a band may use, and what counts as an excess of 1.
  struct Range {
    double lower, upper, unit;
  };
  Range RangeOf(Eigen::Index joint, int derivative, double share) const;
  /// What the band exceeds more than the request does, and in position than it did at the start.
  double AddedExcess(const Sample& sample, const BandCurve& curve) const;
  void AddDiagonal(const Sample& sample, const Eigen::VectorXd x[3]);
  void Assemble(const Sample& sample, Normal& normal) const;
  bool Step(const Normal& normal, double damping);
  /// Brings robot and bodies to where they are at a sample with deviation x.
  void Place(const Sample& sample, const Eigen::VectorXd& x);
  /// Whether, placed, anything is nearer than a band that is to be trusted keeps.
  bool Touches(double nearest);
  void PlaceAt(const Eigen::VectorXd& q, double time);

  const std::shared_ptr<const robot::RobotModel> model_;
  const BandSettings settings_;
  const bool self_collision_;
  robot::Clearance clearance_;
  std::vector<BandBody> bodies_;
  std::vector<Sample> samples_;
  std::vector<Sample> checks_;
  std::vector<Eigen::Isometry3d> poses_;
  int num_controls_{0};
  int num_variables_{0};
  bool end_fixed_{true};
  bool something_near_{false};  ///< else nothing has a distance
  long evaluations_{0};
  Eigen::VectorXd start_;  ///< position at the start of the grid

  // Of the sample at hand.
  std::vector<robot::NearPair> pairs_;
  Eigen::VectorXd q_;
  Eigen::VectorXd row_;
  double cost_{0.0};
  Eigen::MatrixXd H_;
  Eigen::VectorXd g_[3];
  Eigen::VectorXd d_[3];
  // Of the step.
  std::vector<Eigen::MatrixXd> factor_;
  Eigen::VectorXd step_;
};

}  // namespace oca::planning
