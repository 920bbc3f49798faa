// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/motion_tally.h"
#include "oca/models/robot/travel_bound.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/motion_metrics_value.h"
#include "oca/systems/signals/signals.h"

namespace oca {

template <>
struct Signal<robot::MotionTally> {
  static constexpr const char* kName = "MotionTally";
  static Fault Check(const robot::MotionTally& value, Look look);
};

}  // namespace oca

namespace oca::systems {

/// Measures a run: how near it came, how hard it was pushed, how smoothly it moved and whether it
/// arrived. Samples are taken every `period`, which should be that of control, at the state before
/// the updates of the instant. Distances are looked at `looks` times a period: samples in what
/// follows, where distances are meant, are all of these.
///
/// - min_distance: the least distance of all samples, with its pair and its time
/// - certified_min_distance: a proved lower bound of the distance at every time, also between the
///   samples: over each step, and for each pair, (before + after - travel) / 2, with what is not
///   listed at its max_distance. travel bounds how far the link moves, from what the joints of
///   `model` went, and the obstacle, from the largest speed of its script. The proof takes for
///   granted that no joint turns round within a step, that obstacles of other sources than
///   ObstacleSource are not faster in it than at either end, and that obstacles appear and vanish
///   at samples only
/// - contact_time: sum of the times from samples at distance <= 0 to the next one
/// - first_contact_time: of the first sample at distance <= 0
/// - max_abs_delta: largest |delta| of any joint
/// - final_error: max_i |position_i - goal_i| now; without a goal, the request takes its place
/// - time_to_goal: from the first sample to the first of those, up to the last one, that are all
///   within 0.01 of the goal; null if the last one is not, or there is no goal
/// - delta_sign_changes_per_second: how often the change of delta from sample to sample, where it
///   is above 1e-6, reverses; a joint and s
/// - total_variation_ratio: sum |d position| / sum |d request| over joints and samples
/// - path_length: sum ||d position||, 2-norm over the joints, over the samples
/// - max_joint_speed: largest |d position| / period
/// - final_speed: largest |d position| / period of the last sample
/// - max_joint_acceleration: largest |change of d position| / period^2
/// - limit_violations: joints of `model` beyond a limit of their position, speed or acceleration,
///   by more than rounding, summed over the samples; null without a model
/// - stuck_time: the longest time, from 2 s on and else 0, that the arm stood, no joint moving by
///   more than 0.02, while it was off the goal and off the request by more than 0.01; or, if
///   longer, the time since which the request is at the goal and no joint distance to it of the
///   arm, which is not there, was less by more than 0.02
/// - stuck_pair: what was nearest then, null if nothing was within reach; or, where a joint stood
///   at a limit that the goal is beyond, [joint, "limit"]. stuck_amount is how far apart the pair
///   was, or how far the goal is beyond the limit. All three are null without a goal
///
/// The output at a sampling instant whose update is pending has its sample in it, so the end of a
/// run counts, once. A metric whose inputs are not connected or without a value is null; so are
/// certified_min_distance and contact_time as long as no pair was looked at, as where nothing is
/// there to come near.
///
/// in    position, request, goal, delta  n  u   optional; n and u are common
/// in    proximities  ProximitySet              optional
/// out   metrics      MotionMetrics
/// state x            MotionTally
/// throws ConfigError if period is not positive, looks is less than 1 or there is no such model
/// source models/robot/travel_bound.h
class MotionMetrics final : public System {
 public:
  static constexpr SystemDoc kDoc{"measures nearness, contact, smoothness and arrival of a run",
                                  "extremes, sums and rates over samples taken every period", ""};
  struct Params {
    Period period{};
    std::string model{};
    int looks{1};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100), .model = {}}; }

  explicit MotionMetrics(const Params& params) : MotionMetrics(params, {}) {}
  MotionMetrics(const Params& params, const ModelSet& models);

 private:
  using OptionalVector = std::optional<VectorView>;
  const int looks_;
  const Period between_;                                  // looks
  const std::shared_ptr<const robot::RobotModel> model_;  ///< null: positions mean nothing
  const std::optional<robot::TravelBound> travel_;
  const PortSpec spec_;
  const DiscreteState<robot::MotionTally> x_;
  PortSpec MakeSpec();
  robot::MotionSample Sample(double time, OptionalVector position_value,
                             OptionalVector request_value, OptionalVector goal_value,
                             OptionalVector delta_value, const ProximitySet* proximity_set) const;
  void Add(const robot::MotionSample& sample, robot::MotionTally& tally) const;
  void Update(double time, OptionalVector position_value, OptionalVector request_value,
              OptionalVector goal_value, OptionalVector delta_value,
              const ProximitySet* proximity_set, robot::MotionTally& next) const;
  void CalcTally(double time, OptionalVector position_value, OptionalVector request_value,
                 OptionalVector goal_value, OptionalVector delta_value,
                 const ProximitySet* proximity_set, const robot::MotionTally& x,
                 robot::MotionTally& value) const;
  void CalcMetrics(double time, OptionalVector position_value, OptionalVector request_value,
                   OptionalVector goal_value, OptionalVector delta_value,
                   const ProximitySet* proximity_set, const robot::MotionTally& complete,
                   MotionMetricsValue& value) const;

 public:
  const OptionalInput<Vector> position;
  const OptionalInput<Vector> request;
  const OptionalInput<Vector> goal;
  const OptionalInput<Vector> delta;
  const OptionalInput<ProximitySet> proximities;

 private:
  const Cached<robot::MotionTally> tally_;  ///< the present sample included

 public:
  const Output<MotionMetricsValue> metrics;
};

}  // namespace oca::systems
