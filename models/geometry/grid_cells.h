// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <cstddef>
#include <vector>

namespace oca::geometry::internal {

/// The axis-aligned box around points, of which there is at least one.
struct Extent {
  explicit Extent(const std::vector<Eigen::Vector3d>& points);
  Eigen::Vector3d low, high;
};

/// A point, by its index, and the cell of a grid that it lies in.
struct InCell {
  std::array<long, 3> cell;
  std::size_t index;
  auto operator<=>(const InCell&) const = default;
};

/// Points in the order of their cells, those of one cell in their own order. Cells are `size` m
/// wide; std::floor as `whole` has one begin at `origin`, std::round has one there in the middle.
std::vector<InCell> SortedByCell(const std::vector<Eigen::Vector3d>& points,
                                 const Eigen::Vector3d& origin, double size,
                                 double (*whole)(double));

}  // namespace oca::geometry::internal
