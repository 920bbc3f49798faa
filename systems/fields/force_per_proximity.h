// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <optional>

#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/params.h"
#include "oca/systems/signals/contact_slopes.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

// What fields share that make a force of each proximity within their range.

/// Describes the parameters max_distance and min_distance.
template <class P>
void AddRange(Fields<P>& fields) {
  fields
      .Add("max_distance", &P::max_distance, "m",
           "limit distance rho0 of the field, beyond which the force is 0")
      .Above(0.0);
  fields
      .Add("min_distance", &P::min_distance, "m",
           "distance below which the force stays the same, so that it is finite in contact")
      .Above(0.0);
}

/// The parameters. throws ConfigError if one is out of its bounds or not
/// min_distance < max_distance
template <class P>
P WithRange(const P& params) {
  Validated(params);
  if (params.min_distance < params.max_distance) return params;
  throw ConfigError(fmt::format("min_distance: got {} m; expected less than max_distance, {} m",
                                params.min_distance, params.max_distance));
}

/// The distance as a field of that max_distance sees it: own links begin to count at their range,
/// and up to contact with the same forces as others from max_distance on. Slopes by the distance
/// are those by the seen one, divided by the share.
inline double SeenDistance(const Proximity& proximity, double max_distance) {
  return proximity.distance / robot::RangeShare(proximity, max_distance);
}

/// One force a proximity, in the same order, at its point on the link: force_of(proximity), N.
template <class ForceOf>
void ForcePerProximity(const ProximitySet& set, LinkForceSet& result, const ForceOf& force_of) {
  result.forces.clear();
  result.forces.reserve(set.proximities.capacity());  // so no later tick allocates
  for (const Proximity& proximity : set.proximities) {
    result.forces.push_back(
        {proximity.link, proximity.obstacle, force_of(proximity), proximity.point_on_link});
  }
}

/// slope_of(proximity) is a std::optional<ContactSlope>, without a value if the force is 0 there.
template <class SlopeOf>
void SlopePerProximity(const ProximitySet& set, ContactSlopes& result, const SlopeOf& slope_of) {
  result.slopes.clear();
  result.slopes.reserve(set.proximities.capacity());
  for (const Proximity& proximity : set.proximities) {
    if (const std::optional<ContactSlope> slope = slope_of(proximity)) {
      result.slopes.push_back(*slope);
    }
  }
}

}  // namespace oca::systems
