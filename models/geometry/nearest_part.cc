// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/nearest_part.h"

#include <algorithm>

#include "oca/models/geometry/ball_tree.h"

namespace oca::geometry::internal {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// A body's own box: the signed distance of a point to it is a lower bound of that to the body.
struct BodyBox {
  explicit BodyBox(const Collider& body) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = body.Support(-Vector3d::Unit(axis))[axis] - body.radius();
      high[axis] = body.Support(Vector3d::Unit(axis))[axis] + body.radius();
    }
  }
  double DistanceTo(const Vector3d& p) const {
    const Vector3d gap = (low - p).cwiseMax(p - high);
    const double inside = gap.maxCoeff();
    return inside < 0.0 ? inside : gap.cwiseMax(0.0).norm();
  }
  Vector3d low, high;
};

}  // namespace

SignedDistance DistanceToNearestPart(const Collider& a, const Isometry3d& X_WA, const Collider& b,
                                     const Isometry3d& X_WB, double max_distance) {
  const BodyBox box(a);
  const Isometry3d X_AB = X_WA.inverse() * X_WB;
  const BallTree& balls = *b.part_balls();
  // Rounding may not cut off a part that is just near enough.
  const double slack = 1e-12 * (a.bounding_radius() + b.bounding_radius());
  const auto bound = [&](const Vector3d& centre, double radius) {
    return box.DistanceTo(X_AB * centre) - radius - slack;
  };
  SignedDistance best;
  best.distance = max_distance;
  best.status = DistanceStatus::kBeyond;
  int best_part = -1;
  const auto limit = [&] { return best.distance; };
  const auto visit = [&](int index) {
    const Ball& ball = balls.ball(index);
    if (bound(ball.centre, ball.radius) > limit()) return;
    const Collider::Part& part = b.parts()[static_cast<std::size_t>(index)];
    const SignedDistance found =
        Distance(a, X_WA, *part.collider, X_WB * part.X_SP, std::max(best.distance, 0.0));
    if (found.status == DistanceStatus::kBeyond || found.distance > best.distance) return;
    if (found.distance == best.distance && best_part >= 0 && index > best_part) return;
    best = found;
    best_part = index;
  };
  balls.Search(bound, limit, visit);
  return best;
}

}  // namespace oca::geometry::internal
