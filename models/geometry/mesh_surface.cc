// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/mesh_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "oca/models/file_cache.h"
#include "oca/models/geometry/flat_points.h"
#include "oca/models/geometry/grid_cells.h"

namespace oca::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kWeld = 1e-6;       // of the extent
constexpr double kTolerated = 0.01;  // of the mesh: what a hull may add without a word
constexpr double kPlane = 1e-6;      // thickness of what counts as a plane, of the extent

bool IsClosed(const TriangleMesh& mesh) {
  struct Pass {
    int low, high, direction;
  };
  std::vector<Pass> passes;
  passes.reserve(3 * mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
      passes.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
    }
  }
  std::sort(passes.begin(), passes.end(), [](const Pass& a, const Pass& b) {
    return std::pair(a.low, a.high) < std::pair(b.low, b.high);
  });
  int balance = 0;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    balance += passes[i].direction;
    const bool last = i + 1 == passes.size() || passes[i + 1].low != passes[i].low ||
                      passes[i + 1].high != passes[i].high;
    if (last && balance != 0) return false;
  }
  return true;
}

// For each point the first one that lies in the same cell.
std::vector<std::size_t> FirstInCell(const std::vector<Vector3d>& points) {
  const internal::Extent extent(points);
  const double cell = kWeld * std::max((extent.high - extent.low).maxCoeff(), 1e-300);
  const auto sorted = internal::SortedByCell(points, extent.low, cell, std::round);
  std::vector<std::size_t> first(points.size());
  std::size_t group = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (sorted[i].cell != sorted[group].cell) group = i;
    first[sorted[i].index] = sorted[group].index;
  }
  return first;
}

}  // namespace

TriangleMesh WeldVertices(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return mesh;
  const std::vector<std::size_t> first = FirstInCell(mesh.vertices);
  std::vector<int> welded(first.size());
  TriangleMesh result;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i] == i) {
      welded[i] = static_cast<int>(result.vertices.size());
      result.vertices.push_back(mesh.vertices[i]);
    } else {
      welded[i] = welded[first[i]];
    }
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<int, 3> triangle{welded[static_cast<std::size_t>(a)],
                                      welded[static_cast<std::size_t>(b)],
                                      welded[static_cast<std::size_t>(c)]};
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
      continue;
    }
    result.triangles.push_back(triangle);
  }
  return result;
}

std::optional<double> EnclosedVolume(const TriangleMesh& mesh) {
  const TriangleMesh welded = WeldVertices(mesh);
  if (welded.triangles.empty() || !IsClosed(welded)) return std::nullopt;
  const Vector3d& origin = welded.vertices.front();
  double volume = 0.0;
  for (const auto& [a, b, c] : welded.triangles) {
    const Vector3d A = welded.vertices[static_cast<std::size_t>(a)] - origin;
    const Vector3d B = welded.vertices[static_cast<std::size_t>(b)] - origin;
    const Vector3d C = welded.vertices[static_cast<std::size_t>(c)] - origin;
    volume += A.dot(B.cross(C)) / 6.0;
  }
  return std::abs(volume);  // a surface may be drawn inside out
}

std::string DescribeHullExcess(const TriangleMesh& mesh, const ConvexHull& hull) {
  const std::optional<double> volume = EnclosedVolume(mesh);
  if (!volume) {
    return "counts as its convex hull; how much that adds is not known, the surface is not closed";
  }
  const double added = hull.volume - *volume;
  if (!(added > kTolerated * *volume)) return "";
  return fmt::format("counts as its convex hull, which adds {:.3g} m^3 ({:.3g} %)", added,
                     100.0 * added / *volume);
}

MeshHull LoadMeshHull(const std::filesystem::path& file, const Eigen::Vector3d& scale) {
  const std::string form = fmt::format("{} {} {}", scale.x(), scale.y(), scale.z());
  return *models::ReadOnce<MeshHull>(file, form, [&]() -> MeshHull {
    const TriangleMesh mesh = LoadMesh(file, scale);
    std::vector<Vector3d> points = mesh.vertices;
    const double thickness = internal::PadFlat(points, kPlane);
    const auto hull = MakeConvexHull(points, file.string());
    if (thickness == 0.0) return {hull, DescribeHullExcess(mesh, *hull), ""};
    return {hull, "", fmt::format("is flat; counts as {:.3g} m thick", thickness)};
  });
}

}  // namespace oca::geometry
