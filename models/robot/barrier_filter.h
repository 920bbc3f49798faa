// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "oca/models/motion/stoppable_motion.h"
#include "oca/models/qp/projection_solver.h"
#include "oca/models/robot/clear_motion.h"
#include "oca/models/robot/filter_activity.h"
#include "oca/models/robot/proximity.h"
#include "oca/models/robot/witness_pairs.h"

namespace oca::robot {

/// Of a BarrierFilter; systems::SafetyFilter says what they mean and has their defaults.
struct BarrierSettings {
  enum class Form { kLinear, kBraking };
  double period;            ///< s
  double safe_distance;     ///< m
  Form form;                ///< of the approach
  double approach_gain;     ///< 1/s; linear
  double deceleration;      ///< m/s^2; braking
  double position_gain;     ///< 1/s
  Eigen::VectorXd weights;  ///< one a joint
  double progress_weight;   ///< of joints with a way to go
  double slack_penalty;     ///< rad^2/(m s)
  double trust_time;        ///< s
  double recovery_gain;     ///< 1/s
  double recovery_speed;    ///< m/s
  double recovery_penalty;  ///< rad^2/(m s)
  int most_rows;
};

/// The joint velocity nearest to the requested one that keeps the arm clear, a control barrier
/// function as a quadratic program:
///
///     u = argmin 1/2 sum_j w_j (u_j - r_j)^2 + slack_penalty sum_i s_i
///     a_i^T u >= n_i^T v_i - approach(h_i) - s_i,  s_i >= 0,   one row a proximity
///     u_j in the velocities from which joint j can stop within all its limits
///
/// All symbols, and the rows for recovery, are those of systems::SafetyFilter. An answer whose
/// optimality is not proven is not used: the arm brakes, as fast as the box lets every joint.
/// source Ames et al., Control barrier functions: theory and applications, ECC 2019
class BarrierFilter {
 public:
  using Positions = Eigen::Map<const Eigen::VectorXd>;

  /// What is so at a tick. Of velocities and accelerations nothing counts as 0.
  struct Tick {
    std::span<const Eigen::Isometry3d> X_WL;
    const ProximitySet& proximities;
    Positions position;                     ///< requested
    std::optional<Positions> velocity;      ///< requested
    std::optional<Positions> acceleration;  ///< requested
    const ClearMotion* clear;               ///< of the request; null: not known
    Positions way;                          ///< l; that the request led each joint lately
    const FilterActivity& last;             ///< of the tick before, a guess at what is active
    const WitnessPairs& witnesses;          ///< of the tick before
  };

  /// The answer, and the memory that it is computed in.
  struct Solution {
    Eigen::VectorXd velocity;  ///< u
    FilterActivity activity;
    WitnessPairs witnesses;         ///< those of the tick before that still count, and this one's
    Eigen::VectorXd command;        ///< c at this tick; the caller's
    Eigen::VectorXd last_velocity;  ///< that led to it; the caller's

   private:
    friend class BarrierFilter;
    /// What one row of the problem stands for.
    struct Row {
      int proximity;
      bool recovery;
      double headroom;  ///< h, m
    };
    struct Workspace {
      Workspace(int num_positions, int most_rows);
      qp::ProjectionQp qp;
      qp::ProjectionSolver solver;
      qp::QpSolution solution;
      std::vector<Row> rows;                   ///< of the problem
      std::vector<FilterBound> unmovable;      ///< that should grow, one a proximity
      std::vector<motion::VelocityRange> box;  ///< one a joint
      Eigen::VectorXd row;
    };
    std::optional<Workspace> workspace_;
  };

  BarrierFilter(std::shared_ptr<const RobotModel> model, BarrierSettings settings);

  /// The velocity for the period that begins at the tick, from `command` and `last_velocity` of
  /// the solution. No heap after the first call. throws ModelError if a proximity is of no link of
  /// the model
  void Solve(const Tick& tick, Solution& result) const;

  /// How far below safe_distance ticks may lead, m: what the curvature of the way costs within a
  /// period, divided by the share of it that is won back in the next one. For joint speeds that add
  /// up to `turn` rad/s, a nearest point at most `reach` m from every joint and obstacles up to
  /// `obstacle_speed` m/s that do not turn. Holds between balls and convex bodies while no row
  /// takes slack; derivation in docs/explanation/safety_filter.md.
  double TickMargin(double turn, double reach, double obstacle_speed) const;
  /// No point of the arm is farther than this from a joint before it, m.
  double reach() const { return reach_; }

 private:
  using Poses = std::span<const Eigen::Isometry3d>;
  double Approach(double headroom) const;
  void FillBox(Solution& result) const;
  void FillWish(const Tick& tick, Solution& result) const;
  void FillRows(const Tick& tick, Solution& result) const;
  void FillRowsOf(int number, const Proximity& proximity, bool nearest, const Tick& tick,
                  Solution& result) const;
  bool Moves(const Eigen::VectorXd& row) const;
  void AddRow(const Solution::Row& source, double bound, Solution& result) const;
  void LeaveOut(const Proximity& proximity, double lack, Solution& result) const;
  void Brake(Solution& result) const;
  void FillGuess(const Tick& tick, Solution& result) const;
  void Report(const Tick& tick, Solution& result) const;

  const std::shared_ptr<const RobotModel> model_;
  const BarrierSettings settings_;
  const double reach_;
  const Eigen::VectorXd least_entries_;  ///< of a row that is not all rounding, one a joint
};

}  // namespace oca::robot
