// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/flat_points.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;

double ExtentOf(const std::vector<Vector3d>& points) {
  Vector3d low = points.front(), high = low;
  for (const Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).maxCoeff();
}

}  // namespace

double PadFlat(std::vector<Vector3d>& points, double flattest) {
  if (points.empty()) return 0.0;
  const double extent = ExtentOf(points);
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) spread += (p - mean) * (p - mean).transpose();
  const Eigen::Matrix3d axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors();
  double thickness = 0.0;
  for (int i = 0; i < 2; ++i) {  // along the two thinnest: a line is flat in both
    const Vector3d axis = axes.col(i);
    double low = 0.0, high = 0.0;
    for (const Vector3d& p : points) {
      low = std::min(low, axis.dot(p - mean));
      high = std::max(high, axis.dot(p - mean));
    }
    if (!(high - low < flattest * extent)) break;
    thickness = kThinnest * extent;
    const Vector3d pad = 0.5 * thickness * axis;
    for (std::size_t k = 0, n = points.size(); k < n; ++k) {
      points.push_back(points[k] + pad);
      points[k] -= pad;
    }
  }
  return thickness;
}

}  // namespace oca::geometry::internal
