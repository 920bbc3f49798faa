// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/runs/way_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "oca/models/planning/path_search.h"

namespace oca::runs {
namespace {

using Eigen::VectorXd;

constexpr double kWayMargin = 0.002;  // m; that a way keeps, where its ends leave it
constexpr int kRequestPieces = 200;

/// What stands all the time around one robot.
struct Standing {
  std::vector<const planning::BandBody*> bodies;
  robot::Clearance clearance;

  explicit Standing(const foresight::Foresight& scene)
      : clearance(scene.model(), scene.own_links()) {
    std::vector<robot::PlacedBody> placed;
    std::vector<int> places(scene.bodies().size(), -1);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const planning::BandBody& body = scene.bodies()[i];
      if (!body.stands) continue;
      places[i] = static_cast<int>(placed.size());
      placed.push_back(body.At(0.0));
      bodies.push_back(&body);
    }
    clearance.SetBodies(std::move(placed));
    // Own links are asked for no more than their range.
    clearance.KeepOwn(scene.Task().own, kWayMargin);
    for (const auto& [link, body] : scene.ignored()) {
      if (places[static_cast<std::size_t>(body)] >= 0) {
        clearance.Ignore(link, places[static_cast<std::size_t>(body)]);
      }
    }
  }

  double RoomAt(const VectorXd& q) {
    clearance.MoveTo(q);
    return clearance.Nearest(2.0 * kWayMargin).distance;
  }

  std::string NearestText(const VectorXd& q) {
    clearance.MoveTo(q);
    const robot::NearPair pair = clearance.Nearest();
    if (pair.link < 0) return "";
    const auto& links = clearance.model().links();
    const models::Name other = pair.body >= 0
                                   ? bodies[static_cast<std::size_t>(pair.body)]->name
                                   : links[static_cast<std::size_t>(pair.other_link)].name;
    return fmt::format("; there {} and {} are {:.3g} m apart",
                       links[static_cast<std::size_t>(pair.link)].name.text(), other.text(),
                       pair.distance / pair.scale);
  }
};

bool RequestIsClear(const foresight::Foresight& scene, planning::CertifiedMotion& motion) {
  const double end = scene.request().times().back();
  VectorXd last = scene.start();
  for (int i = 0; i <= kRequestPieces; ++i) {
    VectorXd next = scene.request().Evaluate(end * i / kRequestPieces, 0);
    if (!motion.Clear(last, next)) return false;
    last = std::move(next);
  }
  return true;
}

}  // namespace

std::optional<std::string> NoWayText(const foresight::Foresight& scene) {
  Standing standing(scene);
  if (standing.bodies.empty() && standing.clearance.own_pairs().empty()) return std::nullopt;
  const robot::RobotModel& model = *scene.model();
  const VectorXd goal =
      scene.request().goal().cwiseMax(model.lower_limits()).cwiseMin(model.upper_limits());
  const double room = std::min(standing.RoomAt(scene.start()), standing.RoomAt(goal));
  if (!(room > 0.0)) return std::nullopt;
  const double margin = std::min(kWayMargin, 0.5 * room);
  planning::CertifiedMotion motion(standing.clearance, margin);
  if (RequestIsClear(scene, motion)) return std::nullopt;
  planning::PathSearch search;
  search.Begin(scene.start(), goal, true, {.margins = {margin}}, 0);
  long looks = 0;
  search.Continue(standing.clearance, std::numeric_limits<long>::max(), looks);
  if (search.state() == planning::PathSearch::State::kFound) return std::nullopt;
  return fmt::format(
      "no way to the end of the request was found among what stands, in {} configurations: the "
      "nearest place that was reached is {:.3g} away from it (2-norm of the joints){}",
      looks, search.nearest_distance(), standing.NearestText(search.nearest()));
}

}  // namespace oca::runs
