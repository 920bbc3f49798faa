// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "oca/models/name.h"
#include "oca/models/planning/band_curve.h"
#include "oca/models/planning/batch_clearance.h"
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
  std::vector<int> ignored{};  ///< numbers of links whose distance to it does not count
};

bool Moves(std::span<const BandBody> bodies);

/// The requested motion: its `derivative` (0, 1, 2) at `time` into `out`.
using BandRequest =
    std::function<void(double time, int derivative, Eigen::Ref<Eigen::VectorXd> out)>;

struct BandSettings {
  double margin{0.12};           ///< m; distances below it cost
  double clear_distance{0.045};  ///< m; a band that keeps it is wide
  double hard_distance{0.002};   ///< m; what stands, and own links, never come nearer
  double trust_distance{0.03};   ///< m; a band that keeps it from what stands need not be helped
  double flying_distance{0.01};  ///< m; nor one that keeps this from what moves
  double clearance{1e4};         ///< 1/m^2; price of a missing margin
  double smoothness{0.02};       ///< s^4/rad^2; price of an acceleration of the deviation
  double nearness{0.1};          ///< 1/rad^2; price of a deviation
  double return_nearness{20.0};  ///< 1/rad^2; the same where nothing is in the way any more
  double calm{0.1};              ///< s^2/rad^2; price of a speed of the deviation
  double limits{1e3};            ///< price of the square of an excess
  double limit_share{0.95};      ///< of the velocity and acceleration limits that a band may use
};

/// What is true of a band on a grid of times that is finer than that of its optimisation.
///
/// Of what stands, and of own links, no more is asked than the goal and the start leave there: near
/// either, a pair's own distance at it, and kYieldSlope more for every rad or m that the joints are
/// away from it. What the start lacks of hard_distance is asked for all the same within a second.
struct BandCheck {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  double min_distance;    ///< m, as it counts; or the margin, if all is farther
  double distance;        ///< m; of the same pair, as it is
  double time{0.0};       ///< s, of the nearest
  models::Name link{};    ///< the nearest pair
  models::Name body{};    ///< of no meaning if min_distance is the margin
  bool own_links{false};  ///< it is one of own links
  /// m s; integral of what lacks to clear_distance, and of 0.05 m times what is exceeded of limits
  /// (units as in BandOptimizer) that the request does not exceed
  double violation{0.0};
  /// The same, but what stands and own links are asked for hard_distance only.
  double breach{0.0};
  /// The same, but what moves is asked for flying_distance only.
  double contact{0.0};
  double first{0.0};  ///< s; first and last time at which it is not wide
  double last{0.0};
  /// s; first and last times at which something is nearer than what is wanted, a second apart
  std::vector<std::pair<double, double>> near{};
  double kept{kNever};  ///< m; least distance of what stands where that is less than is asked for
  /// s; first time at which what stands is nearer than trust_distance, or than hard_distance, at
  /// which what moves is nearer than flying_distance, and at which a limit is exceeded
  double touch_trust{kNever}, touch_hard{kNever}, touch_flying{kNever}, touch_limits{kNever};
  double way{0.0};  ///< rad; that the joints go, all together

  bool wide() const { return !(violation > 0.0); }
  /// No pair below what it must keep, and within the limits.
  bool clear() const { return !(breach > 0.0); }
  /// It may be nearer to what moves than what is clear, but not so near that a filter must help.
  bool evades() const { return !(contact > 0.0); }
  /// s; first time at which a filter has to help.
  double touch() const {
    return std::min({clear() ? touch_hard : touch_trust, touch_flying, touch_limits});
  }
};

