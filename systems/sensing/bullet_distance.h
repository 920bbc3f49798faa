// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/robot/own_ranges.h"
#include "oca/systems/sensing/link_colliders.h"
#include "oca/systems/sensing/near_obstacles.h"
#include "oca/systems/signals/ignored_pairs.h"
#include "oca/systems/signals/model_set.h"
#include "oca/systems/signals/request_ahead.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Signed distances of the movable links of a robot to what is around them, nearest points and
/// normals: one proximity for each link and obstacle, the least over the link's solids; in the
/// order of the model's links, and for each link first obstacles, then, with self_collision, links
/// of the same model, then, with calculate_link_forces, links of `others`. Pairs farther apart than
/// max_distance are left out, as are links whose pose does not come in.
///
/// Links count as obstacles named <model>/<link>. A pair of the same model is listed from either
/// side, so that its forces push both links apart; it is computed once, for the link that comes
/// first, and the other side is its exact mirror. Links of `others` move with the velocities that
/// come in with their poses. Left out are the pairs of `ignore` (of the same model from either
/// side); of the same model those that are adjacent or disabled in the SRDF; and the lowest pair of
/// two arms, which cannot avoid each other: the lowest movable link against the other arm's lowest
/// movable link and what of the other arm cannot move.
///
/// Own links have a distance of their own, for those two joints apart stand near each other by
/// design: the `range` of such a pair is what self_distance and the whole request, if `ahead` tells
/// it, leave (robot::OwnRangesAlong). Who keeps a distance keeps no more there. It is computed when
/// another request comes in, which takes memory. With self_distance 0 own links are as obstacles.
///
/// The second name of an `ignore` that begins with the name of a model and a slash is a link of it,
/// which must exist; any other is the id of an obstacle, which may appear at any time, unless it
/// begins nearly like a model. Links and obstacles may have slashes in their names.
///
/// Pairs whose bounding balls are farther apart than max_distance are not looked at: balls around
/// the obstacles form a tree, which only obstacles that move make work for, so many far ones cost
/// little.
///
/// Of an obstacle that is known with a covariance P of its position (ObstacleSet::estimates), the
/// distance counts for less by 3 sqrt(n^T P n) along the normal n, geometry::Uncertainty, as if its
/// nearest point were so much nearer.
///
/// Every tick is computed afresh: warm starts would let the last bits depend on which ticks were
/// looked at before.
///
/// in    links         LinkPoses    of `model`
/// in    obstacles     ObstacleSet
/// in    ahead         RequestAhead  optional; read with self_collision
/// in    links_<name>  LinkPoses    for each of `others` that has movable joints; with velocities;
///                                  by the name that the file has for it, or else the nearest file
///                                  around it
/// out   proximities   ProximitySet
///       ignored       IgnoredPairs  the pairs that are left out, of `ignore` and the lowest ones,
///                                   for who measures on his own
///       around        ObstacleSet   the obstacles, then, with calculate_link_forces, the links of
///                                   `others`, for the same
/// state -
/// throws ConfigError if a model or a link of `ignore` does not exist, no movable link of the model
///        has a collision shape, a pair is no pair, max_distance is not positive,
///        calculate_link_forces has no `others`, or more than 8 of them move or two of these have
///        one name; while running if a link comes in that is not of the model, or links of `others`
///        without velocities
/// source report section 3.2, Algorithm 2; docs/theory.md, Distances
class BulletDistance final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "finds the nearest points of a robot's links and the obstacles",
      "distance = min |p_link - p_obstacle|, or minus the depth of penetration",
      "Jain, Sixt, Exner 2016, Algorithm 2"};
  struct Params {
    std::string model{};
    double max_distance{0.3};
    std::vector<std::vector<std::string>> ignore{};
    bool calculate_link_forces{false};
    bool self_collision{false};
    double self_distance{robot::kSelfDistance};
    std::vector<std::string> others{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {}; }

  BulletDistance(const Params& params, const ModelSet& models);

 private:
  /// A link that others keep away from.
  struct Neighbour {
    LinkCollider collider;
    models::Name name;    ///< <model>/<link>
    bool lowest;          ///< of an arm: the lowest that moves, or one that cannot
    Eigen::Isometry3d X;  ///< in the world, if its model has no movable joint
  };
  struct Other {
    std::string name;        ///< the full one
    std::string local_name;  ///< what its input is named by
    std::shared_ptr<const robot::RobotModel> model;
    std::vector<Neighbour> links;
    std::vector<std::shared_ptr<const ObstacleBody>> solids;  ///< of each, in its frame
  };
  /// `others: ["*"]`
  static bool LooksAtAll(const Params& params);
  /// Of an entry of `ignore`: the model's full name before the link's; an obstacle's id as it is.
  static std::string FullLinkName(const ModelSet& models, const std::string& name);
  static std::vector<Neighbour> MakeNeighbours(const std::string& name,
                                               const robot::RobotModel& model);
  static std::vector<std::shared_ptr<const ObstacleBody>> MakeSolids(
      const robot::RobotModel& model, const std::vector<Neighbour>& links);
  static std::vector<Other> MakeOthers(const Params& params, const ModelSet& models);
  /// What there is to be told of robots that `*` leaves out; empty if there are none.
  static std::string OutOfSight(const Params& params, const ModelSet& models);
  std::vector<LinkCollider> MakeMovable() const;
  std::vector<std::pair<models::Name, models::Name>> MakeIgnored(const Params& params,
                                                                 const ModelSet& models) const;
  std::vector<Input<LinkPoses>> DeclareOtherLinks();
  Output<ProximitySet> DeclareProximities(std::size_t moving);
  Output<ObstacleSet> DeclareAround(std::size_t moving);
  void DeclareRoles(const Params& params, const ModelSet& models);

  /// What is asked of own links, and by which request.
  struct Asked {
    std::shared_ptr<const motion::Trajectory> request{};
    robot::OwnRanges ranges{};
    bool known{false};
  };
  void CalcIgnored(IgnoredPairs& result) const;
  template <class... Poses>
  void CalcAround(const ObstacleSet& set, const Poses&... others, ObstacleSet& result) const;
  void FindAround(const ObstacleSet& set, std::span<const LinkPoses* const> others,
                  ObstacleSet& result) const;
  void CalcAsked(const RequestAhead* request, Asked& result) const;
  void CalcScene(const ObstacleSet& set, ObstacleScene& result) const { result.Follow(set); }
  void CalcNear(const LinkPoses& poses, const ObstacleScene& of, NearObstacles& result) const;
  template <class... Poses>
  void CalcProximities(const LinkPoses& poses, const ObstacleSet& set, const ObstacleScene& of,
                       const NearObstacles& candidates, const Asked& asked, const Poses&... others,
                       ProximitySet& result) const;
  void Find(const LinkPoses& poses, const ObstacleSet& set, const NearObstacles& candidates,
            double uncertainty, const robot::OwnRanges& ranges,
            std::span<const LinkPoses* const> others, ProximitySet& result) const;
  void AddObstacles(const LinkCollider& link, const Eigen::Isometry3d& X_WL, const ObstacleSet& set,
                    std::span<const int> candidates, double uncertainty,
                    ProximitySet& result) const;
  void AddOwnLinks(const LinkCollider& link, const LinkPoses& poses, int index,
                   const robot::OwnRanges& ranges, ProximitySet& result) const;
  void AddLinksOfOthers(const LinkCollider& link, const Eigen::Isometry3d& X_WL,
                        std::span<const LinkPoses* const> others, ProximitySet& result) const;
  bool AddOther(const LinkCollider& link, const Eigen::Isometry3d& X_WL, const Neighbour& other,
                const Eigen::Isometry3d& X_WO, ProximitySet& result) const;
  bool Ignored(models::Name link, models::Name obstacle) const;
  bool LooksAt(const LinkCollider& link, const Neighbour& own) const;
  bool LooksAtLinks() const;
  bool Compares(const LinkPoses& poses, const ObstacleSet& set) const;
  void CheckNames(const LinkPoses& poses) const;
  void CheckVelocities(const Other& other, const LinkPoses& poses) const;

  const std::string name_;
  const std::shared_ptr<const robot::RobotModel> model_;
  const double max_distance_;
  const bool self_collision_;
  const double self_distance_;
  const bool link_forces_;
  const std::vector<LinkCollider> movable_;
  const std::vector<Neighbour> own_;  ///< empty without self_collision
  const std::vector<Other> others_;   ///< those that move first
  const std::size_t moving_others_;
  const std::vector<std::pair<models::Name, models::Name>> ignored_;
  const bool at_links_;  ///< whether pairs with links are looked at, own ones or others'

 public:
  const Input<LinkPoses> links;
  const Input<ObstacleSet> obstacles;
  const OptionalInput<RequestAhead> ahead;
  const std::vector<Input<LinkPoses>> links_of_others;

 private:
  const Cached<ObstacleScene> scene_;
  const Cached<NearObstacles> near_;
  const Cached<Asked> asked_;

 public:
  const Output<ProximitySet> proximities;
  const Output<IgnoredPairs> ignored;
  const Output<ObstacleSet> around;
};

}  // namespace oca::systems
