// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/geometry/obstacle.h"
#include "oca/models/name.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/proximity.h"

namespace oca::systems {

// The signals of an avoidance loop. All positions are in m, all vectors have world axes. Lists keep
// their capacity over assignment, so copying one from tick to tick does not allocate.

using geometry::Obstacle;
using geometry::ObstacleBody;
using geometry::ObstacleEstimate;

/// `estimates` are as many as obstacles, or none: then all is known exactly. `stamp` (s) is when
/// whoever observed the set told it, if it is not of now.
///
/// `layout` and `moving` spare who follows the set a look at what stands: two sets of the same
/// layout, if it is not 0, hold the same bodies in the same order, and those that are not in
/// `moving` (places, ascending) stand still where they stood. JSON: the list of obstacles, each
/// with its estimate; without a "twist" its velocity is not known.
struct ObstacleSet {
  std::vector<Obstacle> obstacles{};
  std::uint64_t layout{0};
  std::vector<int> moving{};
  std::vector<ObstacleEstimate> estimates{};
  std::optional<double> stamp{};
};

/// Poses X_WL of the links of a robot, in three columns of equal length so that kinematics writes
/// the poses as they are. `bodies` holds for each link the index (into these columns) of the link
/// that the last movable joint before it leads to: itself if its own joint moves, -1 if it cannot
/// move. `velocities` of the links' origins, world axes, are as many, or none if they are not
/// known. JSON: "twist" as of an obstacle, optional on input (a link without one rests), never
/// written.
struct LinkPoses {
  std::vector<models::Name> links{};
  std::vector<Eigen::Isometry3d> poses{};
  std::vector<int> bodies{};
  std::vector<robot::LinkVelocity> velocities{};

  std::size_t size() const { return links.size(); }
  /// -1 if there is none of that name. `hint` is looked at first.
  int Find(models::Name link, int hint = 0) const;
  /// Velocity of the point of link number `index` that is now at p_W, m/s; needs `velocities`.
  Eigen::Vector3d VelocityAt(int index, const Eigen::Vector3d& p_W) const {
    const robot::LinkVelocity& V = velocities[index];
    return V.linear + V.angular.cross(p_W - poses[index].translation());
  }
};

/// Nearest points; normals lead from obstacle to link. JSON: the list of proximities; what is
/// optional on input and never written is obstacle_velocity, own_link, obstacle_speed and range.
using robot::Proximity;
using robot::ProximitySet;

/// A force (N) that acts on `link` at `point`, because of `obstacle`.
struct LinkForce {
  models::Name link{};
  models::Name obstacle{};
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};
  Eigen::Vector3d point{Eigen::Vector3d::Zero()};
};

struct LinkForceSet {
  std::vector<LinkForce> forces{};
};

/// Force (N) and torque (Nm) on `link`, the torque about `origin`.
struct LinkWrench {
  models::Name link{};
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};
  Eigen::Vector3d torque{Eigen::Vector3d::Zero()};
  Eigen::Vector3d origin{Eigen::Vector3d::Zero()};
};

struct WrenchSet {
  std::vector<LinkWrench> wrenches{};
};

}  // namespace oca::systems

namespace oca {

// JSON of every signal is a list with an object an item: docs/reference/signals.md. ReadJson
// refuses unknown and missing keys, wrong lengths and numbers that are not finite, saying which
// item.

template <>
struct Signal<systems::ObstacleSet> {
  static constexpr const char* kName = "ObstacleSet";
  static Fault Check(const systems::ObstacleSet& value, Look look);
  /// `layout` is between systems: a caller who moves an obstacle need not know of it. The caller's
  /// `stamp` stays.
  static void FromOutside(systems::ObstacleSet& value);
  static void WriteJson(const systems::ObstacleSet& value, std::string& out);
  static systems::ObstacleSet ReadJson(std::string_view text);
};
template <>
struct Signal<systems::LinkPoses> {
  static constexpr const char* kName = "LinkPoses";
  static Fault Check(const systems::LinkPoses& value, Look look);
  static void WriteJson(const systems::LinkPoses& value, std::string& out);
  static systems::LinkPoses ReadJson(std::string_view text);
};
template <>
struct Signal<systems::ProximitySet> {
  static constexpr const char* kName = "ProximitySet";
  static Fault Check(const systems::ProximitySet& value, Look look);
  static void WriteJson(const systems::ProximitySet& value, std::string& out);
  static systems::ProximitySet ReadJson(std::string_view text);
};
template <>
struct Signal<systems::LinkForceSet> {
  static constexpr const char* kName = "LinkForceSet";
  static Fault Check(const systems::LinkForceSet& value, Look look);
  static void WriteJson(const systems::LinkForceSet& value, std::string& out);
  static systems::LinkForceSet ReadJson(std::string_view text);
};
template <>
struct Signal<systems::WrenchSet> {
  static constexpr const char* kName = "WrenchSet";
  static Fault Check(const systems::WrenchSet& value, Look look);
  static void WriteJson(const systems::WrenchSet& value, std::string& out);
  static systems::WrenchSet ReadJson(std::string_view text);
};

}  // namespace oca
