// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/grid_cells.h"

#include <algorithm>
#include <cmath>

namespace oca::geometry::internal {

Extent::Extent(const std::vector<Eigen::Vector3d>& points)
    : low(points.front()), high(points.front()) {
  for (const Eigen::Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
}

std::vector<InCell> SortedByCell(const std::vector<Eigen::Vector3d>& points,
                                 const Eigen::Vector3d& origin, double size,
                                 double (*whole)(double)) {
  std::vector<InCell> sorted;
  sorted.reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d at = (p - origin) / size;
    sorted.push_back(
        {{std::lround(whole(at.x())), std::lround(whole(at.y())), std::lround(whole(at.z()))},
         sorted.size()});
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

}  // namespace oca::geometry::internal
