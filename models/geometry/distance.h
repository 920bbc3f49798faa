// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>

#include "oca/models/geometry/collider.h"

namespace oca::geometry {

/// What the numbers of a SignedDistance are worth.
enum class DistanceStatus {
  kExact,        ///< closed form, or proved from both sides to 1e-9 of the size of the pair
  kApproximate,  ///< best answer found; the two-sided proof stayed open
  kBeyond,       ///< farther than max_distance: `distance` is a lower bound, the rest a hint
  kInvalid       ///< a pose is not finite, or both are half-spaces; all numbers are NaN
};

/// Distance of two bodies A and B, nearest points and direction; world axes, m.
///
/// `distance` is negative in overlap: its size is then the shortest translation that separates.
/// `point_a` on A and `point_b` on B are nearest points, in overlap the deepest ones along
/// `normal`. `normal` is the unit direction from B to A, along which A gains distance fastest. It
/// is valid at touch and in overlap as well; (point_a - point_b) = distance * normal throughout.
struct SignedDistance {
  double distance{0.0};
  Eigen::Vector3d point_a{Eigen::Vector3d::Zero()};
  Eigen::Vector3d point_b{Eigen::Vector3d::Zero()};
  Eigen::Vector3d normal{Eigen::Vector3d::UnitX()};
  DistanceStatus status{DistanceStatus::kExact};
};

/// What one query leaves for the next one of the same pair, in the same order; only speed depends
/// on it. Keep one a pair of colliders; a fresh one is empty.
struct PairCache {
  int count{0};  ///< points that are kept; 0 of bodies that overlap
  int parts{0};  ///< of two compounds: which pair of parts was the nearest
  std::array<Eigen::Vector3d, 4> points_a;
  std::array<Eigen::Vector3d, 4> points_b;

  /// Of bodies that overlap: a closed surface of triangles, the corners differences of their
  /// points.
  struct Surface {
    static constexpr int kMostCorners = 64;
    static constexpr int kMostFaces = 2 * kMostCorners - 4;
    int corners{0};  ///< 0 if there is none
    int faces{0};
    std::array<Eigen::Vector3d, kMostCorners> points_a;
    std::array<Eigen::Vector3d, kMostCorners> points_b;
    std::array<std::array<std::uint8_t, 3>, kMostFaces> corner;
    std::array<std::array<std::uint8_t, 3>, kMostFaces> neighbour;
  } surface;
  void Clear() { count = 0, surface.corners = 0; }
};

/// Signed distance of A at pose `X_WA` and B at pose `X_WB`.
///
/// Closed forms for a half-space with anything, a sphere with anything but a mesh, capsules with
/// capsules, boxes and cylinders apart from them. Else GJK on the cores, with a lower and an upper
/// bound on the distance; for overlapping cores the separating axes of boxes, the planes of a mesh
/// around a sphere's centre, or the face of the Minkowski difference that is nearest to the origin.
/// The distance is continuous in the poses. Of compounds the least distance of their parts counts:
/// exact apart, in overlap the depth of the deepest part. A pair farther apart than `max_distance`
/// (m) may be left early with kBeyond. No heap, no exception; `cache` may be null.
/// source Gilbert, Johnson, Keerthi 1988 (GJK); van den Bergen 2001 (expanding polytope)
SignedDistance Distance(const Collider& a, const Eigen::Isometry3d& X_WA, const Collider& b,
                        const Eigen::Isometry3d& X_WB,
                        double max_distance = std::numeric_limits<double>::infinity(),
                        PairCache* cache = nullptr);

}  // namespace oca::geometry
