// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "oca/diagrams/loading/loader.h"

namespace oca::record {

/// A plot that a run deserves, as the report has them: which signals, and a limit to draw.
struct PlotHint {
  std::string id{};
  std::string title{};
  std::string unit{};
  std::vector<OutputHandle> outputs{};
  std::optional<double> limit{};
};

/// The plots that a diagram's systems declare (systems::Plots), with the range of its fields as the
/// limit of `distance`. Where several signals would do, one that is recorded already.
std::vector<PlotHint> PlotHintsOf(const loading::LoadedDiagram& loaded);

/// A system that may hold a motion back, and the signal that shows when it does.
struct LimitHint {
  std::string system{};
  std::string type{};
  /// How the signal shows it: `rate` of change at the bound, `below` or `above` it, or else the
  /// member that lists what is active.
  std::string kind{};
  OutputHandle output{};
  std::vector<double> bound{};  ///< one number, or one a joint
  std::string member{};         ///< that is compared, of a signal that is no Vector
  std::string how{};            ///< what the system does then, if it says so
  Period period{};              ///< of the signal, made coarser than 10 ms; 0: the scene's
};

/// The systems of a diagram that limit (systems::Limits). Where several signals would do, one that
/// is recorded.
std::vector<LimitHint> LimitHintsOf(const loading::LoadedDiagram& loaded);

/// As JSON lists, for metadata `oca.plots`.
std::string PlotHintsJson(const loading::LoadedDiagram& loaded, const std::vector<PlotHint>& hints);
std::string LimitHintsJson(const loading::LoadedDiagram& loaded,
                           const std::vector<LimitHint>& hints);

}  // namespace oca::record
