// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/star_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;

// Six times the volume below a triangle with edges U and V, corners within R, is rounded by less
// than 64 half units in the last place of R U V.
constexpr double kVolumeDoubt = 64.0 * 0x1p-53;
constexpr double kInPlane = 1e-12;  // of the reach: a corner no higher lies in a face's plane

}  // namespace

bool StarSurface::SetFace(int index, int a, int b, int c) {
  const Vector3d &p = corners_[a].w, &q = corners_[b].w, &r = corners_[c].w;
  const Vector3d u = q - p, v = r - p;
  const Vector3d across = u.cross(v);
  const double volume = across.dot(p);
  const double doubt = kVolumeDoubt * reach_;
  if (!(volume > 0.0 && volume * volume > doubt * doubt * u.squaredNorm() * v.squaredNorm())) {
    return false;
  }
  Face& face = faces_[index];
  face.normal = across * (1.0 / std::sqrt(across.squaredNorm()));
  face.corner = {static_cast<std::int16_t>(a), static_cast<std::int16_t>(b),
                 static_cast<std::int16_t>(c)};
  face.seen = false;
  // The least of the three: true also where a sliver's normal is rounded off.
  offset_[index] = std::min({face.normal.dot(p), face.normal.dot(q), face.normal.dot(r)});
  return true;
}

bool StarSurface::Start(std::span<const Corner, 4> corners) {
  std::copy(corners.begin(), corners.end(), corners_.begin());
  corner_count_ = face_slots_ = 4;
  std::fill_n(cone_from_.begin(), 4, std::int16_t{0});
  const Vector3d& w = corners[0].w;
  if ((corners[1].w - w).cross(corners[2].w - w).dot(corners[3].w - w) > 0.0) {
    std::swap(corners_[1], corners_[2]);  // now corner 3 lies below the face 0, 1, 2
  }
  if (!(SetFace(0, 0, 1, 2) && SetFace(1, 0, 3, 1) && SetFace(2, 1, 3, 2) && SetFace(3, 2, 3, 0))) {
    return false;
  }
  faces_[0].neighbour = {1, 2, 3};
  faces_[1].neighbour = {3, 2, 0};
  faces_[2].neighbour = {1, 3, 0};
  faces_[3].neighbour = {2, 1, 0};
  return true;
}

bool StarSurface::Restore(const CorePair& pair, const PairCache::Surface& kept) {
  corner_count_ = kept.corners;
  face_slots_ = kept.faces;
  for (int i = 0; i < corner_count_; ++i) {
    corners_[i] = pair.At(kept.points_a[i], kept.points_b[i]);
    cone_from_[i] = 0;
  }
  for (int i = 0; i < face_slots_; ++i) {
    const auto& corner = kept.corner[i];
    if (!SetFace(i, corner[0], corner[1], corner[2])) return false;
    std::copy(kept.neighbour[i].begin(), kept.neighbour[i].end(), faces_[i].neighbour.begin());
  }
  return true;
}

// Corners and faces get new numbers, for those that were covered have left gaps.
void StarSurface::Keep(PairCache::Surface* kept) const {
  std::array<std::int16_t, kMostCorners> new_corner;
  std::fill_n(new_corner.begin(), corner_count_, std::int16_t{-1});
  std::array<std::uint8_t, kMostFaces> new_face;
  kept->corners = 0;
  int corners = 0, faces = 0;
  for (int i = 0; i < face_slots_; ++i) {
    if (!IsFace(i)) continue;
    if (faces == PairCache::Surface::kMostFaces) return;
    for (int k = 0; k < 3; ++k) {
      std::int16_t& place = new_corner[faces_[i].corner[k]];
      if (place < 0) {
        if (corners == PairCache::Surface::kMostCorners) return;
        place = static_cast<std::int16_t>(corners);
        kept->points_a[corners] = corners_[faces_[i].corner[k]].a;
        kept->points_b[corners++] = corners_[faces_[i].corner[k]].b;
      }
      kept->corner[faces][k] = static_cast<std::uint8_t>(place);
    }
    new_face[i] = static_cast<std::uint8_t>(faces++);
  }
  kept->faces = 0;
  for (int i = 0; i < face_slots_; ++i) {
    if (!IsFace(i)) continue;
    for (int k = 0; k < 3; ++k) kept->neighbour[kept->faces][k] = new_face[faces_[i].neighbour[k]];
    ++kept->faces;
  }
  kept->corners = corners;
}

int StarSurface::LowestFace() const {
  return static_cast<int>(std::min_element(offset_.begin(), offset_.begin() + face_slots_) -
                          offset_.begin());
}

int StarSurface::FreeSlot() {
  if (free_count_ > 0) return free_[--free_count_];
  return face_slots_ < kMostFaces ? face_slots_++ : -1;
}

void StarSurface::CollectSeen(const Vector3d& w, int face) {
  const double in_plane = kInPlane * reach_;
  seen_count_ = 0;
  seen_[seen_count_++] = static_cast<std::int16_t>(face);
  faces_[face].seen = true;
  for (int i = 0; i < seen_count_; ++i) {
    for (const std::int16_t next : faces_[seen_[i]].neighbour) {
      Face& beyond = faces_[next];
      if (beyond.seen || beyond.normal.dot(w) <= offset_[next] + in_plane) continue;
      beyond.seen = true;
      seen_[seen_count_++] = next;
    }
  }
}

// Joins the cone's faces to each other. The rim may touch itself; then a face has two before it.
bool StarSurface::CloseCone(int apex) {
  for (int i = 0; i < cone_count_; ++i) {
    Face& face = faces_[cone_[i]];
    const std::int16_t next = cone_from_[face.corner[1]];
    Face& after = faces_[next];
    if (after.corner[2] != apex || after.corner[0] != face.corner[1] || after.neighbour[2] >= 0) {
      return false;
    }
    face.neighbour[1] = next;
    after.neighbour[2] = cone_[i];
  }
  return true;
}

bool StarSurface::Grow(const Corner& corner, int face) {
  const int apex = corner_count_++;
  corners_[apex] = corner;
  cone_from_[apex] = 0;
  CollectSeen(corner.w, face);
  cone_count_ = 0;
  for (int i = 0; i < seen_count_; ++i) {
    const std::int16_t old = seen_[i];
    for (int k = 0; k < 3; ++k) {
      const std::int16_t beyond = faces_[old].neighbour[k];
      if (faces_[beyond].seen) continue;
      const int from = faces_[old].corner[k], to = faces_[old].corner[(k + 1) % 3];
      const int fresh = FreeSlot();
      if (fresh < 0 || !SetFace(fresh, from, to, apex)) return false;
      faces_[fresh].neighbour = {beyond, -1, -1};
      Face& outer = faces_[beyond];
      const auto edge = std::find(outer.corner.begin(), outer.corner.end(), to);
      outer.neighbour[edge - outer.corner.begin()] = static_cast<std::int16_t>(fresh);
      cone_[cone_count_++] = static_cast<std::int16_t>(fresh);
      cone_from_[from] = static_cast<std::int16_t>(fresh);
    }
  }
  for (int i = 0; i < seen_count_; ++i) {
    offset_[seen_[i]] = std::numeric_limits<double>::infinity();
    free_[free_count_++] = seen_[i];
  }
  return cone_count_ > 0 && CloseCone(apex);
}

}  // namespace oca::geometry::internal
