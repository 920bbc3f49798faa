// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/barrier_filter.h"
#include "oca/systems/signals/clear_motion.h"
#include "oca/systems/signals/filter_activity.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/signals.h"

namespace oca {

template <>
struct Signal<robot::WitnessPairs> {
  static constexpr const char* kName = "WitnessPairs";
  static Fault Check(const robot::WitnessPairs& value, Look look);
};

}  // namespace oca

namespace oca::systems {

/// The joint velocity nearest to the requested one that keeps the arm clear: a control barrier
/// function as a quadratic program, once a period.
///
///     u = argmin 1/2 sum_j w_j (u_j - r_j)^2 + slack_penalty sum_i s_i
///     a_i^T u >= n_i^T v_i - approach(h_i) - s_i,  s_i >= 0,   one row a pair of points
///     u_j in the velocities from which joint j can stop within all its limits
///
///     r = velocity + acceleration period / 2 + position_gain (position - c), braked for arrival,
///         within ten times the joint's velocity limit, for slack has a price
///     w_j = weights_j (1 + progress_weight l_j / (max_k l_k + 0.05))
///     a_i = n_i^T (J at point_on_link), less that of the other link within one arm
///     h_i = distance_i - min(safe_distance, range_i),   v_i the obstacle's velocity at its point
///     approach = approach_gain h                             form linear
///                LargestStoppableVelocity(h, deceleration)   form braking
///                0                                           h < 0
///
/// A pair of bodies has a row for its nearest points and one for those that were the nearest within
/// the last 0.5 s (robot::WitnessPairs), for where flat lies along flat they jump.
///
/// A row that no joint moves, for it is shorter than 1e-12 m/rad times the arm's reach (a slider:
/// 1e-12), says nothing about u and is left out; if its distance should grow, `activity` names it.
/// An answer whose optimality is not proven is not used: the arm brakes.
///
/// l_j is the way in rad that the request led joint j lately, a sum of |velocity| period that fades
/// within 10 s. With a progress_weight the joints that are to get somewhere are dear, so that the
/// others evade and the arm does not stop in front of what it could pass.
///
/// A request that is known to be clear of something for more than trust_time is let through there:
/// a row about it asks for no more than r gives, a_i^T u >= min(..., a_i^T r). So the filter does
/// not push the arm off a way past what comes near fast, nor off a goal that is near what stands.
///
/// Where h < 0 a second row, of the nearest points, asks for h to grow by min(-recovery_gain h,
/// recovery_speed), at the price recovery_penalty: a wish that may be denied, so that a slow
/// retreat is never forbidden. An answer always exists; which rows are active, and what slack they
/// take, is on `activity`. Within the box position and velocity limits yield to acceleration: see
/// StoppableVelocities.
///
/// The held state is the command c of this tick and u; the arm is to be at c + u period at the next
/// one. So that a DeltaOverlay sends it there, delta = c + u period - position, whatever the
/// request does meanwhile. At a tick `position` is read as the request for this very time.
///
/// in    proximities        ProximitySet   with the velocities of obstacles
///       links              LinkPoses
///       position           n  u       requested, as an overlay adds delta to it
///       velocity           n  u/s     requested; optional, absent counts as 0
///       acceleration       n  u/s^2   requested; optional, absent counts as 0
///       measured_position  n  u       where the command starts
///       command            n  u       optional; the command that is really sent, if a later stage
///                                     may change it, else c follows from u
///       clear              ClearMotion    of the request; optional, absent: not known
/// out   delta     n  u
///       activity  FilterActivity      of the last tick
/// state c         n  u
///       u         n  u/s
///       l         n  u
///       activity  FilterActivity
///       witnesses WitnessPairs
/// throws ConfigError if there is no such model, a gain or a penalty is out of its bounds, or
///        approach_gain or recovery_gain exceeds 1 / period; while running if a proximity or a pose
///        is of no link of the model
/// source Ames et al., Control barrier functions: theory and applications, ECC 2019;
///        docs/theory.md, Safety filter; docs/explanation/safety_filter.md
class SafetyFilter final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "finds the joint velocity nearest to the requested one that keeps the arm clear",
      "u = argmin |u - r|^2 + penalty sum(s): n^T J u >= n^T v_obstacle - approach(h) - s, h = "
      "distance - safe_distance; delta = c + u period - position",
      "Ames et al. 2019, Control barrier functions: theory and applications"};
  enum class Form { kLinear, kBraking };
  friend std::span<const char* const> EnumNames(Form) {
    static constexpr std::array kNames{"linear", "braking"};
    return kNames;
  }
  struct Params {
    std::string model{};
    Period period{};
    double safe_distance{0.05};
    Form form{Form::kLinear};
    double approach_gain{5.0};
    double deceleration{2.0};
    double position_gain{5.0};
    PerComponent weights{1.0};
    double progress_weight{0.0};
    double slack_penalty{1e4};
    double trust_time{0.0};
    double recovery_gain{5.0};
    double recovery_speed{0.5};
    double recovery_penalty{10.0};
    int most_rows{500};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100)}; }

  SafetyFilter(const Params& params, const ModelSet& models);

 private:
  using OptionalVector = std::optional<VectorView>;
  const Params params_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const robot::BarrierFilter filter_;
  const DiscreteState<Vector> c_;
  const DiscreteState<Vector> u_;
  const DiscreteState<Vector> l_;
  const DiscreteState<FilterActivity> activity_;
  const DiscreteState<robot::WitnessPairs> witnesses_;

  struct Solution;
  std::string DescribeMargin() const;
  void Start(VectorView measured, MutableVectorView c) const;
  void CalcSolution(const ProximitySet& set, const LinkPoses& poses, VectorView request,
                    OptionalVector rate, OptionalVector rate_rate, OptionalVector sent,
                    const ClearMotion* clear_motion, VectorView c, VectorView u, VectorView l,
                    const FilterActivity& last, const robot::WitnessPairs& witnesses,
                    Solution& result) const;
  void Update(const Solution& result, OptionalVector sent, OptionalVector rate, MutableVectorView c,
              MutableVectorView u, MutableVectorView l, FilterActivity& last,
              robot::WitnessPairs& witnesses) const;
  void CalcDelta(VectorView request, VectorView c, VectorView u, MutableVectorView out) const;

 public:
  const Input<ProximitySet> proximities;
  const Input<LinkPoses> links;
  const Input<Vector> position;
  const OptionalInput<Vector> velocity;
  const OptionalInput<Vector> acceleration;
  const Input<Vector> measured_position;
  const OptionalInput<Vector> command;
  const OptionalInput<ClearMotion> clear;

 private:
  const Cached<Solution> solution_;

 public:
  const Output<Vector> delta;
  const Output<FilterActivity> activity;
};

}  // namespace oca::systems
