// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace oca::geometry::internal {

__extension__ typedef __int128 Int128;

/// A point of an integer lattice; coordinates stay within +-2^40 so that all that follows is exact.
struct LatticePoint {
  std::int64_t x{0}, y{0}, z{0};
  friend bool operator==(const LatticePoint&, const LatticePoint&) = default;
  friend auto operator<=>(const LatticePoint&, const LatticePoint&) = default;
};

/// Maps points within `extent` m of `centre` to the lattice; its step is 1e-12 `extent`.
class Lattice {
 public:
  Lattice(const Eigen::Vector3d& centre, double extent);

  LatticePoint Round(const Eigen::Vector3d& p) const;
  Eigen::Vector3d Point(const LatticePoint& p) const;
  /// Length of one step, m.
  double step() const { return step_; }

 private:
  Eigen::Vector3d centre_;
  double step_;
};

/// A growing convex polyhedron with triangular faces whose every decision is exact: with integer
/// coordinates no rounding can turn a face inside out or tear the surface, however thin it is.
///
/// A point that lies in the plane of a face does not see that face, hence no triangle degenerates.
/// Capacity is reserved once; up to `max_vertices` nothing is allocated after construction.
/// source Barber, Dobkin, Huhdanpaa 1996 (quickhull), with exact predicates
class LatticeHull {
 public:
  struct Face {
    std::array<int, 3> vertex{};     // counter-clockwise, seen from outside
    std::array<int, 3> neighbour{};  // [i] across the edge vertex[i], vertex[i + 1]
    Eigen::Vector3d normal;          // outward, not unit, rounded
    double doubt{0.0};               // a rounded height is at most this times the distance off
    bool alive{true};
    bool seen{false};
  };

  LatticeHull(int max_vertices, std::pmr::memory_resource* memory);

  /// Stores a point that Start or Grow may name; returns its index.
  int AddPoint(const LatticePoint& p);
  /// Makes the tetrahedron of four stored points; false if they lie in one plane.
  bool Start(int a, int b, int c, int d);
  /// Height of a stored point above a face, times the length of its normal; > 0 is outside.
  Int128 Height(int face, int point) const;
  /// The sign of that: whether the point lies outside. Looks at the exact height if rounding could
  /// tell otherwise.
  bool Sees(int point, int face) const;
  /// Outward, of length 1, right to the last digits also for a sliver.
  Eigen::Vector3d UnitNormal(int face) const;
  /// The same, each component rounded once from its exact value.
  Eigen::Vector3d ExactNormal(int face) const;
  /// Extends the polyhedron to a point that lies strictly outside `face`.
  void Grow(int point, int face);

  /// Faces that the last Grow removed (their content is still readable) and made.
  std::span<const int> removed() const { return removed_; }
  std::span<const int> created() const { return created_; }
  const Face& face(int i) const { return faces_[i]; }
  int face_slots() const { return static_cast<int>(faces_.size()); }
  const LatticePoint& point(int i) const { return points_[i]; }
  int points() const { return static_cast<int>(points_.size()); }

 private:
  int NewFace(int a, int b, int c);
  void CollectSeen(int point, int face);

  std::pmr::vector<LatticePoint> points_;
  std::pmr::vector<Face> faces_;
  std::pmr::vector<int> removed_, created_, free_;
  std::pmr::vector<int> face_from_;  // by vertex: the new face whose horizon edge starts there
};

}  // namespace oca::geometry::internal
