// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/surface_depth.h"

#include <algorithm>
#include <limits>

#include "oca/models/geometry/exit_point.h"
#include "oca/models/geometry/star_surface.h"

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;

constexpr double kProved = 1e-10;  // gap that ends the search, relative to the size of the pair

Triangle CornersOf(const StarSurface& surface, int face) {
  const auto& corner = surface.face(face).corner;
  return {&surface.corner(corner[0]), &surface.corner(corner[1]), &surface.corner(corner[2])};
}

// The face that the ray from the origin meets; several may lie in one plane, hence `highest`.
Triangle FaceBelow(const StarSurface& surface, const Vector3d& normal, double highest) {
  int below = surface.LowestFace();
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < surface.face_slots(); ++i) {
    if (!(surface.offset(i) <= highest)) continue;
    const double inside = RayWeights(CornersOf(surface, i), normal).minCoeff();
    if (inside > most) most = inside, below = i;
  }
  return CornersOf(surface, below);
}

// Grows the surface to the answer.
bool Search(const CorePair& pair, StarSurface* surface, PairCache* cache, CoreDistance* found) {
  const double enough = kProved * pair.Extent();
  Vector3d normal = Vector3d::Zero();
  double depth = std::numeric_limits<double>::infinity();
  bool grown = false;
  while (true) {
    const int lowest = surface->LowestFace();
    const Vector3d& across = surface->face(lowest).normal;
    const CorePair::Difference farthest = pair.Support(across);
    const double reach = across.dot(farthest.w);
    if (reach < depth) depth = reach, normal = across;
    const double gap = depth - surface->offset(lowest);
    if (gap <= enough) {
      *found = ExitPoint(pair, FaceBelow(*surface, normal, depth + enough), normal, depth,
                         std::max(gap, 0.0));
      if (cache && (grown || cache->surface.corners == 0)) surface->Keep(&cache->surface);
      return true;
    }
    if (surface->Full() || !surface->Grow(farthest, lowest)) return false;
    grown = true;
  }
}

double Reach(const CorePair& pair) { return pair.Centre().norm() + pair.Extent(); }

}  // namespace

bool SurfaceDepth(const CorePair& pair, std::span<const CorePair::Difference, 4> around,
                  PairCache* cache, CoreDistance* found) {
  StarSurface surface(Reach(pair));
  return surface.Start(around) && Search(pair, &surface, cache, found);
}

bool KeptSurfaceDepth(const CorePair& pair, PairCache* cache, CoreDistance* found) {
  StarSurface surface(Reach(pair));
  if (surface.Restore(pair, cache->surface) && Search(pair, &surface, cache, found)) return true;
  cache->surface.corners = 0;
  return false;
}

}  // namespace oca::geometry::internal
