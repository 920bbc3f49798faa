// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/foresight/reference_length.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "oca/models/planning/shortest_path.h"
#include "oca/models/robot/clearance.h"

namespace oca::foresight {

std::optional<double> ReferenceLength(const Foresight& scene, double seconds) {
  constexpr std::uint64_t kSearches = 10;
  std::vector<robot::PlacedBody> bodies;
  for (const planning::BandBody& body : scene.bodies()) {
    if (!body.stands) return std::nullopt;
    bodies.push_back({body.collider, body.pose(0.0)});
  }
  robot::Clearance clearance(scene.model(), scene.own_links(), bodies);
  for (const auto& [link, body] : scene.ignored()) clearance.Ignore(link, body);
  const Eigen::VectorXd goal = scene.request().Evaluate(scene.duration(), 0);
  std::optional<double> least;
  for (std::uint64_t seed = 0; seed < kSearches; ++seed) {
    const auto path =
        planning::ShortestPath(clearance, scene.start(), goal,
                               {.rrt = {.seed = seed, .margin = 0.001}, .seconds = seconds});
    if (!path) continue;
    const double length = planning::PathLength(*path);
    least = std::min(length, least.value_or(length));
  }
  return least;
}

}  // namespace oca::foresight
