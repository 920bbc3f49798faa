// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/polytope_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory_resource>

#include "oca/models/geometry/exit_point.h"
#include "oca/models/geometry/lattice_hull.h"

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;

constexpr int kMaxVertices = 256;
constexpr double kEnough = 1e-10;  // gap that ends the search, relative to the size of the pair
// Per vertex: a point, four faces with their planes, and the index lists of LatticeHull.
constexpr std::size_t kArenaBytes =
    kMaxVertices * (sizeof(LatticePoint) + 4 * sizeof(LatticeHull::Face) + 48 * sizeof(int)) + 1024;

struct Plane {
  Vector3d normal;
  double offset;
};

class Polytope {
 public:
  Polytope(const CorePair& pair, std::pmr::memory_resource* memory)
      : pair_(pair), lattice_(pair.Centre(), 1.001 * pair.Extent()), hull_(kMaxVertices, memory) {}

  // A tetrahedron of extreme points; A - B has volume, so one exists.
  bool Start();
  // Adds the farthest point of A - B along a direction if it lies outside.
  void Reach(const Vector3d& direction);
  CoreDistance Search();

 private:
  int Add(const Vector3d& direction);
  int AddFarther(const Vector3d& direction, const Vector3d& from);
  void RefreshPlanes();
  int LowestFace() const;
  bool Full() const { return hull_.points() >= kMaxVertices; }
  void Straighten(Plane* plane) const;
  void Descend(Plane* plane) const;
  void Sharpen(const std::array<int, 3>& face, Plane* plane) const;
  bool Try(const Vector3d& normal, Plane* plane) const;
  Triangle Corners(const std::array<int, 3>& face) const {
    return {&source_[face[0]], &source_[face[1]], &source_[face[2]]};
  }
  std::array<int, 3> FaceBelow(const Vector3d& normal, double highest) const;

  const CorePair& pair_;
  Lattice lattice_;
  LatticeHull hull_;
  std::array<CorePair::Difference, kMaxVertices> source_;
  std::array<Vector3d, 4 * kMaxVertices> normal_;
  std::array<double, 4 * kMaxVertices> offset_;  // infinite where there is no face
};

int Polytope::Add(const Vector3d& direction) {
  const CorePair::Difference p = pair_.Support(direction);
  const int index = hull_.AddPoint(lattice_.Round(p.w));
  source_[index] = p;
  return index;
}

int Polytope::AddFarther(const Vector3d& direction, const Vector3d& from) {
  const double ahead = direction.dot(pair_.Support(direction).w - from);
  const double behind = direction.dot(from - pair_.Support(-direction).w);
  return Add(ahead >= behind ? direction : Vector3d(-direction));
}

bool Polytope::Start() {
  const int a = Add(Vector3d::UnitX());
  const Vector3d wa = source_[a].w;
  // The farthest of the axis supports: A - B may be thin along any one axis.
  Vector3d axis = -Vector3d::UnitX();
  double farthest = -1.0;
  for (int i = 0; i < 6; ++i) {
    const Vector3d direction = (i < 3 ? 1.0 : -1.0) * Vector3d::Unit(i % 3);
    const double distance = (pair_.Support(direction).w - wa).norm();
    if (distance > farthest) farthest = distance, axis = direction;
  }
  const int b = Add(axis);
  const Vector3d along = (source_[b].w - wa).normalized();
  const Vector3d side = along.unitOrthogonal();
  const Vector3d other = along.cross(side);
  const auto width = [&](const Vector3d& d) {
    return d.dot(pair_.Support(d).w) + d.dot(-pair_.Support(-d).w);
  };
  const int c = AddFarther(width(side) >= width(other) ? side : other, wa);
  const Vector3d normal = along.cross(source_[c].w - wa).normalized();
  const int d = AddFarther(normal, wa);
  if (!hull_.Start(a, b, c, d)) return false;
  RefreshPlanes();
  return true;
}

void Polytope::RefreshPlanes() {
  for (const int i : hull_.removed()) offset_[i] = std::numeric_limits<double>::infinity();
  for (const int i : hull_.created()) {
    normal_[i] = hull_.UnitNormal(i);
    offset_[i] = normal_[i].dot(lattice_.Point(hull_.point(hull_.face(i).vertex[0])));
  }
}

int Polytope::LowestFace() const {
  return static_cast<int>(std::min_element(offset_.begin(), offset_.begin() + hull_.face_slots()) -
                          offset_.begin());
}

void Polytope::Reach(const Vector3d& direction) {
  if (direction.isZero(0.0) || Full()) return;
  const int point = Add(direction);
  for (int i = 0; i < hull_.face_slots(); ++i) {
    if (!hull_.face(i).alive || !hull_.Sees(point, i)) continue;
    hull_.Grow(point, i);
    RefreshPlanes();
    return;
  }
}

