// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "oca/models/geometry/core_pair.h"
#include "oca/models/geometry/distance.h"

namespace oca::geometry::internal {

/// A closed surface of triangles around the origin, with corners in a convex set A - B.
///
/// All that is asked of a triangle is that it faces away from the origin, beyond doubt of rounding.
/// The surface is a cycle (each edge has a triangle on either side), so the rays from the origin
/// meet it equally often, and at least once: a ball about the origin that reaches no triangle's
/// plane lies within A - B, which is convex. The surface itself need not be, hence doubles do.
class StarSurface {
 public:
  using Corner = CorePair::Difference;
  static constexpr int kMostCorners = 256;
  static constexpr int kMostFaces = 4 * kMostCorners;  // 2V - 4, and as many that take their place
  struct Face {
    Eigen::Vector3d normal;                 // unit, outward
    std::array<std::int16_t, 3> corner;     // counter-clockwise, seen from outside
    std::array<std::int16_t, 3> neighbour;  // [i] across the edge corner[i], corner[i + 1]
    bool seen;
  };

  /// `reach`: no corner is farther from the origin, m.
  explicit StarSurface(double reach) : reach_(reach) {}

  /// Makes the tetrahedron of four corners; false if the origin is not well inside.
  bool Start(std::span<const Corner, 4> corners);
  /// Takes over the surface of the last query, moved with the bodies; false if the origin is no
  /// longer well inside.
  bool Restore(const CorePair& pair, const PairCache::Surface& kept);
  /// Leaves the surface for the next query, or nothing if it is too large.
  void Keep(PairCache::Surface* kept) const;
  /// Replaces the faces that `corner` lies above, `face` and those around it, by a cone; false if
  /// the surface would be in doubt: it is then spoilt. The surface must not be Full().
  bool Grow(const Corner& corner, int face);

  /// The face with the least offset, hence the radius of the ball that is proved to lie inside.
  int LowestFace() const;
  const Face& face(int i) const { return faces_[i]; }
  /// No point of face i is lower along its normal, m; infinite if there is no such face any more.
  double offset(int i) const { return offset_[i]; }
  int face_slots() const { return face_slots_; }
  const Corner& corner(int i) const { return corners_[i]; }
  int corners() const { return corner_count_; }
  bool Full() const { return corner_count_ == kMostCorners; }

 private:
  bool IsFace(int i) const { return offset_[i] < std::numeric_limits<double>::infinity(); }
  bool SetFace(int index, int a, int b, int c);
  int FreeSlot();
  void CollectSeen(const Eigen::Vector3d& w, int face);
  bool CloseCone(int apex);

  double reach_;
  int corner_count_{0}, face_slots_{0}, free_count_{0}, seen_count_{0}, cone_count_{0};
  std::array<Corner, kMostCorners> corners_;
  std::array<Face, kMostFaces> faces_;
  std::array<double, kMostFaces> offset_;
  std::array<std::int16_t, kMostFaces> free_, seen_, cone_;
  std::array<std::int16_t, kMostCorners> cone_from_;  // by corner: the face whose rim starts there
};

}  // namespace oca::geometry::internal
