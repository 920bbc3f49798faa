// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/convex_hull.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/geometry/hull_support.h"
#include "oca/models/geometry/lattice_hull.h"

namespace oca::geometry {
namespace {

using Eigen::Vector3d;
using internal::Int128;
using internal::Lattice;
using internal::LatticeHull;
using internal::LatticePoint;

constexpr double kFlat = 1e-6;       // thinnest hull, of its extent: above the noise of float files
constexpr double kExtentMin = 1e-9;  // m; below, areas and volumes lose their digits
constexpr double kExtentMax = 1e9;   // m

// Up to so many each plane looks at every vertex, which takes milliseconds; beyond, it grows with
// the square of their number.
constexpr std::size_t kFewVertices = 4096;

struct Extent {
  Vector3d centre;
  double size;  // half of the largest edge of the bounding box
};

Extent CheckedExtent(std::span<const Vector3d> points, std::string_view name) {
  if (points.size() < 4) {
    throw models::ModelError(fmt::format(
        "{}: too few points for a convex hull; got {}; expected 4 or more", name, points.size()));
  }
  Vector3d low = points[0], high = points[0];
  for (const Vector3d& p : points) {
    if (!p.allFinite()) {
      throw models::ModelError(
          fmt::format("{}: vertex {} is not finite; got ({}, {}, {}); expected numbers", name,
                      &p - points.data(), p.x(), p.y(), p.z()));
    }
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  Extent extent{0.5 * (low + high), 0.5 * (high - low).maxCoeff()};
  if (!(extent.size >= kExtentMin && extent.size <= kExtentMax)) {
    throw models::ModelError(fmt::format("{}: size out of range; got {} m; expected {} to {} m",
                                         name, 2 * extent.size, 2 * kExtentMin, 2 * kExtentMax));
  }
  return extent;
}

struct Node {
  LatticePoint at;
  int index;  // of the point that was rounded to it
  friend auto operator<=>(const Node&, const Node&) = default;
};

// The distinct nodes, in the order of the lattice, each with the first point that lies there.
std::vector<Node> Weld(std::span<const Vector3d> points, const Lattice& lattice) {
  std::vector<Node> nodes;
  nodes.reserve(points.size());
  for (const Vector3d& p : points) {
    nodes.push_back({lattice.Round(p), static_cast<int>(nodes.size())});
  }
  std::sort(nodes.begin(), nodes.end());
  const auto same = [](const Node& a, const Node& b) { return a.at == b.at; };
  nodes.erase(std::unique(nodes.begin(), nodes.end(), same), nodes.end());
  return nodes;
}

template <typename Measure>
std::pair<int, double> Farthest(std::span<const Vector3d> points, Measure measure) {
  std::pair<int, double> best{0, -1.0};
  for (int i = 0; i < static_cast<int>(points.size()); ++i) {
    const double value = measure(points[i]);
    if (value > best.second) best = {i, value};
  }
  return best;
}

// Four points that span as much volume as a greedy choice finds.
std::array<int, 4> StartCorners(std::span<const Vector3d> points, double extent,
                                std::string_view name) {
  const int a = Farthest(points, [](const Vector3d& p) { return p.x() + 1e300; }).first;
  const Vector3d& pa = points[a];
  const int b = Farthest(points, [&](const Vector3d& p) { return (p - pa).norm(); }).first;
  const Vector3d along = (points[b] - pa).normalized();
  const auto [c, width] =
      Farthest(points, [&](const Vector3d& p) { return along.cross(p - pa).norm(); });
  const Vector3d normal = along.cross(points[c] - pa).normalized();
  const auto [d, thickness] =
      Farthest(points, [&](const Vector3d& p) { return std::abs(normal.dot(p - pa)); });
  if (!(std::min(width, thickness) > kFlat * extent)) {
    throw models::ModelError(
        fmt::format("{}: the points lie in one plane or line; got a thickness of {} m over {} m; "
                    "expected a body with volume",
                    name, std::min(width, thickness), 2 * extent));
  }
  return {a, b, c, d};
}

// Quickhull: every point still outside waits at one face that sees it.
//
// Faces at which many wait go first, in the order they were made: the hull takes its shape evenly,
// and no face grows to a fan of thousands that thousands of points are tried on, as it would on a
// rim. The others then go depth first, which stays within the processor's cache.
class Quickhull {
 public:
  explicit Quickhull(const std::vector<Node>& nodes)
      : hull_(static_cast<int>(nodes.size()), std::pmr::get_default_resource()),
        next_(nodes.size(), -1) {
    for (const Node& node : nodes) hull_.AddPoint(node.at);
  }

  void Run(const std::array<int, 4>& corners) {
    hull_.Start(corners[0], corners[1], corners[2], corners[3]);
    std::vector<int> waiting(next_.size());
    for (std::size_t i = 0; i < waiting.size(); ++i) waiting[i] = static_cast<int>(i);
    Distribute(waiting);
    while (!crowded_.empty() || !pending_.empty()) {
      const int face = TakeFace();
      if (!hull_.face(face).alive || first_[face] < 0) continue;
      hull_.Grow(Highest(face), face);
      waiting.clear();
      for (const int old : hull_.removed()) {
        for (int p = first_[old]; p >= 0; p = next_[p]) waiting.push_back(p);
        first_[old] = -1;
      }
      Distribute(waiting);
    }
  }

  const LatticeHull& hull() const { return hull_; }

 private:
  static constexpr int kMany = 1024;

  int TakeFace() {
    if (crowded_.empty()) {
      const int face = pending_.back();
      pending_.pop_back();
      return face;
    }
    const int face = crowded_.front();
    crowded_.pop_front();
    return face;
  }

  void Distribute(const std::vector<int>& points) {
    first_.resize(hull_.face_slots(), -1);
    count_.resize(hull_.face_slots(), 0);
    for (const int face : hull_.created()) count_[face] = 0;
    for (const int p : points) {
      for (const int face : hull_.created()) {
        if (!hull_.Sees(p, face)) continue;
        next_[p] = std::exchange(first_[face], p);
        ++count_[face];
        break;
      }
    }
    for (const int face : hull_.created()) {
      if (count_[face] > kMany) {
        crowded_.push_back(face);
      } else if (count_[face] > 0) {
        pending_.push_back(face);
      }
    }
  }

  int Highest(int face) const {
    int best = first_[face];
    Int128 height = hull_.Height(face, best);
    for (int p = next_[best]; p >= 0; p = next_[p]) {
      const Int128 h = hull_.Height(face, p);
      if (h > height) best = p, height = h;
    }
    return best;
  }

  LatticeHull hull_;
  std::vector<int> first_, next_;  // lists of waiting points, by face
  std::vector<int> count_;         // of each list
  std::vector<int> pending_;
  std::deque<int> crowded_;
};

void CopySurface(const LatticeHull& hull, std::span<const Vector3d> points, ConvexHull* result) {
  std::vector<int> index(points.size(), -1);
  for (int i = 0; i < hull.face_slots(); ++i) {
    if (!hull.face(i).alive) continue;
    std::array<int, 3> triangle = hull.face(i).vertex;
    for (int& v : triangle) {
      if (index[v] < 0) {
        index[v] = static_cast<int>(result->vertices.size());
        result->vertices.push_back(points[v]);
      }
      v = index[v];
    }
    result->triangles.push_back(triangle);
  }
}

void Measure(const Vector3d& centre, ConvexHull* hull) {
  hull->centre = centre;
  for (const Vector3d& p : hull->vertices) {
    hull->radius = std::max(hull->radius, (p - centre).norm());
  }
  Vector3d moment = Vector3d::Zero();
  for (const auto& [a, b, c] : hull->triangles) {
    const Vector3d pa = hull->vertices[a] - centre, pb = hull->vertices[b] - centre,
                   pc = hull->vertices[c] - centre;
    const double volume = pa.dot(pb.cross(pc)) / 6.0;
    hull->volume += volume;
    moment += volume * (pa + pb + pc) / 4.0;
  }
  hull->centroid = centre + moment / hull->volume;
}

void FillColumns(ConvexHull* hull) {
  const int n = static_cast<int>(hull->vertices.size());
  hull->column_size = (n + 7) / 8 * 8;
  hull->columns.resize(3 * hull->column_size);
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < hull->column_size; ++i) {
      hull->columns[axis * hull->column_size + i] = hull->vertices[i < n ? i : 0][axis];
    }
  }
}

// A thin triangle has a skew normal; its plane still bounds the hull, for it is moved out to touch.
void FillPlanesThatTouch(ConvexHull* hull) {
  hull->planes.reserve(hull->triangles.size());
  for (const auto& [a, b, c] : hull->triangles) {
    const Vector3d& pa = hull->vertices[a];
    const Vector3d across = (hull->vertices[b] - pa).cross(hull->vertices[c] - pa);
    if (!(across.stableNorm() > 0.0)) continue;
    const Vector3d normal = across.stableNormalized();
    const int farthest = internal::FarthestVertex(*hull, normal);
    hull->planes.push_back({normal, normal.dot(hull->vertices[farthest])});
  }
}

// On the lattice no vertex lies beyond a face. There, each vertex has moved by less than 0.87
// steps, and normal and products are rounded; so much room is left, and no vertex is looked at.
void FillPlanesOfLattice(const LatticeHull& lattice_hull, double step, ConvexHull* hull) {
  double largest = 0.0;
  for (const Vector3d& p : hull->vertices) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  const double room = 2.0 * step + 0x1p-49 * largest;
  hull->planes.reserve(hull->triangles.size());
  std::size_t triangle = 0;
  for (int i = 0; i < lattice_hull.face_slots(); ++i) {
    if (!lattice_hull.face(i).alive) continue;
    const Vector3d normal = lattice_hull.ExactNormal(i);
    const Vector3d& corner = hull->vertices[hull->triangles[triangle++][0]];
    hull->planes.push_back({normal, normal.dot(corner) + room});
  }
}

}  // namespace

std::shared_ptr<const ConvexHull> MakeConvexHull(std::span<const Vector3d> points,
                                                 std::string_view name) {
  const Extent extent = CheckedExtent(points, name);
  const Lattice lattice(extent.centre, extent.size);
  const std::vector<Node> nodes = Weld(points, lattice);
  std::vector<Vector3d> welded;
  welded.reserve(nodes.size());
  for (const Node& node : nodes) welded.push_back(points[node.index]);
  Quickhull quickhull(nodes);
  quickhull.Run(StartCorners(welded, extent.size, name));

  auto hull = std::make_shared<ConvexHull>();
  hull->name = name;
  CopySurface(quickhull.hull(), welded, hull.get());
  Measure(extent.centre, hull.get());
  FillColumns(hull.get());
  if (hull->vertices.size() <= kFewVertices) {
    FillPlanesThatTouch(hull.get());
  } else {
    FillPlanesOfLattice(quickhull.hull(), lattice.step(), hull.get());
  }
  return hull;
}

}  // namespace oca::geometry