CoreDistance Polytope::Search() {
  const double enough = kEnough * pair_.Extent();
  Plane best{Vector3d::UnitX(), std::numeric_limits<double>::infinity()};
  while (true) {
    const int lowest = LowestFace();
    const Plane plane{normal_[lowest], offset_[lowest]};
    const int point = Full() ? -1 : Add(plane.normal);
    const Vector3d w = point < 0 ? pair_.Support(plane.normal).w : source_[point].w;
    const double reach = plane.normal.dot(w);
    if (reach < best.offset) best = {plane.normal, reach};
    if (point < 0 || best.offset - plane.offset <= enough || !hull_.Sees(point, lowest)) {
      Straighten(&best);
      if (best.offset - plane.offset > enough) Descend(&best);
      // The lattice may put the face a step above the plane that bounds A - B.
      const std::array<int, 3> face = FaceBelow(best.normal, best.offset + enough);
      if (!pair_.IsRound()) Sharpen(face, &best);
      return ExitPoint(pair_, Corners(face), best.normal, best.offset,
                       std::max(best.offset - plane.offset, 0.0));
    }
    hull_.Grow(point, lowest);
    RefreshPlanes();
  }
}

bool Polytope::Try(const Vector3d& normal, Plane* plane) const {
  const double reach = normal.dot(pair_.Support(normal).w);
  if (!(reach < plane->offset)) return false;
  *plane = {normal, reach};
  return true;
}

// A ring of equally near exits (a cylinder whose axis meets an edge) ends in a full polytope and a
// slightly skew normal; across the axis of a body the exit is often shorter.
void Polytope::Straighten(Plane* plane) const {
  for (const Vector3d& axis : {Vector3d(Vector3d::UnitZ()), Vector3d(pair_.X_AB.linear().col(2))}) {
    const Vector3d across = plane->normal - plane->normal.dot(axis) * axis;
    if (across.squaredNorm() >= 0.5) Try(across.normalized(), plane);
  }
}

// What is left to gain where the polytope is used up: turns the normal by smaller and smaller
// angles, every time about other axes, for the exits may lie in a narrow valley. A ring of equal
// exits has no end, hence the number of turns.
void Polytope::Descend(Plane* plane) const {
  constexpr double kCoarsest = 0.02, kFinest = 1e-8;  // rad
  constexpr double kShrink = 0.8, kNextAxis = 2.4;    // rad, about the golden section of a turn
  constexpr int kMostTurns = 400;
  double angle = kCoarsest;
  for (int turn = 0; turn < kMostTurns && angle > kFinest; ++turn) {
    const Vector3d e = plane->normal.unitOrthogonal(), f = plane->normal.cross(e);
    const double c = std::cos(kNextAxis * turn), s = std::sin(kNextAxis * turn);
    const Vector3d u = c * e + s * f, v = c * f - s * e;
    const double before = plane->offset;
    for (const Vector3d& side : {u, v, Vector3d(-u), Vector3d(-v)}) {
      Try((plane->normal + angle * side).normalized(), plane);
    }
    if (before - plane->offset < 1e-3 * angle * angle * pair_.Extent()) angle *= kShrink;
  }
}

// The normal of the face that its points have off the lattice: it has the digits of the input.
void Polytope::Sharpen(const std::array<int, 3>& face, Plane* plane) const {
  const Vector3d& w = source_[face[0]].w;
  const Vector3d across = (source_[face[1]].w - w).cross(source_[face[2]].w - w);
  const double length = across.norm();
  if (length > 0.0 && across.dot(plane->normal) > 0.9 * length) Try(across / length, plane);
}

// The face that the ray from the origin meets. Several may lie in one plane, hence `highest`; none
// lies there if the lattice rounds them all above it, and then it is the lowest.
std::array<int, 3> Polytope::FaceBelow(const Vector3d& normal, double highest) const {
  int below = LowestFace();
  double most = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < hull_.face_slots(); ++i) {
    if (!hull_.face(i).alive || offset_[i] > highest) continue;
    const double inside = RayWeights(Corners(hull_.face(i).vertex), normal).minCoeff();
    if (inside > most) most = inside, below = i;
  }
  return hull_.face(below).vertex;
}

}  // namespace

CoreDistance PolytopeDepth(const CorePair& pair, const Vector3d& hint) {
  alignas(std::max_align_t) std::array<std::byte, kArenaBytes> bytes;
  std::pmr::monotonic_buffer_resource arena(bytes.data(), bytes.size(),
                                            std::pmr::null_memory_resource());
  Polytope polytope(pair, &arena);
  if (!polytope.Start()) {
    return {.distance = std::numeric_limits<double>::quiet_NaN(),
            .gap = std::numeric_limits<double>::infinity()};
  }
  polytope.Reach(hint);
  return polytope.Search();
}

}  // namespace oca::geometry::internal
