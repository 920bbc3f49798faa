// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/simplex.h"

#include <limits>

namespace oca::geometry::internal {

using Eigen::Vector3d;

Vector3d Simplex::PointA() const {
  Vector3d p = weight_[0] * points_[0].a;
  for (int i = 1; i < count_; ++i) p += weight_[i] * points_[i].a;
  return p;
}

Vector3d Simplex::PointB() const {
  Vector3d p = weight_[0] * points_[0].b;
  for (int i = 1; i < count_; ++i) p += weight_[i] * points_[i].b;
  return p;
}

// Compares the points on the bodies: w is rounded and may differ where they do not.
bool Simplex::Contains(const CorePair::Difference& p) const {
  for (int i = 0; i < count_; ++i) {
    if (points_[i].a == p.a && points_[i].b == p.b) return true;
  }
  return false;
}

void Simplex::OfPoint(int a, Nearest* nearest) const {
  nearest->count = 1;
  nearest->index[0] = a;
  nearest->weight[0] = 1.0;
  nearest->v = points_[a].w;
  nearest->squared = nearest->v.squaredNorm();
}

void Simplex::OfEdge(int a, int b, Nearest* nearest) const {
  const Vector3d& A = points_[a].w;
  const Vector3d edge = points_[b].w - A;
  const double length2 = edge.squaredNorm();
  const double along = -A.dot(edge);
  if (along <= 0.0 || length2 == 0.0) return OfPoint(a, nearest);
  if (along >= length2) return OfPoint(b, nearest);
  const double t = along / length2;
  nearest->count = 2;
  nearest->index = {a, b, 0};
  nearest->weight = {1.0 - t, t, 0.0};
  nearest->v = A + t * edge;
  nearest->squared = nearest->v.squaredNorm();
}

// Rounding decides where the origin is; so all edges are asked.
void Simplex::OfSliver(int a, int b, int c, Nearest* nearest) const {
  OfEdge(a, b, nearest);
  Nearest other;
  OfEdge(a, c, &other);
  if (other.squared < nearest->squared) *nearest = other;
  OfEdge(b, c, &other);
  if (other.squared < nearest->squared) *nearest = other;
}

// Ericson 2005, 5.1.5; the areas come from cross products, which lose fewer digits than his.
void Simplex::OfTriangle(int a, int b, int c, Nearest* nearest) const {
  const Vector3d &A = points_[a].w, &B = points_[b].w, &C = points_[c].w;
  const Vector3d ab = B - A, ac = C - A;
  const double d1 = -ab.dot(A), d2 = -ac.dot(A);
  if (d1 <= 0.0 && d2 <= 0.0) return OfPoint(a, nearest);
  const double d3 = -ab.dot(B), d4 = -ac.dot(B);
  if (d3 >= 0.0 && d4 <= d3) return OfPoint(b, nearest);
  const double d5 = -ab.dot(C), d6 = -ac.dot(C);
  if (d6 >= 0.0 && d5 <= d6) return OfPoint(c, nearest);
  const Vector3d n = ab.cross(ac);
  const double area_c = n.dot(A.cross(B)), area_a = n.dot(B.cross(C)), area_b = n.dot(C.cross(A));
  if (area_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return OfEdge(a, b, nearest);
  if (area_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return OfEdge(a, c, nearest);
  if (area_a <= 0.0 && d4 >= d3 && d5 >= d6) return OfEdge(b, c, nearest);
  const double n2 = n.squaredNorm();
  if (n2 <= 0.0 || area_a < 0.0 || area_b < 0.0 || area_c < 0.0) {
    return OfSliver(a, b, c, nearest);
  }
  const double share = 1.0 / (area_a + area_b + area_c);
  const double height = A.dot(n) / n2;
  nearest->count = 3;
  nearest->index = {a, b, c};
  nearest->weight = {area_a * share, area_b * share, area_c * share};
  nearest->v = n * height;
  nearest->squared = height * height * n2;
}

bool Simplex::OfTetrahedron(bool outside, Nearest* nearest) const {
  constexpr int kFaces[3][4] = {{0, 1, 3, 2}, {0, 2, 3, 1}, {1, 2, 3, 0}};
  nearest->squared = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (const auto& face : kFaces) {
    const Vector3d& p = points_[face[0]].w;
    const Vector3d n = (points_[face[1]].w - p).cross(points_[face[2]].w - p);
    const double origin = -p.dot(n), opposite = (points_[face[3]].w - p).dot(n);
    if (origin * opposite > 0.0 && !outside) continue;
    inside = false;
    Nearest here;
    OfTriangle(face[0], face[1], face[2], &here);
    if (here.squared < nearest->squared) *nearest = here;
  }
  return inside;
}

bool Simplex::FindNearest(bool outside, Nearest* nearest) const {
  switch (count_) {
    case 1:
      OfPoint(0, nearest);
      return true;
    case 2:
      OfEdge(0, 1, nearest);
      return true;
    case 3:
      OfTriangle(0, 1, 2, nearest);
      return true;
    default:
      return !OfTetrahedron(outside, nearest);
  }
}

void Simplex::Keep(const Nearest& nearest) {
  count_ = nearest.count;
  weight_ = nearest.weight;
  for (int i = 0; i < count_; ++i) {
    if (nearest.index[i] != i) points_[i] = points_[nearest.index[i]];
  }
  v_ = nearest.v;
}

}  // namespace oca::geometry::internal
