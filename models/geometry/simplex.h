// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>

#include "oca/models/geometry/core_pair.h"

namespace oca::geometry::internal {

/// Up to four points of A - B and the point `v` of their convex hull that is nearest to the origin.
///
/// Add a point, look for the nearest one, then either Keep it, which drops the points it does not
/// need, or Drop the point added last.
class Simplex {
 public:
  struct Nearest {
    int count{0};
    std::array<int, 3> index{};  // ascending
    std::array<double, 3> weight{};
    Eigen::Vector3d v;
    double squared{0.0};
  };

  int count() const { return count_; }
  const CorePair::Difference& point(int i) const { return points_[i]; }
  /// All four, if there are so many.
  std::span<const CorePair::Difference, 4> points() const { return points_; }
  /// Nearest point to the origin, as kept.
  const Eigen::Vector3d& v() const { return v_; }
  /// The points of A and B (B's frame) that v comes from.
  Eigen::Vector3d PointA() const;
  Eigen::Vector3d PointB() const;

  void Clear() { count_ = 0; }
  void Add(const CorePair::Difference& p) { points_[count_++] = p; }
  void Drop() { --count_; }
  bool Contains(const CorePair::Difference& p) const;
  /// False if the origin is inside a tetrahedron; `outside` forbids that answer, for a caller who
  /// has proved the opposite. Of a tetrahedron the face without the last point is not looked at:
  /// it was the nearest one before that point came.
  bool FindNearest(bool outside, Nearest* nearest) const;
  void Keep(const Nearest& nearest);

 private:
  void OfPoint(int a, Nearest* nearest) const;
  void OfEdge(int a, int b, Nearest* nearest) const;
  void OfTriangle(int a, int b, int c, Nearest* nearest) const;
  void OfSliver(int a, int b, int c, Nearest* nearest) const;
  bool OfTetrahedron(bool outside, Nearest* nearest) const;

  int count_{0};
  std::array<CorePair::Difference, 4> points_;
  std::array<double, 3> weight_{};
  Eigen::Vector3d v_{Eigen::Vector3d::Zero()};
};

}  // namespace oca::geometry::internal
