// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/velocity_aware_law.h"
#include "oca/systems/signals/contact_slopes.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Pushes links away from what they come nearer to, the more the faster they do; what they leave or
/// pass at rest exerts no force. The force on a link is that of robot::VelocityAwareLaw, with range
/// max_distance and floor min_distance; of own links distances count max_distance / range times.
///
/// F alone lets the link come near slowly: add a RepulsiveField (ForceSum).
///
/// in    proximities  ProximitySet     with the obstacles' velocities
/// in    links        LinkPoses        with velocities
/// out   forces       LinkForceSet  N  one a proximity, same order, at point_on_link
/// out   slopes       ContactSlopes    for a LoopGain; `damping` for the worst direction of v
/// state -
/// throws ConfigError if velocity_gain is negative, exponent < 2, or not
///        0 < min_distance < max_distance; while running if links come in without velocities, or a
///        proximity is of no link that comes in
/// source Park, Hoffmann, Pastor, Schaal, Humanoids 2008, eq. (14), (15); docs/theory.md
class VelocityAwareField final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "pushes links away from what they approach, the more the faster",
      "force = -grad velocity_gain |v| (-cos)^exponent (1 - d/max_distance)^2 / d, d = "
      "max(distance, min_distance); 0 if moving away",
      "Park, Hoffmann, Pastor, Schaal 2008, eq. (14)"};
  struct Params {
    double velocity_gain{0.1};
    double exponent{2.0};
    double max_distance{0.6};
    double min_distance{0.01};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {}; }

  explicit VelocityAwareField(const Params& params);

 private:
  const robot::VelocityAwareLaw law_;
  void CalcForces(const ProximitySet& set, const LinkPoses& poses, LinkForceSet& result) const;
  void CalcSlopes(const ProximitySet& set, const LinkPoses& poses, ContactSlopes& result) const;

 public:
  const Input<ProximitySet> proximities;
  const Input<LinkPoses> links;
  const Output<LinkForceSet> forces;
  const Output<ContactSlopes> slopes;
};

}  // namespace oca::systems
