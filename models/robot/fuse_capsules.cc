// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/fuse_capsules.h"

#include <cmath>

namespace oca::robot {
namespace {

constexpr double kTolerance = 1e-9;

// Place of a sphere of that radius and centre (in the link's frame), or -1.
int FindSphere(const std::vector<CollisionElement>& elements, double radius,
               const Eigen::Vector3d& centre) {
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto* sphere = std::get_if<geometry::Sphere>(&elements[i].shape);
    if (sphere != nullptr && std::abs(sphere->radius - radius) <= kTolerance &&
        (elements[i].X_LC.translation() - centre).norm() <= kTolerance) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

}  // namespace

std::vector<CollisionElement> FuseCapsules(std::vector<CollisionElement> elements) {
  std::vector<geometry::Shape> shapes;
  for (const CollisionElement& element : elements) shapes.push_back(element.shape);
  std::vector<bool> swallowed(elements.size(), false);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const auto* cylinder = std::get_if<geometry::Cylinder>(&elements[i].shape);
    if (cylinder == nullptr) continue;
    const Eigen::Vector3d end(0.0, 0.0, 0.5 * cylinder->length);
    const int top = FindSphere(elements, cylinder->radius, elements[i].X_LC * end);
    const int bottom = FindSphere(elements, cylinder->radius, elements[i].X_LC * -end);
    if (top < 0 || bottom < 0) continue;
    shapes[i] = geometry::Capsule{cylinder->radius, cylinder->length};
    swallowed[top] = true;
    swallowed[bottom] = true;
  }
  std::vector<CollisionElement> fused;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (swallowed[i]) continue;
    elements[i].shape = shapes[i];
    fused.push_back(std::move(elements[i]));
  }
  return fused;
}

}  // namespace oca::robot
