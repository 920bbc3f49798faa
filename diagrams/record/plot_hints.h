// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagrams/record/signal_facts.h"

namespace oca::record {

/// A plot that a run deserves, as the report has them: which signals, and a limit to draw.
struct PlotHint {
  std::string id;
  std::string title;
  std::string unit;
  std::vector<OutputHandle> outputs{};
  std::optional<double> limit{};
};

/// The plots that a diagram's systems suggest: requested joints, deltas and final joints (what
/// MotionMetrics judges), distances (with the range of RepulsiveField), speeds of plants. Where
/// several signals would do, one that is recorded already.
std::vector<PlotHint> PlotHintsOf(const diagrams::LoadedDiagram& loaded, const SignalFacts& facts);

/// As a JSON list, for metadata `oca.plots`.
std::string PlotHintsJson(const std::vector<PlotHint>& hints, const SignalFacts& facts);

}  // namespace oca::record
