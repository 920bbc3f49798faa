// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/standing_changes.h"

#include <algorithm>
#include <cmath>

#include "oca/models/planning/obstacle_prediction.h"
#include "oca/models/robot/link_colliders.h"

namespace oca::planning {
namespace {

using geometry::Obstacle;

constexpr double kStillPlace = 1e-4;  // m, of an obstacle that stands

bool SamePlace(const Obstacle& a, const Obstacle& b) {
  return a.body == b.body && Stands(a) && Stands(b) &&
         (a.X_WO.matrix() - b.X_WO.matrix()).cwiseAbs().maxCoeff() < kStillPlace;
}

bool StandsAgain(const Obstacle& body, std::size_t place, const std::vector<Obstacle>& among) {
  // Mostly they come in the same order.
  if (place < among.size() && SamePlace(among[place], body)) return true;
  return std::any_of(among.begin(), among.end(),
                     [&](const Obstacle& other) { return SamePlace(other, body); });
}

/// A half-space, which has no ball around it, is never far.
bool Far(const Obstacle& body, const ReachBall& reach) {
  const geometry::Collider& collider = *body.body->collider;
  const double away = (body.X_WO * collider.centre() - reach.centre).norm();
  return away > reach.radius + collider.bounding_radius();
}

}  // namespace

ReachBall ReachBallOf(const robot::RobotModel& model) {
  std::vector<double> away(model.links().size(), 0.0);
  for (const robot::Joint& joint : model.joints()) {
    const bool slides = joint.type == robot::JointType::kPrismatic;
    const double range =
        slides ? std::max(std::fabs(joint.lower_limit), std::fabs(joint.upper_limit)) : 0.0;
    away[static_cast<std::size_t>(joint.child_link)] =
        away[static_cast<std::size_t>(joint.parent_link)] + joint.X_PJ.translation().norm() + range;
  }
  ReachBall reach{model.X_WB().translation(), 0.0};
  for (const robot::LinkCollider& link : robot::LinkCollidersOf(model)) {
    const double own = link.centre.norm() + link.radius;
    reach.radius = std::max(reach.radius, away[static_cast<std::size_t>(link.number)] + own);
  }
  return reach;
}

bool AllStay(const std::vector<Obstacle>& seen, const std::vector<Obstacle>& now,
             const ReachBall& reach) {
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (Stands(seen[i]) && !StandsAgain(seen[i], i, now) && !Far(seen[i], reach)) return false;
  }
  return true;
}

bool SameRest(const std::vector<Obstacle>& seen, const std::vector<Obstacle>& now,
              const ReachBall& reach) {
  return AllStay(seen, now, reach) && AllStay(now, seen, reach);
}

void FindStill(const std::vector<Obstacle>& seen, const std::vector<Obstacle>& now,
               std::vector<models::Name>& names) {
  names.clear();
  names.reserve(now.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (StandsAgain(now[i], i, seen)) names.push_back(now[i].body->id);
  }
}

}  // namespace oca::planning
