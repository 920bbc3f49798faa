// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"

namespace oca::systems {

/// value = offset + amplitude sin(2 pi frequency t + phase), component by component.
///
/// in    -
/// out   value  n  `unit`
/// state -
/// throws ConfigError if a number is not finite or lists differ in length
class SineSource final : public System {
 public:
  static constexpr SystemDoc kDoc{"sine of time",
                                  "value = offset + amplitude sin(2 pi frequency t + phase)", ""};
  struct Params {
    PerComponent amplitude{1.0};
    PerComponent frequency{1.0};
    PerComponent phase{0.0};
    PerComponent offset{0.0};
    std::string unit{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.amplitude = 2.0, .frequency = 0.5}; }

  explicit SineSource(const Params& params);

 private:
  const Params params_;
  void CalcValue(double time, MutableVectorView out) const;

 public:
  const Output<Vector> value;
};

}  // namespace oca::systems
