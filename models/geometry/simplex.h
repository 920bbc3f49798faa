// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "models/geometry/core_pair.h"

namespace oca::models::internal {

/// Up to four points of A - B and the point `v` of their convex hull that is nearest to the origin.
class Simplex {
 public:
  int count() const { return count_; }
  const CorePair::Difference& point(int i) const { return points_[i]; }
  /// Nearest point to the origin, valid after Reduce.
  const Eigen::Vector3d& v() const { return v_; }
  /// The points of A and B (B's frame) that v comes from.
  Eigen::Vector3d PointA() const;
  Eigen::Vector3d PointB() const;

  void Clear() { count_ = 0; }
  void Add(const CorePair::Difference& p) { points_[count_++] = p; }
  bool Contains(const CorePair::Difference& p) const;
  /// Finds v and drops the points it does not need. False if the origin is inside a tetrahedron;
  /// `outside` forbids that answer, for a caller who has proved the opposite.
  bool Reduce(bool outside);

 private:
  struct Nearest {
    int count{0};
    std::array<int, 3> index{};
    std::array<double, 3> weight{};
    Eigen::Vector3d v;
    double squared{0.0};
  };

  Nearest OfPoint(int a) const;
  Nearest OfEdge(int a, int b) const;
  Nearest OfTriangle(int a, int b, int c) const;
  bool OfTetrahedron(bool outside, Nearest* nearest) const;
  void Keep(const Nearest& nearest);

  int count_{0};
  std::array<CorePair::Difference, 4> points_;
  std::array<double, 4> weight_{};
  Eigen::Vector3d v_{Eigen::Vector3d::Zero()};
};

}  // namespace oca::models::internal
