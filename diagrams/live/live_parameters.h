// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/files/document.h"
#include "oca/diagrams/live/live_server.h"
#include "oca/diagrams/loading/loader.h"

namespace oca::live {

/// An obstacle that stands still (systems::HoldsObstacles): where the file has its position, and
/// what moves it.
struct Standing {
  std::string path;
  std::vector<double> position;  ///< m, as the file has it
  std::string input;             ///< exported, of its source
  std::size_t first;             ///< of its three numbers there
};

/// Those of a diagram by the names of the parameters that say where they are: `PATH.ID.position`,
/// PATH being that of the block which holds the obstacle.
std::vector<std::pair<std::string, Standing>> StandingObstacles(
    const loading::LoadedDiagram& loaded);

/// What a user may change in a diagram while it runs: the numbers and switches of its section
/// `parameters` by name, and the position (m, world) of each obstacle that stands still, as
/// `left.obstacles.box.position`.
std::vector<LiveParameter> LiveParametersOf(const loading::LoadedDiagram& loaded);
/// How far parameters may go, by name, as `[lower, upper]` in JSON with null for no bound: as far
/// as the fields of systems that are set to `${name}` and nothing else.
record::Texts RangesOf(const loading::LoadedDiagram& loaded);
/// The override that a change of such a parameter means.
/// throws ConfigError if there is no such parameter.
files::Override OverrideOf(const loading::LoadedDiagram& loaded, const LiveParameter& change);

}  // namespace oca::live
