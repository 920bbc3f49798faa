// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/servo_scaling_law.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/request_ahead.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// MoveIt Servo's collision law, as a baseline: near obstacles the request is followed more slowly,
/// along itself.
///
///     scale = the least of all proximities by robot::ServoScalingLaw
///     s_next = s + scale period,   delta = request(s) - position
///
/// The law takes `slow_distance` of obstacles, and of two links of the arm the lesser of
/// `own_slow_distance` and the pair's range. The arm never leaves the way that was requested, so it
/// stays clear of what stands, because it stops; it cannot evade, does not look at the velocity of
/// obstacles, and arrives only if they go away. As in Servo the scale slows a motion that leads
/// away from an obstacle too, and once in contact the arm stays there. With `approach_only` it does
/// not.
///
/// in    proximities  ProximitySet
///       links        LinkPoses
///       ahead        RequestAhead    the whole motion; while nobody knows it delta and scale are 0
///       position     n  u            requested, as an overlay adds delta to it
/// out   delta        n  u
///       scale        1
///       path_time    1  s            s
/// state s            1  s            starting at the time of the start
/// throws ConfigError if there is no such model, it has more than 32 joints, or a parameter is out
///        of its bounds; while running if the motion ahead is of another length, or a
///        proximity or a pose is of no link of the model
/// source MoveIt Servo, collision_monitor.cpp; docs/theory.md
class ServoScaling final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "slows the request near obstacles, along itself",
      "scale = exp(k (d - slow_distance)), k = ln(1000) / slow_distance; s += scale period; delta "
      "= request(s) - position",
      "MoveIt Servo, collision_monitor.cpp"};
  struct Params {
    std::string model{};
    Period period{};
    double slow_distance{0.1};
    double own_slow_distance{0.02};
    bool approach_only{false};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100)}; }

  ServoScaling(const Params& params, const ModelSet& models);

 private:
  const Period period_;
  const robot::ServoScalingLaw law_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const DiscreteState<Vector> s_;

  const motion::Trajectory* Known(const RequestAhead& request) const;
  void Start(double time, MutableVectorView s) const;
  struct Slowed;
  void CalcSlowed(const ProximitySet& set, const LinkPoses& poses, const RequestAhead& request,
                  VectorView s, Slowed& result) const;
  void CalcScale(const Slowed& result, MutableVectorView out) const;
  void CalcDelta(const RequestAhead& request, VectorView now, VectorView s,
                 MutableVectorView out) const;
  void Update(double time, VectorView scale_value, MutableVectorView s) const;

 public:
  const Input<ProximitySet> proximities;
  const Input<LinkPoses> links;
  const Input<RequestAhead> ahead;
  const Input<Vector> position;

 private:
  const Cached<Slowed> slowed_;

 public:
  const Output<Vector> scale;
  const Output<Vector> delta;
  const Output<Vector> path_time;
};

}  // namespace oca::systems
