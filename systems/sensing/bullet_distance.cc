// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/sensing/bullet_distance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/basics/shared_params.h"
#include "oca/systems/sensing/distance_blind_spots.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/roles.h"

namespace oca::systems {
namespace {

constexpr std::size_t kMostMoving = 8;

/// Calls `declare` with std::index_sequence<0, ..., count - 1>; count <= kMostMoving.
template <std::size_t kCount = 0, class Declare>
auto WithIndices(std::size_t count, const Declare& declare) {
  if constexpr (kCount < kMostMoving) {
    if (count > kCount) return WithIndices<kCount + 1>(count, declare);
  }
  return declare(std::make_index_sequence<kCount>());
}

template <std::size_t>
using PosesOfOne = LinkPoses;  // as many as there are indices

Proximity ToProximity(models::Name link, models::Name obstacle,
                      const geometry::SignedDistance& found) {
  Proximity proximity{link, obstacle};
  proximity.distance = found.distance;
  proximity.point_on_link = found.point_a;
  proximity.point_on_obstacle = found.point_b;
  proximity.normal = found.normal;
  return proximity;
}

// The same pair from the other side.
Proximity Mirrored(const Proximity& pair, models::Name obstacle) {
  Proximity mirrored{pair.own_link, obstacle};
  mirrored.distance = pair.distance;
  mirrored.point_on_link = pair.point_on_obstacle;
  mirrored.point_on_obstacle = pair.point_on_link;
  mirrored.normal = -pair.normal;
  mirrored.own_link = pair.link;
  mirrored.range = pair.range;
  return mirrored;
}

/// What the distance along `normal` to an obstacle of a set counts for less, m.
double UncertaintyOf(const ObstacleSet& set, int place, const Eigen::Vector3d& normal) {
  if (set.estimates.empty()) return 0.0;
  const ObstacleEstimate& estimate = set.estimates[static_cast<std::size_t>(place)];
  return geometry::Uncertainty(estimate.PositionCovariance(), normal);
}

// Bound on the speed of all points of a link; 0 if its pose does not come in.
double SpeedOf(const LinkCollider& link, const LinkPoses& poses) {
  const int at = poses.Find(link.link, link.number);
  if (at < 0) return 0.0;
  const robot::LinkVelocity& V = poses.velocities[at];
  return SpeedBound(V.linear, V.angular, poses.poses[at], {link.centre, link.radius});
}

}  // namespace

void BulletDistance::Params::Describe(Fields<Params>& fields) {
  AddModel(fields);
  fields.Add("max_distance", &Params::max_distance, "m", "distance beyond which pairs are left out")
      .Above(0.0);
  fields.Add("ignore", &Params::ignore, "",
             "pairs [link, obstacle id or model/link] that are left out");
  fields.Add("calculate_link_forces", &Params::calculate_link_forces, "",
             "whether links of other robots and frames count as obstacles");
  fields.Add("self_collision", &Params::self_collision, "",
             "whether links of the robot itself count as obstacles, but for adjacent ones and "
             "those disabled in the SRDF");
  fields
      .Add("self_distance", &Params::self_distance, "m",
           "most that is asked of the distance of own links, where the request leaves it; 0: as "
           "much as of obstacles")
      .AtLeast(0.0);
  fields.Add("others", &Params::others, "",
             "models whose links count as obstacles; [\"*\"]: all others in sight of the file");
}

BulletDistance::BulletDistance(const Params& params, const ModelSet& models)
    : name_(models.FullName(Validated(params).model)),
      model_(MovableModel(models, params.model)),
      max_distance_(params.max_distance),
      self_collision_(params.self_collision),
      self_distance_(params.self_distance),
      link_forces_(params.calculate_link_forces),
      movable_(MakeMovable()),
      own_(self_collision_ ? MakeNeighbours(name_, *model_) : std::vector<Neighbour>()),
      others_(MakeOthers(params, models)),
      moving_others_(
          std::count_if(others_.begin(), others_.end(),
                        [](const Other& other) { return other.model->num_positions() > 0; })),
      ignored_(MakeIgnored(params, models)),
      at_links_(LooksAtLinks()),
      links(DeclareInput<LinkPoses>("links")),
      obstacles(DeclareInput<ObstacleSet>("obstacles")),
      ahead(DeclareOptionalInput<RequestAhead>("ahead")),
      links_of_others(DeclareOtherLinks()),
      scene_(DeclareCached<&BulletDistance::CalcScene>(obstacles)),
      near_(DeclareCached<&BulletDistance::CalcNear>(links, scene_)),
      asked_(DeclareCached<&BulletDistance::CalcAsked>(ahead)),
      proximities(DeclareProximities(link_forces_ ? moving_others_ : 0)),
      ignored(DeclareOutput<IgnoredPairs, &BulletDistance::CalcIgnored>("ignored", {})),
      around(DeclareAround(link_forces_ ? moving_others_ : 0)) {
  DeclareRoles(params, models);
}

void BulletDistance::DeclareRoles(const Params& params, const ModelSet& models) {
  MeasuresDistances measures{.proximities = proximities,
                             .obstacles = obstacles,
                             .model = name_,
                             .own_links = self_collision_,
                             .self_distance = self_distance_};
  const auto add = [&](const std::string& name) {
    std::size_t i = 0;
    while (others_[i].name != name) ++i;
    const bool moves = i < links_of_others.size();
    measures.others.push_back({name, moves ? InputHandle(links_of_others[i]) : InputHandle{}});
  };
  if (link_forces_ && LooksAtAll(params)) {
    for (const Other& other : others_) add(other.name);
  } else if (link_forces_) {
    for (const std::string& name : params.others) add(models.FullName(name));
  }
  for (const auto& pair : params.ignore) {
    measures.ignored.emplace_back(pair[0], FullLinkName(models, pair[1]));
  }
  DeclareRole(std::move(measures));
  DeclareRole(BlindSpots{.spots =
                             [params, models](const std::string& own_name, bool one_robot) {
                               return DistanceBlindSpots(params, models, own_name, one_robot);
                             },
                         .behind = obstacles});
  if (const std::string unseen = OutOfSight(params, models); !unseen.empty()) {
    DeclareRole(Remarks{.warnings = {unseen}});
  }
  DeclareRole(Plots{.id = "distance", .title = "Distances", .signal = proximities, .unit = "m"});
}

std::vector<Input<LinkPoses>> BulletDistance::DeclareOtherLinks() {
  if (moving_others_ > kMostMoving) {
    throw ConfigError(
        fmt::format("others: got {} that move; expected at most {}", moving_others_, kMostMoving));
  }
  std::vector<Input<LinkPoses>> inputs;
  for (std::size_t i = 0; i < moving_others_; ++i) {
    inputs.push_back(DeclareInput<LinkPoses>(LinksInput(others_[i].local_name)));
  }
  return inputs;
}

// What is not looked at is not read: the inputs of `others` stay, whatever the switch says.
Output<ProximitySet> BulletDistance::DeclareProximities(std::size_t moving) {
  return WithIndices(
      moving, [this]<std::size_t... I>(std::index_sequence<I...>) {
        return DeclareOutput<ProximitySet, &BulletDistance::CalcProximities<PosesOfOne<I>...>>(
            "proximities", {}, links, obstacles, scene_, near_, asked_, links_of_others[I]...);
      });
}

Output<ObstacleSet> BulletDistance::DeclareAround(std::size_t moving) {
  return WithIndices(
      moving, [this]<std::size_t... I>(std::index_sequence<I...>) {
        return DeclareOutput<ObstacleSet, &BulletDistance::CalcAround<PosesOfOne<I>...>>(
            "around", {}, obstacles, links_of_others[I]...);
      });
}

template <class... Poses>
void BulletDistance::CalcAround(const ObstacleSet& set, const Poses&... others,
                                ObstacleSet& result) const {
  const std::array<const LinkPoses*, sizeof...(Poses)> poses_of_others{&others...};
  FindAround(set, poses_of_others, result);
}

void BulletDistance::CalcAsked(const RequestAhead* request, Asked& result) const {
  const auto trajectory = request == nullptr ? nullptr : request->trajectory;
  if (!self_collision_ || (result.known && result.request == trajectory)) return;
  try {
    result = {trajectory, robot::OwnRangesAlong(model_, trajectory.get(), self_distance_), true};
  } catch (const models::ModelError& error) {
    throw ConfigError(fmt::format("ahead: {}", error.what()));
  }
}

void BulletDistance::CalcNear(const LinkPoses& poses, const ObstacleScene& of,
                              NearObstacles& result) const {
  CheckNames(poses);
  result.Clear(movable_.size(), of.capacity());
  for (const LinkCollider& link : movable_) {
    const int index = poses.Find(link.link, link.number);
    if (index < 0) {
      result.AddNone();
    } else {
      result.Add(of.balls(), poses.poses[index] * link.centre,
                 link.radius + max_distance_ + of.uncertainty());
    }
  }
}

template <class... Poses>
void BulletDistance::CalcProximities(const LinkPoses& poses, const ObstacleSet& set,
                                     const ObstacleScene& of, const NearObstacles& candidates,
                                     const Asked& asked, const Poses&... others,
                                     ProximitySet& result) const {
  const std::array<const LinkPoses*, sizeof...(Poses)> poses_of_others{&others...};
  result.fastest = of.fastest();
  Find(poses, set, candidates, of.uncertainty(), asked.ranges, poses_of_others, result);
}

void BulletDistance::Find(const LinkPoses& poses, const ObstacleSet& set,
                          const NearObstacles& candidates, double uncertainty,
                          const robot::OwnRanges& ranges, std::span<const LinkPoses* const> others,
                          ProximitySet& result) const {
  result.max_distance = max_distance_;
  result.compared = Compares(poses, set);
  for (std::size_t i = 0; i < others.size(); ++i) {
    CheckVelocities(others_[i], *others[i]);
    for (const Neighbour& other : others_[i].links) {
      result.fastest = std::max(result.fastest, SpeedOf(other.collider, *others[i]));
    }
  }
  std::size_t most = set.obstacles.capacity() + own_.size();
  for (const Other& other : others_) most += other.links.size();
  result.proximities.clear();
  result.proximities.reserve(movable_.size() * most);  // so that no pair that comes near allocates
  for (std::size_t i = 0; i < movable_.size(); ++i) {
    const LinkCollider& link = movable_[i];
    const int index = poses.Find(link.link, link.number);
    if (index < 0) continue;
    AddObstacles(link, poses.poses[index], set, candidates.of(i), uncertainty, result);
    AddOwnLinks(link, poses, index, ranges, result);
    if (link_forces_) AddLinksOfOthers(link, poses.poses[index], others, result);
  }
}

void BulletDistance::AddObstacles(const LinkCollider& link, const Eigen::Isometry3d& X_WL,
                                  const ObstacleSet& set, std::span<const int> candidates,
                                  double uncertainty, ProximitySet& result) const {
  const double reach = max_distance_ + uncertainty;
  for (const int place : candidates) {
    const Obstacle& obstacle = set.obstacles[static_cast<std::size_t>(place)];
    if (Ignored(link.link, obstacle.body->id)) continue;
    const geometry::Collider& collider = *obstacle.body->collider;
    const auto found = DistanceToBody(link, X_WL, collider, obstacle.X_WO, reach);
    if (found.status == geometry::DistanceStatus::kBeyond) continue;
    const double nearer = UncertaintyOf(set, place, found.normal);
    if (found.distance - nearer > max_distance_) continue;
    Proximity& proximity =
        result.proximities.emplace_back(ToProximity(link.link, obstacle.body->id, found));
    proximity.obstacle_velocity = obstacle.VelocityAt(found.point_b);
    proximity.obstacle_speed = SpeedBound(obstacle);
    if (nearer == 0.0) continue;
    proximity.distance -= nearer;
    proximity.point_on_obstacle += nearer * found.normal;
  }
}

void BulletDistance::AddOwnLinks(const LinkCollider& link, const LinkPoses& poses, int index,
                                 const robot::OwnRanges& ranges, ProximitySet& result) const {
  std::size_t next = 0;  // up to here all pairs with this link are mirrored; they come in order
  const std::size_t end = result.proximities.size();
  for (const Neighbour& own : own_) {
    const int number = own.collider.number;
    if (model_->adjacent(link.number, number) || model_->collision_disabled(link.number, number)) {
      continue;
    }
    if (number < link.number && model_->body(number) >= 0) {
      const auto& found = result.proximities;
      while (next < end && !(found[next].own_link == link.link)) ++next;
      if (next == end || !(found[next].link == own.collider.link)) continue;  // is beyond
      result.proximities.push_back(Mirrored(found[next++], own.name));
      continue;
    }
    const int at = poses.Find(own.collider.link, number);
    if (at >= 0 && AddOther(link, poses.poses[index], own, poses.poses[at], result)) {
      result.proximities.back().own_link = own.collider.link;
      result.proximities.back().range = ranges.of(link.number, number);
    }
  }
}

void BulletDistance::AddLinksOfOthers(const LinkCollider& link, const Eigen::Isometry3d& X_WL,
                                      std::span<const LinkPoses* const> others,
                                      ProximitySet& result) const {
  const bool lowest = model_->body(link.number) == model_->bodies().front();
  for (std::size_t i = 0; i < others_.size(); ++i) {
    for (const Neighbour& other : others_[i].links) {
      if (lowest && other.lowest) continue;
      if (i >= moving_others_) {
        AddOther(link, X_WL, other, other.X, result);
        continue;
      }
      const int at = others[i]->Find(other.collider.link, other.collider.number);
      if (at >= 0 && AddOther(link, X_WL, other, others[i]->poses[at], result)) {
        Proximity& found = result.proximities.back();
        found.obstacle_velocity = others[i]->VelocityAt(at, found.point_on_obstacle);
        found.obstacle_speed = SpeedOf(other.collider, *others[i]);
      }
    }
  }
}

bool BulletDistance::AddOther(const LinkCollider& link, const Eigen::Isometry3d& X_WL,
                              const Neighbour& other, const Eigen::Isometry3d& X_WO,
                              ProximitySet& result) const {
  if (Ignored(link.link, other.name)) return false;
  const auto found = DistanceToLink(link, X_WL, other.collider, X_WO, max_distance_);
  if (found.status == geometry::DistanceStatus::kBeyond) return false;
  result.proximities.push_back(ToProximity(link.link, other.name, found));
  return true;
}

bool BulletDistance::Ignored(models::Name link, models::Name obstacle) const {
  return std::any_of(ignored_.begin(), ignored_.end(), [&](const auto& pair) {
    return pair.first == link && pair.second == obstacle;
  });
}

}  // namespace oca::systems
