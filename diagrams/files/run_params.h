// SPDX-License-Identifier: BSD-3-Clause
// Sections that say how a diagram is run, apart from those that need robots and shapes to be read.
#pragma once

#include <optional>

#include "oca/framework/dataflow/integrator_options.h"
#include "oca/framework/dataflow/params.h"

namespace oca::files {

/// Section `simulator`.
struct SimulatorParams {
  double duration{10.0};
  IntegratorOptions integration{};
  int seed{0};
  double realtime_factor{0.0};
  static void Describe(Fields<SimulatorParams>& fields);
};

/// An entry of `expect`: a bound on a metric or a signal.
struct ExpectParams {
  std::optional<double> at_least{};
  std::optional<double> at_most{};
  std::optional<double> equal{};
  double within{0.0};
  std::optional<double> at{};
  static void Describe(Fields<ExpectParams>& fields);
};

}  // namespace oca::files
