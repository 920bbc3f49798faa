// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/polygon.h"

#include <Eigen/Geometry>

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;

/// The place in `corners` of the first that bends inwards, 0 if there is none.
std::size_t InwardCorner(const std::vector<int>& corners, const TriangleMesh& mesh) {
  const std::size_t n = corners.size();
  const auto at = [&](std::size_t k) -> const Vector3d& { return mesh.vertices[corners[k % n]]; };
  Vector3d normal = Vector3d::Zero();  // of the whole, twice its area
  for (std::size_t k = 2; k < n; ++k) normal += (at(k - 1) - at(0)).cross(at(k) - at(0));
  for (std::size_t k = 0; k < n; ++k) {
    const Vector3d before = at(k) - at(k + n - 1), after = at(k + 1) - at(k);
    const double bend = before.cross(after).dot(normal);
    // Corners on a straight line are computed as bent by rounding.
    if (bend < -1e-9 * before.norm() * after.norm() * normal.norm()) return k;
  }
  return 0;
}

}  // namespace

void AddPolygon(const std::vector<int>& corners, TriangleMesh& mesh) {
  const std::size_t n = corners.size();
  const std::size_t first = n > 3 ? InwardCorner(corners, mesh) : 0;
  for (std::size_t k = 2; k < n; ++k) {
    mesh.triangles.push_back(
        {corners[first], corners[(first + k - 1) % n], corners[(first + k) % n]});
  }
}

}  // namespace oca::geometry::internal
