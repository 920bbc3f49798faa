// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/mesh_surface.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "oca/models/file_cache.h"

namespace oca::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kWeld = 1e-6;       // of the extent
constexpr double kTolerated = 0.01;  // of the mesh: what a hull may add without a word

bool IsClosed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> balance;
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
      balance[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return std::all_of(balance.begin(), balance.end(), [](const auto& e) { return e.second == 0; });
}

}  // namespace

TriangleMesh WeldVertices(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return mesh;
  Vector3d low = mesh.vertices.front(), high = low;
  for (const Vector3d& p : mesh.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double cell = kWeld * std::max((high - low).maxCoeff(), 1e-300);
  std::map<std::array<long, 3>, int> numbers;
  std::vector<int> welded;
  TriangleMesh result;
  for (const Vector3d& p : mesh.vertices) {
    const Vector3d at = (p - low) / cell;
    const std::array<long, 3> key{std::lround(at.x()), std::lround(at.y()), std::lround(at.z())};
    const auto [entry, fresh] = numbers.emplace(key, static_cast<int>(numbers.size()));
    if (fresh) result.vertices.push_back(p);
    welded.push_back(entry->second);
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
    const auto hull = MakeConvexHull(mesh.vertices, file.string());
    return {hull, DescribeHullExcess(mesh, *hull)};
  });
}

}  // namespace oca::geometry
