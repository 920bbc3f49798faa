// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/run_params.h"

namespace oca::files {

void SimulatorParams::Describe(Fields<SimulatorParams>& fields) {
  fields.Add("duration", &SimulatorParams::duration, "s", "how long to run")
      .AtLeast(0.0)
      .AtMost(1e7);
  fields.Include(&SimulatorParams::integration);
  fields
      .Add("realtime_factor", &SimulatorParams::realtime_factor, "",
           "simulated seconds to a second of the wall clock; 0 runs as fast as possible")
      .AtLeast(0.0);
  fields.Add("seed", &SimulatorParams::seed, "", "of everything random in the run").AtLeast(0.0);
}

void ExpectParams::Describe(Fields<ExpectParams>& fields) {
  fields.Add("at_least", &ExpectParams::at_least, "", "lower bound");
  fields.Add("at_most", &ExpectParams::at_most, "", "upper bound");
  fields.Add("equal", &ExpectParams::equal, "", "value, give or take `within`");
  fields.Add("within", &ExpectParams::within, "", "distance from `equal` that is allowed")
      .AtLeast(0.0);
  fields.Add("at", &ExpectParams::at, "s", "when to look; the end of the run if left out")
      .AtLeast(0.0);
}

}  // namespace oca::files
