// SPDX-License-Identifier: BSD-3-Clause
// What BulletDistance tells who measures on his own: all that is around the robot, and what of it
// does not count.
#include <variant>

#include "oca/models/robot/robot_model.h"
#include "oca/systems/sensing/bullet_distance.h"

namespace oca::systems {
namespace {

/// All solids of a link in its frame.
geometry::Compound WholeLink(const robot::Link& link) {
  geometry::Compound whole;
  for (const robot::CollisionElement& element : link.collisions) {
    const auto* const parts = std::get_if<geometry::Compound>(&element.shape);
    if (parts == nullptr) {
      whole.parts.push_back({element.X_LC, element.shape});
      continue;
    }
    for (geometry::CompoundPart part : parts->parts) {
      part.X_SP = element.X_LC * part.X_SP;
      whole.parts.push_back(std::move(part));
    }
  }
  return whole;
}

}  // namespace

std::vector<std::shared_ptr<const ObstacleBody>> BulletDistance::MakeSolids(
    const robot::RobotModel& model, const std::vector<Neighbour>& links) {
  std::vector<std::shared_ptr<const ObstacleBody>> solids;
  for (const Neighbour& link : links) {
    const auto number = static_cast<std::size_t>(link.collider.number);
    const geometry::Shape whole = WholeLink(model.links()[number]);
    solids.push_back(std::make_shared<const ObstacleBody>(ObstacleBody{
        .id = link.name, .collider = geometry::MakeCollider(whole, link.name.text())}));
  }
  return solids;
}

void BulletDistance::CalcIgnored(IgnoredPairs& result) const {
  result.pairs = ignored_;
  if (!link_forces_) return;
  for (const LinkCollider& link : movable_) {
    if (model_->body(link.number) != model_->bodies().front()) continue;
    for (const Other& other : others_) {
      for (const Neighbour& neighbour : other.links) {
        if (neighbour.lowest) result.pairs.emplace_back(link.link, neighbour.name);
      }
    }
  }
}

void BulletDistance::FindAround(const ObstacleSet& set, std::span<const LinkPoses* const> others,
                                ObstacleSet& result) const {
  result = set;
  if (!link_forces_ || others_.empty()) return;
  // A layout is that of the obstacles alone.
  result.layout = 0;
  result.moving.clear();
  for (std::size_t i = 0; i < others_.size(); ++i) {
    if (i < others.size()) CheckVelocities(others_[i], *others[i]);
    for (std::size_t k = 0; k < others_[i].links.size(); ++k) {
      const Neighbour& link = others_[i].links[k];
      Obstacle solid{.body = others_[i].solids[k], .X_WO = link.X};
      if (i < others.size()) {
        const int at = others[i]->Find(link.collider.link, link.collider.number);
        if (at < 0) continue;
        const auto place = static_cast<std::size_t>(at);
        solid.X_WO = others[i]->poses[place];
        solid.linear = others[i]->velocities[place].linear;
        solid.angular = others[i]->velocities[place].angular;
      }
      result.obstacles.push_back(std::move(solid));
      if (!result.estimates.empty()) result.estimates.emplace_back();
    }
  }
}

}  // namespace oca::systems
