// SPDX-License-Identifier: BSD-3-Clause
#include "models/geometry/simplex.h"

#include <limits>

namespace oca::models::internal {

using Eigen::Vector3d;

Vector3d Simplex::PointA() const {
  Vector3d p = Vector3d::Zero();
  for (int i = 0; i < count_; ++i) p += weight_[i] * points_[i].a;
  return p;
}

Vector3d Simplex::PointB() const {
  Vector3d p = Vector3d::Zero();
  for (int i = 0; i < count_; ++i) p += weight_[i] * points_[i].b;
  return p;
}

// Compares the points on the bodies: w is rounded and may differ where they do not.
bool Simplex::Contains(const CorePair::Difference& p) const {
  for (int i = 0; i < count_; ++i) {
    if (points_[i].a == p.a && points_[i].b == p.b) return true;
  }
  return false;
}

Simplex::Nearest Simplex::OfPoint(int a) const {
  return {1, {a}, {1.0}, points_[a].w, points_[a].w.squaredNorm()};
}

Simplex::Nearest Simplex::OfEdge(int a, int b) const {
  const Vector3d& A = points_[a].w;
  const Vector3d edge = points_[b].w - A;
  const double length2 = edge.squaredNorm();
  const double along = -A.dot(edge);
  if (along <= 0.0 || length2 == 0.0) return OfPoint(a);
  if (along >= length2) return OfPoint(b);
  const double t = along / length2;
  const Vector3d v = A + t * edge;
  return {2, {a, b}, {1.0 - t, t}, v, v.squaredNorm()};
}

// Ericson 2005, 5.1.5; the areas come from cross products, which lose fewer digits than his.
Simplex::Nearest Simplex::OfTriangle(int a, int b, int c) const {
  const Vector3d &A = points_[a].w, &B = points_[b].w, &C = points_[c].w;
  const Vector3d ab = B - A, ac = C - A;
  const double d1 = -ab.dot(A), d2 = -ac.dot(A);
  if (d1 <= 0.0 && d2 <= 0.0) return OfPoint(a);
  const double d3 = -ab.dot(B), d4 = -ac.dot(B);
  if (d3 >= 0.0 && d4 <= d3) return OfPoint(b);
  const double d5 = -ab.dot(C), d6 = -ac.dot(C);
  if (d6 >= 0.0 && d5 <= d6) return OfPoint(c);
  const Vector3d n = ab.cross(ac);
  const double area_c = n.dot(A.cross(B)), area_a = n.dot(B.cross(C)), area_b = n.dot(C.cross(A));
  if (area_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return OfEdge(a, b);
  if (area_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return OfEdge(a, c);
  if (area_a <= 0.0 && d4 >= d3 && d5 >= d6) return OfEdge(b, c);
  const double n2 = n.squaredNorm();
  if (n2 <= 0.0 || area_a < 0.0 || area_b < 0.0 || area_c < 0.0) {  // a sliver: rounding decides
    Nearest best = OfEdge(a, b);
    for (const Nearest& other : {OfEdge(a, c), OfEdge(b, c)}) {
      if (other.squared < best.squared) best = other;
    }
    return best;
  }
  const double sum = area_a + area_b + area_c;
  const Vector3d v = n * (A.dot(n) / n2);
  return {3, {a, b, c}, {area_a / sum, area_b / sum, area_c / sum}, v, v.squaredNorm()};
}

bool Simplex::OfTetrahedron(bool outside, Nearest* nearest) const {
  constexpr int kFaces[4][4] = {{0, 1, 2, 3}, {0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  nearest->squared = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (const auto& face : kFaces) {
    const Vector3d& p = points_[face[0]].w;
    const Vector3d n = (points_[face[1]].w - p).cross(points_[face[2]].w - p);
    const double origin = -p.dot(n), opposite = (points_[face[3]].w - p).dot(n);
    if (origin * opposite > 0.0 && !outside) continue;
    inside = false;
    const Nearest here = OfTriangle(face[0], face[1], face[2]);
    if (here.squared < nearest->squared) *nearest = here;
  }
  return inside;
}

void Simplex::Keep(const Nearest& nearest) {
  const auto all = points_;
  count_ = nearest.count;
  for (int i = 0; i < count_; ++i) {
    points_[i] = all[nearest.index[i]];
    weight_[i] = nearest.weight[i];
  }
  v_ = nearest.v;
}

bool Simplex::Reduce(bool outside) {
  Nearest nearest;
  switch (count_) {
    case 1:
      nearest = OfPoint(0);
      break;
    case 2:
      nearest = OfEdge(0, 1);
      break;
    case 3:
      nearest = OfTriangle(0, 1, 2);
      break;
    default:
      if (OfTetrahedron(outside, &nearest)) return false;
  }
  Keep(nearest);
  return true;
}

}  // namespace oca::models::internal
