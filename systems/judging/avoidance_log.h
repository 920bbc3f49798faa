// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Writes one line a period to the log, at debug level: the closest pair, the largest force and the
/// largest delta, each if its input is connected. Formats nothing if nobody reads it.
///
/// in    proximities  ProximitySet  optional
/// in    forces       LinkForceSet  N  optional
/// in    delta        n  any  optional
/// out   -
/// state -
/// throws ConfigError if period is not positive
/// source report, Listing A.1, print_infos
class AvoidanceLog final : public System {
 public:
  static constexpr SystemDoc kDoc{"logs closest pair, largest force and largest delta",
                                  "one line a period at debug level",
                                  "Jain, Sixt, Exner 2016, Listing A.1, print_infos"};
  struct Params {
    Period period{};
    bool enabled{true};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100), .enabled = true}; }

  explicit AvoidanceLog(const Params& params);

 private:
  void WriteLine(double time, Log& log, const ProximitySet* proximity_set,
                 const LinkForceSet* force_set, std::optional<VectorView> delta_value) const;

 public:
  const OptionalInput<ProximitySet> proximities;
  const OptionalInput<LinkForceSet> forces;
  const OptionalInput<Vector> delta;
};

}  // namespace oca::systems
