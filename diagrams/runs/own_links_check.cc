// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/own_links_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/systems/signals/roles.h"
#include "oca/systems/signals/signals.h"

namespace oca::runs {
namespace {

using systems::MeasuresDistances;
using systems::Proximity;
using systems::ProximitySet;

/// The pairs of own links in `set`, each once, that are nearer than `distance` (m), or in contact.
std::vector<const Proximity*> NearOwnLinks(const ProximitySet& set, double distance) {
  std::vector<const Proximity*> near;
  for (const Proximity& pair : set.proximities) {
    if (pair.own_link.empty() || !(pair.distance <= 0.0 || pair.distance < distance)) continue;
    const bool mirrored = std::any_of(near.begin(), near.end(), [&](const Proximity* other) {
      return other->link == pair.own_link && other->own_link == pair.link;
    });
    if (!mirrored) near.push_back(&pair);
  }
  return near;
}

/// What is to be told of one block, without its place.
std::vector<std::string> TellOwnLinks(const ProximitySet& set, double self_distance) {
  std::vector<std::string> touching, near, told;
  for (const Proximity* const pair : NearOwnLinks(set, self_distance)) {
    const std::string names = fmt::format("{} and {}", pair->link.text(), pair->own_link.text());
    if (pair->distance <= 0.0) {
      touching.push_back(names);
    } else {
      near.push_back(fmt::format("{} {:.2g} m", names, pair->distance));
    }
  }
  if (!touching.empty()) {
    told.push_back(
        fmt::format("own links in contact at the start: {}; disable in the SRDF what is by design",
                    fmt::join(touching, ", ")));
  }
  if (!near.empty()) {
    told.push_back(fmt::format(
        "own links nearer at the start than self_distance, {:g} m: {}; they are asked for what "
        "the request leaves, no more",
        self_distance, fmt::join(near, ", ")));
  }
  return told;
}

}  // namespace

std::vector<std::string> OwnLinkWarnings(const loading::LoadedDiagram& loaded) {
  std::vector<std::string> warnings;
  for (const auto& [path, system, measures] : loaded.diagram->FindRoles<MeasuresDistances>()) {
    if (!measures->own_links) continue;
    std::vector<std::string> told;
    try {
      const Context context = loaded.diagram->MakeContext();
      const auto* const set =
          static_cast<const ProximitySet*>(EvalObject(measures->proximities, context));
      told = TellOwnLinks(*set, measures->self_distance);
    } catch (const std::exception&) {
      continue;  // the run will tell, with the time and the place
    }
    const auto& named = loaded.BlockOf(*system);
    for (const std::string& line : told) {
      const std::string what = loading::OverridePath(named.name) + ": " + line;
      warnings.push_back(
          Diagnostic{named.params.location(), what, Diagnostic::Kind::kWarning}.ToString());
    }
  }
  return warnings;
}

}  // namespace oca::runs
