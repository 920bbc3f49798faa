// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/collision_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "oca/models/error.h"
#include "oca/models/geometry/ball_tree.h"
#include "oca/models/geometry/distance.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/posture.h"

namespace oca::robot {
namespace {

// Of the posture 0, m: what closes flush there, such as fingers, is apart by rounding or is not.
constexpr double kFlush = 1e-6;
constexpr std::ptrdiff_t kMostLinks = 500;

struct Solid {
  Eigen::Isometry3d X_LC;
  std::shared_ptr<const geometry::Collider> collider;
};

/// Where a position is drawn from, and whether its limits end it.
struct Range {
  double lower;
  double upper;
  bool limits;
};

// std::mt19937_64 is the same everywhere, the standard's distributions are not.
class Draws {
 public:
  explicit Draws(std::uint64_t seed) : bits_(seed) {}

  double Position(const Range& range) {
    const double unit = Unit();
    // Where the ends are limits an eighth of the draws lies beyond either.
    const double share = range.limits ? std::clamp((unit * 8.0 - 1.0) / 6.0, 0.0, 1.0) : unit;
    return range.lower + share * (range.upper - range.lower);
  }

 private:
  double Unit() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }

  std::mt19937_64 bits_;
};

void CheckSampling(const CollisionSampling& sampling) {
  if (sampling.samples < 1) {
    throw models::ModelError(
        fmt::format("samples: how many to draw; got {}; expected at least 1", sampling.samples));
  }
  if (!(sampling.margin >= 0.0) || !std::isfinite(sampling.margin)) {
    throw models::ModelError(
        fmt::format("margin: got {} m; expected a finite number >= 0", sampling.margin));
  }
}

/// Where to draw each position from.
std::vector<Range> RangesOf(const RobotModel& model) {
  std::vector<Range> ranges;
  for (Eigen::Index i = 0; i < model.num_positions(); ++i) {
    if (const auto range = DrawnRange(model, i)) {
      ranges.push_back({range->first, range->second, HasOwnRange(model, i)});
      continue;
    }
    throw models::ModelError(fmt::format(
        "robot '{}' joint '{}': limits; got [{:g}, {:g}]; expected a range of at most 100 m, or "
        "100 turns, that samples can cover",
        model.name().text(), model.position_names()[static_cast<std::size_t>(i)].text(),
        model.lower_limits()[i], model.upper_limits()[i]));
  }
  return ranges;
}

std::vector<std::vector<Solid>> MakeSolids(const RobotModel& model) {
  const auto count = std::count_if(model.links().begin(), model.links().end(),
                                   [](const Link& link) { return !link.collisions.empty(); });
  if (count > kMostLinks) {
    throw models::ModelError(
        fmt::format("robot '{}': links with solids, each pair of which is looked at; got {}; "
                    "expected at most {}",
                    model.name().text(), count, kMostLinks));
  }
  std::vector<std::vector<Solid>> solids;
  for (const Link& link : model.links()) {
    solids.emplace_back();
    for (const CollisionElement& element : link.collisions) {
      solids.back().push_back(
          {element.X_LC, geometry::MakeCollider(element.shape, element.source)});
    }
  }
  return solids;
}

/// A ball around all solids of a link, in its frame.
geometry::Ball BallAround(const std::vector<Solid>& solids) {
  geometry::Ball ball{Eigen::Vector3d::Zero(), 0.0};
  for (const Solid& solid : solids) {
    ball.centre += solid.X_LC * solid.collider->centre() / static_cast<double>(solids.size());
  }
  for (const Solid& solid : solids) {
    const double away = (solid.X_LC * solid.collider->centre() - ball.centre).norm();
    ball.radius = std::max(ball.radius, away + solid.collider->bounding_radius());
  }
  return ball;
}

/// Whether balls about both centres are farther apart than `distance`, and by more than rounding.
bool Apart(const geometry::Ball& a, const geometry::Ball& b, double distance) {
  const double reach = a.radius + b.radius + std::max(distance, 0.0);
  return (a.centre - b.centre).squaredNorm() > reach * reach * (1.0 + 1e-12);
}

// The distance if it is at most `limit`, else any number above.
double DistanceWithin(const std::vector<Solid>& a, const Eigen::Isometry3d& X_WA,
                      const std::vector<Solid>& b, const Eigen::Isometry3d& X_WB, double limit) {
  double least = kUnlimited;
  for (const Solid& one : a) {
    for (const Solid& two : b) {
      const double bound = std::max(std::min(limit, least), 0.0);
      const auto found =
          geometry::Distance(*one.collider, X_WA * one.X_LC, *two.collider, X_WB * two.X_LC, bound);
      least = std::min(least, found.distance);
    }
  }
  return least;
}

void RequireFinite(const RobotModel& model, const LinkPairCheck& pair) {
  if (std::isfinite(pair.least_distance)) return;
  throw models::ModelError(
      fmt::format("robot '{}' links '{}' and '{}': distance; got {}; expected a finite number: the "
                  "poses of the model are too large",
                  model.name().text(), model.links()[pair.link_a].name.text(),
                  model.links()[pair.link_b].name.text(), pair.least_distance));
}

PairKind KindOf(const LinkPairCheck& pair, const CollisionSampling& sampling) {
  if (pair.collisions >= kAlwaysShare * sampling.samples) return PairKind::kAlways;
  if (pair.at_zero) return PairKind::kDefault;
  return pair.least_distance > sampling.margin ? PairKind::kNever : PairKind::kSometimes;
}

}  // namespace

