// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/lattice_hull.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace oca::geometry::internal {
namespace {

constexpr int kBits = 40;

// Differences need 41 bits, products of two 82, their difference 83: far inside 128.
std::array<Int128, 3> Normal(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
  const Int128 ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
  const Int128 vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  return {uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx};
}

Int128 Dot(const std::array<Int128, 3>& n, const LatticePoint& from, const LatticePoint& to) {
  return n[0] * (to.x - from.x) + n[1] * (to.y - from.y) + n[2] * (to.z - from.z);
}

// Both need at most 42 bits: nothing is rounded.
Eigen::Vector3d Rounded(const LatticePoint& from, const LatticePoint& to) {
  return {static_cast<double>(to.x - from.x), static_cast<double>(to.y - from.y),
          static_cast<double>(to.z - from.z)};
}

// A height n . d is a sum of six products; with the largest components U, V, D of the edges and of
// d, rounding of the normal and of the sum stay below 64 half units in the last place of U V D.
constexpr double kDoubt = 64.0 * 0x1p-53;

}  // namespace

Lattice::Lattice(const Eigen::Vector3d& centre, double extent) : centre_(centre) {
  step_ = std::ldexp(1.001 * extent, -kBits);  // a little room for rounding
}

LatticePoint Lattice::Round(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d q = (p - centre_) / step_;
  assert(q.cwiseAbs().maxCoeff() <= std::ldexp(1.0, kBits));
  return {std::llround(q.x()), std::llround(q.y()), std::llround(q.z())};
}

Eigen::Vector3d Lattice::Point(const LatticePoint& p) const {
  return centre_ + step_ * Eigen::Vector3d(p.x, p.y, p.z);
}

LatticeHull::LatticeHull(int max_vertices, std::pmr::memory_resource* memory)
    : points_(memory),
      faces_(memory),
      removed_(memory),
      created_(memory),
      free_(memory),
      face_from_(memory) {
  // A closed triangulation of V points has 2V - 4 faces; as many may be replaced in one step.
  points_.reserve(max_vertices);
  face_from_.reserve(max_vertices);
  faces_.reserve(4 * max_vertices);
  free_.reserve(4 * max_vertices);
  removed_.reserve(2 * max_vertices);
  created_.reserve(2 * max_vertices);
}

int LatticeHull::AddPoint(const LatticePoint& p) {
  points_.push_back(p);
  face_from_.push_back(-1);
  return points() - 1;
}

int LatticeHull::NewFace(int a, int b, int c) {
  int index;
  if (free_.empty()) {
    index = face_slots();
    faces_.emplace_back();
  } else {
    index = free_.back();
    free_.pop_back();
  }
  const Eigen::Vector3d u = Rounded(points_[a], points_[b]), v = Rounded(points_[a], points_[c]);
  faces_[index] = {.vertex = {a, b, c},
                   .normal = u.cross(v),
                   .doubt = kDoubt * u.cwiseAbs().maxCoeff() * v.cwiseAbs().maxCoeff()};
  created_.push_back(index);
  return index;
}

bool LatticeHull::Start(int a, int b, int c, int d) {
  const Int128 volume = Dot(Normal(points_[a], points_[b], points_[c]), points_[a], points_[d]);
  if (volume == 0) return false;
  if (volume > 0) std::swap(b, c);  // now d lies below the face a, b, c
  NewFace(a, b, c);
  NewFace(a, d, b);
  NewFace(b, d, c);
  NewFace(c, d, a);
  faces_[0].neighbour = {1, 2, 3};
  faces_[1].neighbour = {3, 2, 0};
  faces_[2].neighbour = {1, 3, 0};
  faces_[3].neighbour = {2, 1, 0};
  return true;
}

Int128 LatticeHull::Height(int face, int point) const {
  const auto& [a, b, c] = faces_[face].vertex;
  return Dot(Normal(points_[a], points_[b], points_[c]), points_[a], points_[point]);
}

bool LatticeHull::Sees(int point, int face) const {
  const Face& f = faces_[face];
  const Eigen::Vector3d d = Rounded(points_[f.vertex[0]], points_[point]);
  const double height = f.normal.dot(d);
  const double doubt = f.doubt * d.cwiseAbs().maxCoeff();
  if (height > doubt) return true;
  if (height < -doubt) return false;
  return Height(face, point) > 0;
}

Eigen::Vector3d LatticeHull::UnitNormal(int face) const {
  const Face& f = faces_[face];
  const double length = f.normal.norm();
  if (length > 0x1p33 * f.doubt) return f.normal / length;
  return ExactNormal(face);
}

Eigen::Vector3d LatticeHull::ExactNormal(int face) const {
  const auto& [a, b, c] = faces_[face].vertex;
  const auto exact = Normal(points_[a], points_[b], points_[c]);
  return Eigen::Vector3d(static_cast<double>(exact[0]), static_cast<double>(exact[1]),
                         static_cast<double>(exact[2]))
      .normalized();
}

// The seen faces are connected, so a walk from one of them finds all.
void LatticeHull::CollectSeen(int point, int face) {
  removed_.push_back(face);
  faces_[face].seen = true;
  for (std::size_t i = 0; i < removed_.size(); ++i) {
    for (const int next : faces_[removed_[i]].neighbour) {
      if (faces_[next].seen || !Sees(point, next)) continue;
      faces_[next].seen = true;
      removed_.push_back(next);
    }
  }
}

void LatticeHull::Grow(int point, int face) {
  assert(Sees(point, face));
  free_.insert(free_.end(), removed_.begin(), removed_.end());
  removed_.clear();
  created_.clear();
  CollectSeen(point, face);
  for (const int old : removed_) {
    for (int i = 0; i < 3; ++i) {
      const int beyond = faces_[old].neighbour[i];
      if (faces_[beyond].seen) continue;
      const int from = faces_[old].vertex[i], to = faces_[old].vertex[(i + 1) % 3];
      const int fresh = NewFace(from, to, point);
      faces_[fresh].neighbour[0] = beyond;
      auto& back = faces_[beyond].neighbour;
      *std::find(back.begin(), back.end(), old) = fresh;
      face_from_[from] = fresh;
    }
  }
  for (const int fresh : created_) {
    const int next = face_from_[faces_[fresh].vertex[1]];
    faces_[fresh].neighbour[1] = next;
    faces_[next].neighbour[2] = fresh;
  }
  for (const int old : removed_) faces_[old].alive = false;
}

}  // namespace oca::geometry::internal
