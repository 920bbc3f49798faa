// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// A step: value = initial for t <= time, final afterwards.
///
/// The switch is a discrete update at exactly `time`, so no integrator steps across it. At the
/// instant itself the rule of all discrete states holds: what updates and publishes at `time` see
/// is still `initial`; what is integrated from `time` on sees `final`. With `time` 0 everything but
/// the very first look sees `final`.
///
/// in    -
/// out   value  n  `unit`
/// state value  n
/// throws ConfigError if time is negative, a number is not finite or lists differ in length
class StepSource final : public System {
 public:
  static constexpr SystemDoc kDoc{"a step in time", "value = t <= time ? initial : final", ""};
  struct Params {
    Period time{};
    PerComponent initial{0.0};
    PerComponent final{1.0};
    std::string unit{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.time = Period(1, 2)}; }

  explicit StepSource(const Params& params);

 private:
  const Params params_;
  const DiscreteState<Vector> value_;
  void Initialize(double time, MutableVectorView next) const;
  void Switch(MutableVectorView next) const;

 public:
  const Output<Vector> value;
};

}  // namespace oca::systems
