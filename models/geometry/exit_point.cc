// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/exit_point.h"

#include "oca/models/geometry/contact_refinement.h"

namespace oca::geometry::internal {

using Eigen::Vector3d;

Vector3d RayWeights(const Triangle& triangle, const Vector3d& ray) {
  const Vector3d &A = triangle[0]->w, &B = triangle[1]->w, &C = triangle[2]->w;
  const Vector3d areas(ray.dot(B.cross(C)), ray.dot(C.cross(A)), ray.dot(A.cross(B)));
  return areas.sum() > 0.0 ? Vector3d(areas / areas.sum()) : Vector3d(Vector3d::Constant(-1.0));
}

CoreDistance ExitPoint(const CorePair& pair, const Triangle& triangle, const Vector3d& normal,
                       double depth, double gap) {
  Vector3d weight = RayWeights(triangle, normal).cwiseMax(0.0);  // beside it at touch only
  if (!(weight.sum() > 0.0)) weight = Vector3d::Ones();
  weight /= weight.sum();
  CoreDistance result{.distance = -depth, .normal = -normal, .gap = gap};
  for (int i = 0; i < 3; ++i) result.point_a += weight[i] * triangle[i]->a;
  result.point_b = result.point_a - result.distance * result.normal;
  if (pair.IsRound()) {
    RefineContact(pair, std::array{*triangle[0], *triangle[1], *triangle[2]}, &result);
  }
  return result;
}

}  // namespace oca::geometry::internal
