// SPDX-License-Identifier: BSD-3-Clause
// The validity checks of the signals of an avoidance loop.
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "oca/framework/dataflow/fixed_text.h"
#include "oca/systems/signals/signal_limits.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {
namespace {

bool Finite3(const Eigen::Vector3d& vector) { return AllFinite(vector.data(), 3); }

bool FinitePose(const Eigen::Isometry3d& pose) { return AllFinite(pose.data(), 16); }

double OffRigid(const Eigen::Matrix3d& R) {
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).lpNorm<Eigen::Infinity>();
}

/// What is wrong with the pose and the velocity of `what` `name`.
Fault CheckMotion(const char* what, std::string_view name, const Eigen::Isometry3d& pose,
                  const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) {
  const auto& p = pose.translation();
  if (!Near(p)) {
    return FaultOf("{} '{}': position; got [{:.10g}, {:.10g}, {:.10g}] m; expected at most 1e6 m",
                   what, name, p.x(), p.y(), p.z());
  }
  if (const double off = OffRigid(pose.linear()); !(off <= kRigid)) {
    return FaultOf(
        "{} '{}': rotation; got a matrix R with R^T R off the identity by {:.3g}; expected a "
        "rotation, within 1e-9",
        what, name, off);
  }
  if (pose.linear().determinant() < 0.0) {
    return FaultOf("{} '{}': rotation; got one that mirrors; expected a determinant of 1", what,
                   name);
  }
  if (!Near(linear) || !Near(angular)) {
    return FaultOf(
        "{} '{}': velocity; got {:.3g} m/s and {:.3g} rad/s along an axis; expected at most 1e6",
        what, name, linear.lpNorm<Eigen::Infinity>(), angular.lpNorm<Eigen::Infinity>());
  }
  return {};
}

/// The first of `count` names, told by `name_of(i)`, that is there before; -1 if there is none.
/// `table`, zero, has room for twice as many, a power of two.
template <class NameOf>
int FindTwinIn(std::span<std::uint32_t> table, std::size_t count, const NameOf& name_of) {
  const int shift = 64 - std::countr_zero(table.size());
  for (std::size_t i = 0; i < count; ++i) {
    const models::Name name = name_of(i);
    const auto bits = static_cast<std::uint64_t>(reinterpret_cast<std::uintptr_t>(&name.text()));
    std::size_t at = (bits * 0x9e3779b97f4a7c15u) >> shift;
    for (; table[at] != 0; at = (at + 1) & (table.size() - 1)) {
      if (name_of(table[at] - 1) == name) return static_cast<int>(i);
    }
    table[at] = static_cast<std::uint32_t>(i + 1);
  }
  return -1;
}

/// The same without the heap, up to a count that only a growing list exceeds.
template <class NameOf>
int FindTwin(std::size_t count, const NameOf& name_of) {
  if (count < 2) return -1;
  const std::size_t size = std::bit_ceil(2 * count);
  std::array<std::uint32_t, 4096> few;
  if (size <= few.size()) {
    std::fill_n(few.begin(), size, 0u);
    return FindTwinIn(std::span(few).first(size), count, name_of);
  }
  thread_local std::vector<std::uint32_t> many;
  many.assign(size, 0u);
  return FindTwinIn(std::span(many), count, name_of);
}

Fault CheckObstacle(const Obstacle& o) {
  const std::string& id = o.body->id.text();
  if (!o.velocity_known && !(o.linear.isZero(0.0) && o.angular.isZero(0.0))) {
    return FaultOf("obstacle '{}': velocity; got one that is not known; expected zeros", id);
  }
  if (o.body->id.empty()) return Fault("obstacle: id; got an empty one; expected a name");
  if (!(o.body->fastest >= 0.0)) {
    return FaultOf("obstacle '{}': fastest; got {} m/s; expected at least 0", id, o.body->fastest);
  }
  return CheckMotion("obstacle", id, o.X_WO, o.linear, o.angular);
}

Fault CheckEstimate(std::string_view id, const ObstacleEstimate& estimate) {
  if (!Near(estimate.acceleration)) {
    return FaultOf(
        "obstacle '{}': acceleration; got {:.3g} m/s^2 along an axis; expected at most 1e6", id,
        estimate.acceleration.lpNorm<Eigen::Infinity>());
  }
  if (!(estimate.age >= 0.0)) {
    return FaultOf("obstacle '{}': age; got {} s; expected at least 0", id, estimate.age);
  }
  const auto& P = estimate.covariance;
  const double largest = P.lpNorm<Eigen::Infinity>();
  const double skew = (P - P.transpose()).lpNorm<Eigen::Infinity>();
  // A matrix without negative eigenvalues, to rounding.
  const auto shifted = (P + (kRigid * largest) * ObstacleEstimate::Covariance::Identity()).eval();
  const bool positive =
      largest == 0.0 ||
      (Eigen::LLT<ObstacleEstimate::Covariance>(shifted).info() == Eigen::Success);
  if (skew <= kRigid * largest && positive) return {};
  return FaultOf("obstacle '{}': covariance; got a matrix that is {}; expected a covariance", id,
                 positive ? "not symmetric" : "not positive semidefinite");
}