std::string_view ToString(PairKind kind) {
  constexpr std::string_view kNames[] = {"Adjacent", "Always", "Default", "Never", "Sometimes"};
  return kNames[static_cast<int>(kind)];
}

std::vector<LinkPairCheck> CheckCollisions(const RobotModel& model,
                                           const CollisionSampling& sampling) {
  CheckSampling(sampling);
  const std::vector<Range> ranges = RangesOf(model);
  const auto solids = MakeSolids(model);
  std::vector<LinkPairCheck> pairs;
  for (int a = 0; a < model.num_links(); ++a) {
    for (int b = a + 1; b < model.num_links(); ++b) {
      if (solids[a].empty() || solids[b].empty()) continue;
      const PairKind kind = model.adjacent(a, b) ? PairKind::kAdjacent : PairKind::kSometimes;
      pairs.push_back({a, b, kind, kUnlimited, 0});
    }
  }
  Eigen::VectorXd q = ZeroPosture(model);
  std::vector<Eigen::Isometry3d> X_WL(model.links().size());
  std::vector<geometry::Ball> balls;
  for (const std::vector<Solid>& of_link : solids) balls.push_back(BallAround(of_link));
  std::vector<geometry::Ball> placed = balls;
  Draws draws(sampling.seed);
  for (int sample = 0; sample < sampling.samples; ++sample) {
    if (sampling.progress && !sampling.progress(1.0 * sample / sampling.samples)) return {};
    for (std::size_t i = 0; sample > 0 && i < ranges.size(); ++i) {
      q[static_cast<Eigen::Index>(i)] = draws.Position(ranges[i]);
    }
    ForwardKinematics(model, q, X_WL);
    for (std::size_t i = 0; i < balls.size(); ++i) placed[i].centre = X_WL[i] * balls[i].centre;
    for (LinkPairCheck& pair : pairs) {
      if (Apart(placed[pair.link_a], placed[pair.link_b], pair.least_distance)) continue;
      const double distance =
          DistanceWithin(solids[pair.link_a], X_WL[pair.link_a], solids[pair.link_b],
                         X_WL[pair.link_b], pair.least_distance);
      pair.least_distance = std::min(pair.least_distance, distance);
      if (sample == 0) pair.at_zero = distance <= kFlush;
      if (distance <= 0.0) ++pair.collisions;
    }
  }
  for (LinkPairCheck& pair : pairs) {
    RequireFinite(model, pair);
    if (pair.kind != PairKind::kAdjacent) pair.kind = KindOf(pair, sampling);
  }
  return pairs;
}

std::vector<DisabledPair> PairsToDisable(const RobotModel& model,
                                         const std::vector<LinkPairCheck>& pairs) {
  std::vector<DisabledPair> disabled;
  for (const PairKind kind :
       {PairKind::kAdjacent, PairKind::kAlways, PairKind::kDefault, PairKind::kNever}) {
    for (const LinkPairCheck& pair : pairs) {
      if (pair.kind != kind) continue;
      disabled.push_back({model.links()[static_cast<std::size_t>(pair.link_a)].name.text(),
                          model.links()[static_cast<std::size_t>(pair.link_b)].name.text(),
                          std::string(ToString(kind))});
    }
  }
  return disabled;
}

}  // namespace oca::robot
