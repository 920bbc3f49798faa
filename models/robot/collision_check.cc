// SPDX-License-Identifier: BSD-3-Clause
#include "models/robot/collision_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "models/error.h"
#include "models/geometry/distance.h"
#include "models/robot/kinematics.h"

namespace oca::models {
namespace {

struct Solid {
  Eigen::Isometry3d X_LC;
  std::shared_ptr<const Collider> collider;
};

// std::mt19937_64 is the same everywhere, the standard's distributions are not.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : bits_(seed) {}

  double Unit() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  double Position(double lower, double upper) {
    const double share = (Unit() * 8.0 - 1.0) / 6.0;  // an eighth of the draws beyond either end
    return lower + std::clamp(share, 0.0, 1.0) * (upper - lower);
  }

 private:
  std::mt19937_64 bits_;
};

void CheckSampling(const RobotModel& model, const CollisionSampling& sampling) {
  if (sampling.samples < 1) {
    throw ModelError(
        fmt::format("samples: how many to draw; got {}; expected at least 1", sampling.samples));
  }
  if (!(sampling.margin >= 0.0) || !std::isfinite(sampling.margin)) {
    throw ModelError(
        fmt::format("margin: got {} m; expected a finite number >= 0", sampling.margin));
  }
  for (const Joint& joint : model.joints()) {
    const bool bounded = std::isfinite(joint.lower_limit) && std::isfinite(joint.upper_limit);
    if (joint.position_index < 0 || bounded || joint.type != JointType::kPrismatic) continue;
    throw ModelError(fmt::format(
        "robot '{}' joint '{}': limits; got none; expected lower and upper, to sample within",
        model.name().text(), joint.name.text()));
  }
}

void DrawPositions(const RobotModel& model, Draws& draws, Eigen::VectorXd& q) {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const double lower = model.lower_limits()[i];
    const double upper = model.upper_limits()[i];
    q[i] = std::isfinite(lower) && std::isfinite(upper)
               ? draws.Position(lower, upper)
               : std::numbers::pi * (2.0 * draws.Unit() - 1.0);
  }
}

std::vector<std::vector<Solid>> MakeSolids(const RobotModel& model) {
  std::vector<std::vector<Solid>> solids;
  for (const Link& link : model.links()) {
    solids.emplace_back();
    for (const CollisionElement& element : link.collisions) {
      solids.back().push_back({element.X_LC, MakeCollider(element.shape, element.source)});
    }
  }
  return solids;
}

// The distance if it is at most `limit`, else any number above.
double DistanceWithin(const std::vector<Solid>& a, const Eigen::Isometry3d& X_WA,
                      const std::vector<Solid>& b, const Eigen::Isometry3d& X_WB, double limit) {
  double least = kUnlimited;
  for (const Solid& one : a) {
    for (const Solid& two : b) {
      const double bound = std::max(std::min(limit, least), 0.0);
      const auto found =
          Distance(*one.collider, X_WA * one.X_LC, *two.collider, X_WB * two.X_LC, bound);
      least = std::min(least, found.distance);
    }
  }
  return least;
}

PairKind KindOf(const LinkPairCheck& pair, const CollisionSampling& sampling) {
  if (pair.collisions == sampling.samples) return PairKind::kAlways;
  return pair.least_distance > sampling.margin ? PairKind::kNever : PairKind::kSometimes;
}

}  // namespace

std::string_view ToString(PairKind kind) {
  constexpr std::string_view kNames[] = {"Adjacent", "Always", "Never", "Sometimes"};
  return kNames[static_cast<int>(kind)];
}

std::vector<LinkPairCheck> CheckCollisions(const RobotModel& model,
                                           const CollisionSampling& sampling) {
  CheckSampling(model, sampling);
  const auto solids = MakeSolids(model);
  std::vector<LinkPairCheck> pairs;
  for (int a = 0; a < model.num_links(); ++a) {
    for (int b = a + 1; b < model.num_links(); ++b) {
      if (solids[a].empty() || solids[b].empty()) continue;
      const PairKind kind = model.adjacent(a, b) ? PairKind::kAdjacent : PairKind::kSometimes;
      pairs.push_back({a, b, kind, kUnlimited, 0});
    }
  }
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.num_positions());
  std::vector<Eigen::Isometry3d> X_WL = LinkPoses(model, q);
  for (LinkPairCheck& pair : pairs) {
    if (pair.kind != PairKind::kAdjacent) continue;
    pair.least_distance = DistanceWithin(solids[pair.link_a], X_WL[pair.link_a],
                                         solids[pair.link_b], X_WL[pair.link_b], kUnlimited);
    pair.collisions = pair.least_distance <= 0.0 ? 1 : 0;
  }
  Draws draws(sampling.seed);
  for (int sample = 0; sample < sampling.samples; ++sample) {
    DrawPositions(model, draws, q);
    ForwardKinematics(model, q, X_WL);
    for (LinkPairCheck& pair : pairs) {
      if (pair.kind == PairKind::kAdjacent) continue;
      const double distance =
          DistanceWithin(solids[pair.link_a], X_WL[pair.link_a], solids[pair.link_b],
                         X_WL[pair.link_b], pair.least_distance);
      pair.least_distance = std::min(pair.least_distance, distance);
      if (distance <= 0.0) ++pair.collisions;
    }
  }
  for (LinkPairCheck& pair : pairs) {
    if (pair.kind != PairKind::kAdjacent) pair.kind = KindOf(pair, sampling);
  }
  return pairs;
}

}  // namespace oca::models
