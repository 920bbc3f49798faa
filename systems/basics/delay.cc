// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/basics/delay.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "oca/framework/dataflow/error.h"

namespace oca::systems {
namespace {

Delay::Params Checked(const Delay::Params& params) {
  Validated(params);
  if (params.delay.positive() && params.steps != 0) {
    throw ConfigError("steps: given twice; got delay too; expected one of the two");
  }
  return params;
}

/// Whether delay = steps * period, exactly.
bool Is(const Period& delay, std::int64_t steps, const Period& period) {
  if (period.numerator() > std::numeric_limits<std::int64_t>::max() / steps) return false;
  return delay == Period(period.numerator() * steps, period.denominator());
}

int StepsOf(const Delay::Params& params) {
  const bool timed = params.delay.positive();
  const double steps =
      timed ? std::round(params.delay.seconds() / params.period.seconds()) : params.steps;
  if (steps < 1.0 || steps > Delay::kMostSteps) {
    throw ConfigError(fmt::format("{}: number of periods; got {}; expected 1 to {}",
                                  timed ? "delay" : "steps", steps, Delay::kMostSteps));
  }
  if (timed && !Is(params.delay, static_cast<std::int64_t>(steps), params.period)) {
    throw ConfigError(
        fmt::format("delay: no whole number of periods; got {}; expected a multiple of {}",
                    params.delay.ToString(), params.period.ToString()));
  }
  return static_cast<int>(steps);
}

}  // namespace

void Delay::Params::Describe(Fields<Params>& fields) {
  fields.Add("period", &Params::period, "s", "time between samples").Above(0.0).Required();
  fields.Add("delay", &Params::delay, "s", "a whole number of periods").AtLeast(0.0);
  fields.Add("steps", &Params::steps, "", "number of periods, instead of delay")
      .AtLeast(0)
      .AtMost(kMostSteps);
  fields.Add("initial", &Params::initial, "", "output until the first sample arrives");
}

Delay::Delay(const Params& params)
    : params_(Checked(params)),
      steps_(StepsOf(params_)),
      size_(DeclareSize({{"initial", &params_.initial}})),
      unit_(DeclareUnit()),
      line_(DeclareDiscreteState("line", DelayLine())),
      in(DeclareInput<Vector>("in", {size_, unit_})),
      out(DeclareOutput<Vector, &Delay::CalcOut>("out", {size_, unit_}, line_)) {
  DeclareUpdate<&Delay::Update>(Every{params_.period}, Writes(line_), in);
}

void Delay::CalcOut(const DelayLine& line, MutableVectorView out_value) const {
  if (!line.empty()) {
    out_value = line.oldest();
    return;
  }
  for (Eigen::Index i = 0; i < out_value.size(); ++i) out_value[i] = params_.initial[i];
}

void Delay::Update(VectorView in_value, DelayLine& next) const {
  // The length is known only here, when a simulator takes the capacity or at the first tick.
  if (next.empty()) next.Fill(static_cast<std::size_t>(steps_), in_value.size(), params_.initial);
  next.Push(in_value);
}

}  // namespace oca::systems
