// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "oca/diagrams/files/catalogue.h"
#include "oca/diagrams/files/document.h"
#include "oca/framework/dataflow/value.h"

namespace oca::sampling {

/// A diagram file with a section `sampling` stands for a family of scenarios; `simulator.seed` says
/// which one it is. DrawScenario makes a plain diagram of it.
///
///     sampling:
///       draw:                        # parameter: distribution.h
///         base_height: {uniform: [0.4, 1.0], step: 0.05}
///       obstacles: ...               # random_obstacles.h; added to those of systems.obstacles
///       accept:                      # all must hold, else the scenario is drawn again
///         home_distance: {at_least: 0.15}
///       tries: 10000
///
/// Scenario number k = 0, 1, ... of a seed is a pure function of file, seed and k; the first one
/// that is accepted counts. Every parameter has a sequence of its own, so to set one of them from
/// outside does not change what the others draw.

/// What was drawn, for people and records.
struct Scenario {
  int tries{0};           ///< drawn until one was accepted; 0: the file has no section `sampling`
  Value::Map parameters;  ///< drawn, with their values
  int obstacles{0};       ///< drawn
};

/// Replaces the drawn parameters of `document` by their values, appends the drawn obstacles and
/// takes the section `sampling` out. Parameters that an override sets keep their value. What is
/// wrong is added to `problems`, and if no scenario is accepted, how often each condition refused.
Scenario DrawScenario(const std::vector<files::Override>& overrides,
                      const files::Catalogue& catalogue, Value& document, Problems& problems);

/// JSON Schema of the section.
nlohmann::ordered_json SamplingSchema();

}  // namespace oca::sampling
