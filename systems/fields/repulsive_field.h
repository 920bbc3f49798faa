// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/repulsive_law.h"
#include "oca/systems/signals/contact_slopes.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Pushes links away from what is near them. For each proximity at distance rho
///
///     F = eta (1/rho' - 1/rho0) / rho'^2 n   if rho <= rho0, else 0;   rho' = max(rho, rho_min)
///
/// with eta = force_gain, rho0 = max_distance, rho_min = min_distance and n the normal from the
/// obstacle to the link; of own links rho counts rho0 / range times. The floor keeps the force
/// finite, continuous in rho and outward in penetration, where the formula of the source is
/// infinite at 0 and attracts below.
///
/// in    proximities  ProximitySet
/// out   forces       LinkForceSet  N  one a proximity, same order, at point_on_link
/// out   slopes       ContactSlopes    how they answer to the distances, for a LoopGain
/// state -
/// throws ConfigError if force_gain is negative, or not 0 < min_distance < max_distance
/// source Khatib 1986, section 3; report eq. (2.3), (2.5), (3.1); docs/theory.md
class RepulsiveField final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "pushes links away from near obstacles",
      "force = force_gain (1/d - 1/max_distance) / d^2 normal, d = max(distance, min_distance); 0 "
      "beyond max_distance",
      "Khatib 1986, section 3; Jain, Sixt, Exner 2016, eq. (3.1)"};
  struct Params {
    double force_gain{1.0};
    double max_distance{0.3};
    double min_distance{0.01};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {}; }

  explicit RepulsiveField(const Params& params);

 private:
  const Params params_;
  const robot::RepulsiveLaw law_;
  void CalcForces(const ProximitySet& proximity_set, LinkForceSet& force_set) const;
  void CalcSlopes(const ProximitySet& proximity_set, ContactSlopes& contact_slopes) const;

 public:
  const Input<ProximitySet> proximities;
  const Output<LinkForceSet> forces;
  const Output<ContactSlopes> slopes;
};

}  // namespace oca::systems
