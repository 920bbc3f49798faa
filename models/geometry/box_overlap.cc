// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/box_overlap.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "oca/models/geometry/segment_forms.h"

namespace oca::geometry::internal {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Cosine below which an axis counts as lying in a face: two boxes touch along an edge or a face.
constexpr double kAlong = 1e-12;
constexpr double kTie = 1e-14;  // depths that differ by less, relative to the size, are equal

// An exit of box B, half extents `b` at X_AB, from box A about the origin.
struct BoxExit {
  double depth{std::numeric_limits<double>::infinity()};
  int axis_a{-1};                      // -1 if the axis is normal to a face of B
  int axis_b{-1};                      // -1 if the axis is normal to a face of A
  Vector3d normal{Vector3d::UnitX()};  // from A to B
};

BoxExit ShortestExit(const Vector3d& a, const Vector3d& b, const Isometry3d& X_AB) {
  const Matrix3d R = X_AB.linear();
  const Matrix3d size = R.cwiseAbs();
  const Vector3d t = X_AB.translation();
  BoxExit best;
  const auto consider = [&](double depth, double along, const Vector3d& n, int i, int j) {
    if (depth < best.depth) best = {depth, i, j, along < 0.0 ? Vector3d(-n) : n};
  };
  for (int i = 0; i < 3; ++i) {
    consider(a[i] + size.row(i).dot(b) - std::abs(t[i]), t[i], Vector3d::Unit(i), i, -1);
  }
  for (int j = 0; j < 3; ++j) {
    const double along = R.col(j).dot(t);
    consider(b[j] + size.col(j).dot(a) - std::abs(along), along, R.col(j), -1, j);
  }
  const double slack = kTie * (a.sum() + b.sum());
  for (int i = 0; i < 3; ++i) {
    const int u = (i + 1) % 3, v = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      // e_i x b_j, made unit before anything is measured along it: it may be short.
      const double sine2 = R(u, j) * R(u, j) + R(v, j) * R(v, j);
      if (sine2 < kParallel2) continue;
      const double sine = std::sqrt(sine2);
      Vector3d n = Vector3d::Zero();
      n[u] = -R(v, j) / sine;
      n[v] = R(u, j) / sine;
      const double along = n[u] * t[u] + n[v] * t[v];
      double depth = a[u] * std::abs(n[u]) + a[v] * std::abs(n[v]) - std::abs(along);
      for (const int k : {(j + 1) % 3, (j + 2) % 3}) {
        depth += b[k] * std::abs(n[u] * R(u, k) + n[v] * R(v, k));
      }
      // Where it coincides with the normal of a face, that face knows where the boxes touch.
      if (depth < best.depth - slack) consider(depth, along, n, i, j);
    }
  }
  return best;
}

// A convex polygon of up to eight corners; cutting it by a rectangle adds one corner a side.
struct Polygon {
  std::array<Vector2d, 8> corner;
  int count{0};

  void Add(const Vector2d& p) {
    if (count < 8) corner[count++] = p;
  }
  Vector2d Middle() const {
    Vector2d sum = Vector2d::Zero();
    for (int i = 0; i < count; ++i) sum += corner[i];
    return sum / count;
  }
};

// The part with sign * p[axis] <= limit; left as it is if rounding says that there is none.
void Cut(int axis, double sign, double limit, Polygon* polygon) {
  Polygon rest;
  for (int i = 0; i < polygon->count; ++i) {
    const Vector2d &p = polygon->corner[i], &q = polygon->corner[(i + 1) % polygon->count];
    const double over_p = sign * p[axis] - limit, over_q = sign * q[axis] - limit;
    if (over_p <= 0.0) rest.Add(p);
    if ((over_p < 0.0 && over_q > 0.0) || (over_p > 0.0 && over_q < 0.0)) {
      rest.Add(p + (q - p) * (over_p / (over_p - over_q)));
    }
  }
  if (rest.count > 0) *polygon = rest;
}

// The deepest point of B below the face of A that is normal to `axis`; of several the middle of
// those above the face. In A's frame.
Vector3d DeepestPoint(const Vector3d& a, const Vector3d& b, const Isometry3d& X_AB, int axis,
                      double side) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  Vector3d deepest = X_AB.translation();
  std::array<Vector3d, 2> free;
  int free_count = 0;
  for (int j = 0; j < 3; ++j) {
    const Vector3d edge = b[j] * X_AB.linear().col(j);
    const double along = side * X_AB.linear()(axis, j);
    if (std::abs(along) <= kAlong && free_count < 2) {
      free[free_count++] = edge;
    } else {
      deepest -= std::copysign(1.0, along) * edge;
    }
  }
  if (free_count == 0) return deepest;
  const auto flat = [&](const Vector3d& p) { return Vector2d(p[u], p[v]); };
  const Vector2d centre = flat(deepest), one = flat(free[0]);
  const Vector2d two = free_count == 2 ? flat(free[1]) : Vector2d(Vector2d::Zero());
  Polygon polygon;
  polygon.Add(centre - one - two);
  polygon.Add(centre + one - two);
  if (free_count == 2) {
    polygon.Add(centre + one + two);
    polygon.Add(centre - one + two);
  }
  for (const double sign : {-1.0, 1.0}) {
    Cut(0, sign, a[u], &polygon);
    Cut(1, sign, a[v], &polygon);
  }
  const Vector2d middle = polygon.Middle();
  deepest[u] = middle.x();
  deepest[v] = middle.y();
  return deepest;
}

// The edge along `axis` of a box at X that lies farthest along `normal`.
Segment FarthestEdge(const Vector3d& half, const Isometry3d& X, const Vector3d& normal, int axis) {
  Vector3d centre = X.translation();
  for (int i = 0; i < 3; ++i) {
    if (i == axis) continue;
    const Vector3d edge = half[i] * X.linear().col(i);
    centre += std::copysign(1.0, normal.dot(edge)) * edge;
  }
  return {centre, X.linear().col(axis), half[axis]};
}

}  // namespace

CoreDistance BoxOverlap(const CorePair& pair) {
  const Vector3d &a = pair.a.half(), &b = pair.b.half();
  const BoxExit exit = ShortestExit(a, b, pair.X_AB);
  CoreDistance result{.distance = -exit.depth, .normal = -exit.normal};
  if (exit.axis_b < 0) {
    const double side = std::copysign(1.0, exit.normal[exit.axis_a]);
    result.point_b = DeepestPoint(a, b, pair.X_AB, exit.axis_a, side);
    result.point_a = result.point_b + exit.depth * exit.normal;
  } else if (exit.axis_a < 0) {
    const Isometry3d X_BA = pair.X_AB.inverse();
    const double side = -std::copysign(1.0, pair.X_AB.linear().col(exit.axis_b).dot(exit.normal));
    result.point_a = pair.X_AB * DeepestPoint(b, a, X_BA, exit.axis_b, side);
    result.point_b = result.point_a - exit.depth * exit.normal;
  } else {
    const Segment edge_a = FarthestEdge(a, Isometry3d::Identity(), exit.normal, exit.axis_a);
    const Segment edge_b = FarthestEdge(b, pair.X_AB, -exit.normal, exit.axis_b);
    result.point_a = edge_a.At(NearestOfSegments(edge_a, edge_b).a);
    result.point_b = result.point_a - exit.depth * exit.normal;
  }
  return result;
}

}  // namespace oca::geometry::internal
