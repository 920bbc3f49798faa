// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/motion_ahead.h"

#include <fmt/format.h>

#include <set>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/systems/signals/request_ahead.h"

namespace oca::foresight {
namespace {

using Ahead = Output<systems::RequestAhead>;

void AddAheadOf(const System& system, std::vector<Ahead>& found) {
  for (const System::OutputInfo& output : system.outputs()) {
    if (output.type != &TypeOf<systems::RequestAhead>()) continue;
    found.push_back(Typed<systems::RequestAhead>(system.FindOutput(output.name)));
  }
}

double TickNotBefore(const Period& period, double time) {
  const double tick = period.seconds(period.CountAt(time));
  return tick == time ? tick : period.TickAfter(time);
}

}  // namespace

MotionAhead MotionAheadOf(const Diagram& diagram, const OutputHandle& output,
                          const std::string& where) {
  const auto upstream = diagram.UpstreamOf(output, Through::kStates).outputs;
  std::set<const System*> seen;
  for (auto entry = upstream.begin(); entry != upstream.end();) {
    std::vector<Ahead> found;  // all that are as near as this one
    for (const int near = entry->connections; entry != upstream.end() && entry->connections == near;
         ++entry) {
      const System& system = *entry->output.system;
      if (seen.insert(&system).second) AddAheadOf(system, found);
    }
    if (found.size() > 1) {
      throw ConfigError(fmt::format("{}: motion ahead; got both of '{}' and '{}'; expected one",
                                    where, diagram.PathOf(*found[0].system),
                                    diagram.PathOf(*found[1].system)));
    }
    if (found.empty()) continue;
    const Context context = diagram.MakeContext();
    const systems::RequestAhead& known = found[0].Eval(context);
    if (!known.trajectory) continue;
    if (known.trajectory->size() != diagram.SizeOf(output)) {
      throw ConfigError(fmt::format("{}: length of '{}'; got {} joints; expected {}", where,
                                    diagram.PathOf(*found[0].system), known.trajectory->size(),
                                    diagram.SizeOf(output)));
    }
    return {known.trajectory, known.period, found[0].system};
  }
  throw ConfigError(fmt::format(
      "{}: motion ahead; got '{}', up the line from which nobody knows it; expected a source with "
      "the output `ahead`, as splines have it",
      where, diagram.PathOf(*output.system)));
}

PositionsAhead PositionsAheadOf(const Diagram& diagram, const OutputHandle& output, Samples samples,
                                const std::string& where) {
  if (!diagram.UpstreamOf(output, Through::kInstant).of_time_alone()) {
    const MotionAhead ahead = MotionAheadOf(diagram, output, where);
    const Period period = samples == Samples::kShown ? ahead.period : Period();
    const auto at = [motion = ahead.motion, period](double time) {
      return motion->Evaluate(period.positive() ? TickNotBefore(period, time) : time, 0);
    };
    return {at, ahead.source, true};
  }
  const auto context = std::make_shared<Context>(diagram.MakeContext());
  const auto vector = Typed<Vector>(output);
  const auto at = [context, vector](double time) {
    context->SetTime(time);
    return Eigen::VectorXd(vector.Eval(*context));
  };
  return {at, output.system, false};
}

}  // namespace oca::foresight
