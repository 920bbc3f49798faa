// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/sine_source.h"

#include <cmath>
#include <numbers>

namespace oca::systems {
void SineSource::Params::Describe(Fields<Params>& fields) {
  fields.Add("amplitude", &Params::amplitude, "", "largest deviation from the offset");
  fields.Add("frequency", &Params::frequency, "Hz", "oscillations a second");
  fields.Add("phase", &Params::phase, "rad", "angle at time 0");
  fields.Add("offset", &Params::offset, "", "mean");
  fields.Add("unit", &Params::unit, "", "unit of the value; absent: connects to any");
}

SineSource::SineSource(const Params& params)
    : params_(Validated(params)),
      value(DeclareOutput<Vector, &SineSource::CalcValue>(
          "value",
          {DeclareSize({{"amplitude", &params_.amplitude},
                        {"frequency", &params_.frequency},
                        {"phase", &params_.phase},
                        {"offset", &params_.offset}}),
           Unit(params_.unit)},
          kTime)) {}

void SineSource::CalcValue(double time, MutableVectorView out) const {
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const double angle = 2.0 * std::numbers::pi * params_.frequency[i] * time + params_.phase[i];
    out[i] = params_.offset[i] + params_.amplitude[i] * std::sin(angle);
  }
}

}  // namespace oca::systems