inline constexpr double kYieldSlope = 0.25;  ///< m/rad, m/m

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
  /// For a robot as `arm` looks at it, which is copied; what contains its links is shared. `own`:
  /// the ranges of own links, if these are looked at.
  BandOptimizer(const robot::Clearance& arm, const BandSettings& settings,
                const robot::OwnRanges& own = {});
  BandOptimizer(std::shared_ptr<const robot::RobotModel> model, const BandSettings& settings,
                bool self_collision = false, const robot::OwnRanges& own = {})
      : BandOptimizer(robot::Clearance(std::move(model), self_collision), settings, own) {}

  /// Leaves two own links out from now on, by their numbers.
  void IgnoreOwn(int link, int other) {
    clearance_.IgnoreOwn(link, other);
    batch_.reset();
  }

  const robot::RobotModel& model() const { return clearance_.model(); }
  const BandSettings& settings() const { return settings_; }

  /// Takes what is requested and what stands and moves around, for bands on the grid of `curve`.
  /// A grid that begins before `from` (s) is looked at from there on.
  void Prepare(const BandCurve& curve, const BandRequest& request, std::span<const BandBody> bodies,
               bool end_fixed, double from = -std::numeric_limits<double>::infinity());
  /// From where to where, for what these leave to be asked; after Prepare. Null: nowhere.
  void YieldAt(const Eigen::VectorXd& start, const Eigen::VectorXd* goal);
  /// Whether the deviation at the end of the grid stays what it is.
  void FixEnd(bool fixed);
  /// The cost of a band of that grid.
  double Cost(const BandCurve& curve);
  /// Half the gradient of the cost in the free control points; for tests.
  Eigen::VectorXd HalfGradient(const BandCurve& curve);
  /// Improves a band by at most `most` steps; its cost. Never makes it dearer.
  double Relax(BandCurve& curve, int most);
  BandCheck Check(const BandCurve& curve);
  /// Which of the first `count` columns of q (num_positions() rows, at most 8) evade all at the end
  /// of the grid, a bit each. After Prepare and YieldAt.
  unsigned EvadesAtEnd(const Eigen::Ref<const Eigen::MatrixXd>& q, int count);
  /// BandCheck::evades() of a band, looked at from `from` (s) on, then from its start up to there,
  /// up to the first point that does not.
  bool EvadesAll(const BandCurve& curve, double from);
  /// Away from these times (BandCheck::near of what is requested), return_nearness is the price of
  /// a deviation: from 0.2 s before the end of each more and more, up to `before` s before the
  /// begin of the next. After Prepare, which says that nearness is the price.
  void ReturnBetween(std::vector<std::pair<double, double>> near, double before) {
    returns_ = true;
    near_ = std::move(near);
    before_ = before;
  }
  /// What a configuration leaves, m: least distance, as it is, to what stands and own links, and
  /// least one to what moves; each up to clear_distance.
  struct Room {
    double standing, flying;
    models::Name link, body;  ///< of the former
  };
  Room RoomAt(const Eigen::VectorXd& q, double time);

  /// The least distance of a configuration to what moves, each less `ahead` (s) times its speed
  /// then, m; up to the margin. After Prepare.
  double DistanceToMoving(const Eigen::VectorXd& q, double time, double ahead);

  /// How the nearest distance changes with the joints there, into `row`; false if nothing is near.
  bool DistanceGradient(const Eigen::VectorXd& q, double time, Eigen::VectorXd& row);

  int num_samples() const { return static_cast<int>(samples_.size()); }
  long evaluations() const { return evaluations_; }  ///< of configurations, since the start
  /// Those of them at which exact distances were asked for, and looks at eight of them at once.
  long exact_looks() const { return exact_looks_; }
  long batches() const { return batches_; }

 private:
  struct Sample {
    double time;
    double weight;  ///< s
    BandCurve::Basis basis;
    int first_pose;  ///< of the bodies in poses_
    int first_ball;  ///< of those that move, in balls_
    Eigen::VectorXd request[3];
  };
  /// Lower block band of the normal equations and the right side.
  struct Normal {
    double cost{0.0};
    std::vector<Eigen::MatrixXd> blocks;  ///< row i: blocks (i, i), (i, i - 1), ... (i, i - 3)
    Eigen::VectorXd right;
  };

  int Variable(int control) const;
  void AddSamples(const BandCurve& curve, const BandRequest& request, double from);
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
  double NearnessAt(double time) const;
  void Assemble(const Sample& sample, Normal& normal) const;
  bool Step(const Normal& normal, double damping);
  /// Asks what may be within `reach` (m) of samples, of the first eight at most, with deviations
  /// that `deviation` (a sample, into a vector) tells.
  template <class Deviation>
  void LookAhead(std::span<const Sample> samples, double reach, const Deviation& deviation);
  void AskAhead(int count, double reach);
  /// Whether at what was visited all is evaded, and, of a band, limits are kept.
  bool Evades(const Sample& sample, const BandCurve* curve);
  /// Of sample `lane` of those: brings the robot there, and, if need be, the bodies; the pairs
  /// within that reach are pairs_ then.
  void Visit(const Sample& sample, int lane, double reach);
  /// What a pair has at the goal or the start, as it counts, m.
  struct Left {
    int link, body, other_link;
    double distance;
    bool at_goal;
  };
  bool Flies(const robot::NearPair& pair) const {
    return pair.body >= 0 && !bodies_[static_cast<std::size_t>(pair.body)].stands;
  }
  void AddLeft(const Eigen::VectorXd& q, double time, bool at_goal);
  static bool IsOf(const Left& left, const robot::NearPair& pair);
  /// The most that may be asked of a pair at q_, as it counts: of what the goal leaves, and of what
  /// the start does too.
  double LeftByGoal(const robot::NearPair& pair) const;
  double LeftByEnds(const robot::NearPair& pair, double time) const;
  /// What lacks of a sample, placed, whose nearest distance is known; into the check.
  struct Lack {
    double wide{0.0}, hard{0.0}, contact{0.0};
  };
  Lack LackAt(double nearest, double time, BandCheck& check);
  /// m; what is farther than this from a sample is not known to a check.
  double Reach() const;
  void PlaceAt(const Eigen::VectorXd& q, double time);

  const BandSettings settings_;
  robot::Clearance clearance_;
  std::vector<BandBody> bodies_;
  std::vector<Sample> samples_;
  std::vector<Sample> checks_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<int> moving_;  ///< of bodies_
  std::vector<BatchClearance::MovingBall> balls_;
  std::optional<BatchClearance> batch_;  ///< of the bodies, the pairs and the ranges at hand
  Eigen::MatrixXd ahead_;                ///< positions of the samples that were asked for
  std::vector<BatchClearance::MovingBall> balls_ahead_;
  std::span<const BatchClearance::Candidate> candidates_;
  std::vector<robot::PairPlace> places_;
  int num_controls_{0};
  int num_variables_{0};
  bool end_fixed_{true};
  bool something_near_{false};  ///< else nothing has a distance
  long evaluations_{0}, exact_looks_{0}, batches_{0};
  Eigen::VectorXd start_;  ///< position at the start of the grid
  bool returns_{false};
  std::vector<std::pair<double, double>> near_;
  double before_{0.0};
  Eigen::VectorXd yield_start_, yield_goal_;
  std::vector<Left> left_;

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

template <class Deviation>
void BandOptimizer::LookAhead(std::span<const Sample> samples, double reach,
                              const Deviation& deviation) {
  if (samples.size() > BatchClearance::kLanes) samples = samples.first(BatchClearance::kLanes);
  balls_ahead_.clear();
  Eigen::VectorXd x(q_.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    deviation(samples[k], x);
    ahead_.col(static_cast<Eigen::Index>(k)) = samples[k].request[0] + x;
    const auto ball = balls_.begin() + samples[k].first_ball;
    balls_ahead_.insert(balls_ahead_.end(), ball, ball + std::ssize(moving_));
  }
  AskAhead(static_cast<int>(samples.size()), reach);
}

}  // namespace oca::planning
