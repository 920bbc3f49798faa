// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/signals/contact_slopes.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Pushes links away from what they come nearer to, the more the faster they do; what they leave or
/// pass at rest exerts no force. With x the vector from the obstacle to the link along the normal,
/// p = |x| the distance and v the velocity of the link's point relative to the obstacle's:
///
///     U = velocity_gain |v| (-c)^exponent s(p),   c = v . x / (|v| p),   if c < 0 and p < rho0
///     s = (1 - p / rho0)^2 / p,                   F = -dU/dx at constant v
///
/// else 0, rho0 = max_distance. F has a part along the normal, which brakes, and one along the
/// sideways part of v, which leads around the obstacle. The factor (1 - p / rho0)^2 is not in the
/// source: with it F fades to 0 where the obstacle leaves the field. p is floored at min_distance,
/// so F is finite and its normal part outward in contact. F is continuous in p, n and v.
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

  /// U in N m at x (m) from the obstacle, with relative velocity v (m/s).
  double Potential(const Eigen::Vector3d& x, const Eigen::Vector3d& v) const;
  /// F in N at a signed distance along `normal`.
  Eigen::Vector3d Force(double distance, const Eigen::Vector3d& normal,
                        const Eigen::Vector3d& v) const;

 private:
  const Params params_;
  const double worst_;  ///< the largest over c of d(|v| (-c)^(exponent)) / d(-v . n)
  /// By the seen distance.
  Eigen::Vector3d SlopeOf(const Proximity& proximity, double distance,
                          const Eigen::Vector3d& v) const;
  void CalcForces(const ProximitySet& set, const LinkPoses& poses, LinkForceSet& result) const;
  void CalcSlopes(const ProximitySet& set, const LinkPoses& poses, ContactSlopes& result) const;

 public:
  const Input<ProximitySet> proximities;
  const Input<LinkPoses> links;
  const Output<LinkForceSet> forces;
  const Output<ContactSlopes> slopes;
};

}  // namespace oca::systems