/// Finite numbers, and as many estimates as obstacles or none; the rest if `look` is whole.
Fault CheckEstimates(const ObstacleSet& set, Look look) {
  if (set.stamp && !std::isfinite(*set.stamp)) {
    return Fault("stamp: got a NaN or an infinity; expected a time, s");
  }
  if (set.estimates.empty()) return {};
  if (set.estimates.size() != set.obstacles.size()) {
    return FaultOf("got {} obstacles and {} estimates; expected equal numbers, or no estimates",
                   set.obstacles.size(), set.estimates.size());
  }
  for (std::size_t i = 0; i < set.estimates.size(); ++i) {
    const ObstacleEstimate& estimate = set.estimates[i];
    const std::string& id = set.obstacles[i].body->id.text();
    if (!Finite3(estimate.acceleration) || !AllFinite(estimate.covariance.data(), 36) ||
        !AllFinite(&estimate.age, 1)) {
      return FaultOf("obstacle '{}': estimate; got a NaN or an infinity; expected finite numbers",
                     id);
    }
    if (look == Look::kFinite) continue;
    if (const Fault fault = CheckEstimate(id, estimate); !fault.ok()) return fault;
  }
  return {};
}

Fault CheckProximity(const Proximity& p) {
  if (p.link.empty() || p.obstacle.empty()) {
    return FaultOf("proximity of '{}' and '{}': got an empty name; expected a link and an obstacle",
                   p.link.text(), p.obstacle.text());
  }
  if (!IsUnit(p.normal)) {
    return FaultOf(
        "proximity of '{}' and '{}': normal; got length {:.12g}; expected 1, within "
        "1e-9",
        p.link.text(), p.obstacle.text(), p.normal.norm());
  }
  if (!Near(p.point_on_link) || !Near(p.point_on_obstacle) || !Near(p.obstacle_velocity) ||
      !(std::fabs(p.distance) <= 4.0 * kFarthest)) {
    return FaultOf("proximity of '{}' and '{}': got numbers beyond 1e6; expected m and m/s",
                   p.link.text(), p.obstacle.text());
  }
  if (!(p.obstacle_speed >= 0.0)) {
    return FaultOf("proximity of '{}' and '{}': obstacle_speed; got {} m/s; expected at least 0",
                   p.link.text(), p.obstacle.text(), p.obstacle_speed);
  }
  if (!(p.range > 0.0)) {
    return FaultOf("proximity of '{}' and '{}': range; got {} m; expected more than 0",
                   p.link.text(), p.obstacle.text(), p.range);
  }
  return {};
}

Fault CheckShape(const LinkPoses& links) {
  const std::size_t size = links.links.size();
  const bool velocities = links.velocities.empty() || links.velocities.size() == size;
  if (links.poses.size() == size && links.bodies.size() == size && velocities) return {};
  return FaultOf("got {} links, {} poses, {} bodies and {} velocities; expected equal numbers",
                 size, links.poses.size(), links.bodies.size(), links.velocities.size());
}

Fault CheckLink(const LinkPoses& links, std::size_t i) {
  if (links.links[i].empty()) return FaultOf("link {}: got an empty name; expected one", i);
  const int body = links.bodies[i];
  if (body < -1 || body >= static_cast<int>(links.size())) {
    return FaultOf("link '{}': body; got {}; expected -1 or the number of a link",
                   links.links[i].text(), body);
  }
  const robot::LinkVelocity V =
      links.velocities.empty() ? robot::LinkVelocity{} : links.velocities[i];
  return CheckMotion("link", links.links[i].text(), links.poses[i], V.linear, V.angular);
}

/// A force or a torque may have any size; a place may not.
Fault CheckActing(const char* what, models::Name link, const Eigen::Vector3d& at) {
  if (link.empty()) return FaultOf("{}: link; got an empty name; expected a link", what);
  if (Near(at)) return {};
  return FaultOf("{} on '{}': place; got [{:.10g}, {:.10g}, {:.10g}] m; expected at most 1e6 m",
                 what, link.text(), at.x(), at.y(), at.z());
}

}  // namespace
}  // namespace oca::systems

