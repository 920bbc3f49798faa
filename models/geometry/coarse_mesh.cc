// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/coarse_mesh.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "oca/models/geometry/grid_cells.h"

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;
using Corners = std::array<int, 3>;

constexpr double kFinestCell = 1e-3;  // cell, of the diagonal
constexpr double kLeast = 1.2;        // by which cells grow

/// For each vertex the number of its cell, of those that hold any, in the order of the grid.
std::vector<int> CellsOf(const std::vector<Vector3d>& points, const Extent& extent, double cell) {
  const std::vector<InCell> sorted = SortedByCell(points, extent.low, cell, std::floor);
  std::vector<int> cells(points.size());
  int number = 0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (i > 0 && sorted[i].cell != sorted[i - 1].cell) ++number;
    cells[sorted[i].index] = number;
  }
  return cells;
}

/// A triangle between cells; two with the same corners in either sense are one.
struct Between {
  Corners sorted;
  int index;  // of the original
  auto operator<=>(const Between&) const = default;
};

bool Same(const Between& a, const Between& b) { return a.sorted == b.sorted; }

std::vector<Between> Spanning(const TriangleMesh& mesh, const std::vector<int>& cells) {
  std::vector<Between> between;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Corners t = mesh.triangles[i];
    for (int& corner : t) corner = cells[static_cast<std::size_t>(corner)];
    std::sort(t.begin(), t.end());
    if (t[0] != t[1] && t[1] != t[2]) between.push_back({t, static_cast<int>(i)});
  }
  std::sort(between.begin(), between.end());
  return between;
}

std::size_t CountDistinct(const std::vector<Between>& between) {
  std::size_t count = between.empty() ? 0 : 1;
  for (std::size_t i = 1; i < between.size(); ++i) {
    if (!Same(between[i - 1], between[i])) ++count;
  }
  return count;
}

std::vector<Vector3d> Means(const std::vector<Vector3d>& points, const std::vector<int>& cells) {
  const int count = 1 + *std::max_element(cells.begin(), cells.end());
  std::vector<Vector3d> means(static_cast<std::size_t>(count), Vector3d::Zero());
  std::vector<double> weights(means.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto cell = static_cast<std::size_t>(cells[i]);
    means[cell] += points[i];
    weights[cell] += 1.0;
  }
  for (std::size_t i = 0; i < means.size(); ++i) means[i] /= weights[i];
  return means;
}

/// For each cell a coarse triangle at it: one of its own, or of the nearest cell that has any.
std::vector<int> TriangleOfCells(const std::vector<Vector3d>& means, const TriangleMesh& coarse) {
  std::vector<int> own(means.size(), -1), used;
  for (std::size_t i = 0; i < coarse.triangles.size(); ++i) {
    for (const int corner : coarse.triangles[i]) {
      int& triangle = own[static_cast<std::size_t>(corner)];
      if (triangle < 0) used.push_back(corner);
      if (triangle < 0) triangle = static_cast<int>(i);
    }
  }
  std::vector<int> result = own;
  for (std::size_t i = 0; i < means.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; own[i] < 0 && k < used.size(); ++k) {
      const auto other = static_cast<std::size_t>(used[k]);
      const double distance = (means[other] - means[i]).squaredNorm();
      if (distance < nearest) nearest = distance, result[i] = own[other];
    }
  }
  return result;
}

}  // namespace

CoarseMesh Coarsen(const TriangleMesh& mesh, std::size_t most) {
  CoarseMesh result{mesh, std::vector<int>(mesh.triangles.size())};
  if (mesh.triangles.size() <= most) {
    std::iota(result.nearest.begin(), result.nearest.end(), 0);
    return result;
  }
  const Extent extent(mesh.vertices);
  const double diagonal = (extent.high - extent.low).norm();
  double cell = kFinestCell * std::max(diagonal, std::numeric_limits<double>::min());
  std::vector<int> cells = CellsOf(mesh.vertices, extent, cell);
  std::vector<Between> between = Spanning(mesh, cells);
  for (std::size_t count = CountDistinct(between); count > most; count = CountDistinct(between)) {
    // Triangles of a surface become fewer with the square of the edge.
    cell *=
        std::max(kLeast, 0.8 * std::sqrt(static_cast<double>(count) / static_cast<double>(most)));
    cells = CellsOf(mesh.vertices, extent, cell);
    between = Spanning(mesh, cells);
  }
  result.mesh = {Means(mesh.vertices, cells), {}};
  std::fill(result.nearest.begin(), result.nearest.end(), -1);
  for (std::size_t i = 0; i < between.size(); ++i) {
    if (i == 0 || !Same(between[i - 1], between[i])) {
      Corners corners = mesh.triangles[static_cast<std::size_t>(between[i].index)];
      for (int& corner : corners) corner = cells[static_cast<std::size_t>(corner)];
      result.mesh.triangles.push_back(corners);
    }
    result.nearest[static_cast<std::size_t>(between[i].index)] =
        static_cast<int>(result.mesh.triangles.size()) - 1;
  }
  const std::vector<int> of_cell = TriangleOfCells(result.mesh.vertices, result.mesh);
  for (std::size_t i = 0; i < result.nearest.size(); ++i) {
    int& nearest = result.nearest[i];
    const auto corner = static_cast<std::size_t>(mesh.triangles[i][0]);
    if (nearest < 0) nearest = std::max(0, of_cell[static_cast<std::size_t>(cells[corner])]);
  }
  return result;
}

}  // namespace oca::geometry::internal
