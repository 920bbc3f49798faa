// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagrams/signal_facts.h"

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
std::vector<PlotHint> PlotHintsOf(const diagrams::LoadedDiagram& loaded,
                                  const diagrams::SignalFacts& facts);

/// A system that may hold a motion back, and the signal that shows when it does.
struct LimitHint {
  std::string system;
  std::string type;
  /// How the signal shows it: `rate` of change at `bound`, `below` the bound, `clips` or `bounds`
  /// that are listed.
  std::string kind;
  OutputHandle output;
  std::vector<double> bound{};  ///< one number, or one a joint
  Period period{};              ///< of the signal, made coarser than 10 ms; 0: the scene's
};

/// The systems of a diagram that limit: DeltaLimiter, RepulsiveField, SafetyFilter, MotionLimiter,
/// without those that are switched off. Where several signals would do, one that is recorded.
std::vector<LimitHint> LimitHintsOf(const diagrams::LoadedDiagram& loaded);

/// As JSON lists, for metadata `oca.plots`.
std::string PlotHintsJson(const diagrams::LoadedDiagram& loaded,
                          const std::vector<PlotHint>& hints);
std::string LimitHintsJson(const diagrams::LoadedDiagram& loaded,
                           const std::vector<LimitHint>& hints);

}  // namespace oca::record
