// SPDX-License-Identifier: BSD-3-Clause
// What of a model BulletDistance looks at: where it looks at nothing, it must not be taken to say
// that nothing is near.
#include <fmt/format.h>

#include <algorithm>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/unseen_links.h"
#include "oca/systems/sensing/bullet_distance.h"

namespace oca::systems {

std::vector<LinkCollider> BulletDistance::MakeMovable() const {
  std::vector<LinkCollider> colliders = MakeLinkColliders(*model_);
  std::erase_if(colliders, [&](const LinkCollider& link) { return model_->body(link.number) < 0; });
  if (!colliders.empty()) return colliders;
  throw ConfigError(
      fmt::format("model: got '{}', which cannot avoid anything: {}", name_,
                  robot::DescribeUnseen(
                      *model_, fmt::format("models.{}.visual_as_collision: missing", name_))));
}

bool BulletDistance::LooksAt(const LinkCollider& link, const Neighbour& own) const {
  const int number = own.collider.number;
  return !model_->adjacent(link.number, number) &&
         !model_->collision_disabled(link.number, number) && !Ignored(link.link, own.name);
}

bool BulletDistance::LooksAtLinks() const {
  const int lowest = model_->bodies().front();
  return std::any_of(movable_.begin(), movable_.end(), [&](const LinkCollider& link) {
    const bool at_own = std::any_of(own_.begin(), own_.end(),
                                    [&](const Neighbour& own) { return LooksAt(link, own); });
    if (at_own || !link_forces_) return at_own;
    return std::any_of(others_.begin(), others_.end(), [&](const Other& other) {
      return std::any_of(other.links.begin(), other.links.end(), [&](const Neighbour& neighbour) {
        const bool left_out = neighbour.lowest && model_->body(link.number) == lowest;
        return !left_out && !Ignored(link.link, neighbour.name);
      });
    });
  });
}

bool BulletDistance::Compares(const LinkPoses& poses, const ObstacleSet& set) const {
  return std::any_of(movable_.begin(), movable_.end(), [&](const LinkCollider& link) {
    if (poses.Find(link.link, link.number) < 0) return false;
    return at_links_ ||
           std::any_of(set.obstacles.begin(), set.obstacles.end(), [&](const Obstacle& obstacle) {
             return !Ignored(link.link, obstacle.body->id);
           });
  });
}

}  // namespace oca::systems