namespace oca {

using namespace systems;  // NOLINT: the traits of these types

Fault Signal<ObstacleSet>::Check(const ObstacleSet& value, Look look) {
  for (std::size_t i = 0; i < value.obstacles.size(); ++i) {
    const Obstacle& o = value.obstacles[i];
    if (o.body == nullptr || o.body->collider == nullptr) {
      return FaultOf("obstacle {}: body; got {}; expected one of MakeObstacleBody", i,
                     o.body == nullptr ? "none" : "one without a shape");
    }
    if (!FinitePose(o.X_WO) || !Finite3(o.linear) || !Finite3(o.angular)) {
      return FaultOf("obstacle '{}': got a NaN or an infinity; expected finite numbers",
                     o.body->id.text());
    }
    if (look == Look::kFinite) continue;
    if (const Fault fault = CheckObstacle(o); !fault.ok()) return fault;
  }
  if (const Fault fault = CheckEstimates(value, look); !fault.ok()) return fault;
  if (look == Look::kFinite) return {};
  const int twin =
      FindTwin(value.obstacles.size(), [&](std::size_t i) { return value.obstacles[i].body->id; });
  if (twin < 0) return {};
  return FaultOf("obstacle {}: id; got '{}' again; expected unique ids", twin,
                 value.obstacles[static_cast<std::size_t>(twin)].body->id.text());
}

void Signal<ObstacleSet>::FromOutside(ObstacleSet& value) {
  value.layout = 0;
  value.moving.clear();
}

Fault Signal<LinkPoses>::Check(const LinkPoses& value, Look look) {
  if (const Fault fault = CheckShape(value); !fault.ok()) return fault;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const bool moves = !value.velocities.empty();
    if (!FinitePose(value.poses[i]) ||
        (moves && !(Finite3(value.velocities[i].linear) && Finite3(value.velocities[i].angular)))) {
      return FaultOf("link '{}': got a NaN or an infinity; expected finite numbers",
                     value.links[i].text());
    }
    if (look == Look::kFinite) continue;
    if (const Fault fault = CheckLink(value, i); !fault.ok()) return fault;
  }
  if (look == Look::kFinite) return {};
  const int twin = FindTwin(value.size(), [&](std::size_t i) { return value.links[i]; });
  if (twin < 0) return {};
  return FaultOf("link {}: got '{}' again; expected unique links", twin,
                 value.links[static_cast<std::size_t>(twin)].text());
}

Fault Signal<ProximitySet>::Check(const ProximitySet& value, Look look) {
  if (!AllFinite(&value.max_distance, 1) || !AllFinite(&value.fastest, 1)) {
    return Fault::UnlessFinite(false);
  }
  for (const Proximity& p : value.proximities) {
    if (!AllFinite(&p.distance, 1) || !Finite3(p.point_on_link) || !Finite3(p.point_on_obstacle) ||
        !Finite3(p.normal) || !Finite3(p.obstacle_velocity) || !AllFinite(&p.obstacle_speed, 1) ||
        std::isnan(p.range)) {
      return FaultOf(
          "proximity of '{}' and '{}': got a NaN or an infinity; expected finite numbers",
          p.link.text(), p.obstacle.text());
    }
    if (look == Look::kFinite) continue;
    if (const Fault fault = CheckProximity(p); !fault.ok()) return fault;
  }
  if (look == Look::kFinite || (value.max_distance >= 0.0 && value.fastest >= 0.0)) return {};
  return FaultOf("max_distance, fastest: got {} m and {} m/s; expected at least 0",
                 value.max_distance, value.fastest);
}

Fault Signal<LinkForceSet>::Check(const LinkForceSet& value, Look look) {
  for (const LinkForce& f : value.forces) {
    if (!Finite3(f.force) || !Finite3(f.point)) {
      return FaultOf("force on '{}': got a NaN or an infinity; expected finite numbers",
                     f.link.text());
    }
    if (look == Look::kFinite) continue;
    if (const Fault fault = CheckActing("force", f.link, f.point); !fault.ok()) return fault;
  }
  return {};
}

Fault Signal<WrenchSet>::Check(const WrenchSet& value, Look look) {
  for (const LinkWrench& w : value.wrenches) {
    if (!Finite3(w.force) || !Finite3(w.torque) || !Finite3(w.origin)) {
      return FaultOf("wrench on '{}': got a NaN or an infinity; expected finite numbers",
                     w.link.text());
    }
    if (look == Look::kFinite) continue;
    if (const Fault fault = CheckActing("wrench", w.link, w.origin); !fault.ok()) return fault;
  }
  return {};
}

}  // namespace oca
