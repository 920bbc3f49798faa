// SPDX-License-Identifier: BSD-3-Clause
// What a BandReplanner makes of the obstacles that it sees, for its planner.
#include <algorithm>

#include "oca/models/planning/band_replanner.h"
#include "oca/models/planning/obstacle_prediction.h"
#include "oca/models/robot/proximity.h"

namespace oca::planning {

std::vector<BandBody> BandReplanner::MakeBodies(const BandSituation& now,
                                                Estimates estimates) const {
  std::vector<BandBody> bodies;
  for (const geometry::Obstacle& obstacle : now.obstacles) {
    const bool stands = Stands(obstacle) || settings_.prediction == 0.0;
    const auto pose = [obstacle, time = now.time, longest = settings_.prediction,
                       stands](double t) {
      return stands ? obstacle.X_WO : Foreseen(obstacle, std::clamp(t - time, 0.0, longest));
    };
    bodies.push_back({obstacle.body->id, obstacle.body->collider, pose, stands});
    if (!estimates.empty()) {
      Estimate(now.time, obstacle, estimates[bodies.size() - 1], bodies.back());
    }
    if (now.ignored == nullptr) continue;
    for (const auto& [link, other] : *now.ignored) {
      if (other == obstacle.body->id)
        bodies.back().ignored.push_back(robot::NumberOfLink(*model_, link));
    }
  }
  return bodies;
}

void BandReplanner::Estimate(double time, const geometry::Obstacle& obstacle,
                             const geometry::ObstacleEstimate& estimate, BandBody& body) const {
  const auto ahead = [time, longest = settings_.prediction](double t) {
    return std::clamp(t - time, 0.0, longest);
  };
  if (!estimate.covariance.isZero(0.0)) {
    body.covariance = [estimate, ahead, stands = body.stands](double t) -> Eigen::Matrix3d {
      return CovarianceAhead(estimate, stands ? 0.0 : ahead(t));
    };
  }
  if (body.stands) return;
  body.pose = [obstacle, estimate, ahead](double t) {
    return LikelyAhead(obstacle, estimate, ahead(t)).X_WO;
  };
}

void BandReplanner::IgnoreOwnLinks(const BandSituation& now, BandPlanner& planner) const {
  if (now.ignored == nullptr || !settings_.self_collision) return;
  for (const auto& [link, other] : *now.ignored) {
    if (!other.text().starts_with(settings_.own_prefix)) continue;
    const models::Name own(other.text().substr(settings_.own_prefix.size()));
    const auto& links = model_->links();
    const auto at = std::find_if(links.begin(), links.end(),
                                 [&](const robot::Link& each) { return each.name == own; });
    if (at == links.end()) continue;  // of another robot
    planner.IgnoreOwn(robot::NumberOfLink(*model_, link), static_cast<int>(at - links.begin()));
  }
}

}  // namespace oca::planning
