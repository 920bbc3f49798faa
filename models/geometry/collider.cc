// SPDX-License-Identifier: BSD-3-Clause
#include "models/geometry/collider.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>

#include "models/error.h"
#include "models/geometry/hull_support.h"

namespace oca::models {
namespace {

using Eigen::Vector3d;

template <class... Cases>
struct Visitor : Cases... {
  using Cases::operator()...;
};

double CheckedSize(double value, std::string_view where, std::string_view what) {
  if (!(std::isfinite(value) && value > 0.0)) {
    throw ModelError(
        fmt::format("{}: {}; got {}; expected a finite length above 0 m", where, what, value));
  }
  return value;
}

// Relative thickness below which the volume of a body drowns in rounding.
constexpr double kFlattest = 1e-9;

void CheckThickness(const Vector3d& half, std::string_view where) {
  if (half.minCoeff() >= kFlattest * half.maxCoeff()) return;
  throw ModelError(fmt::format("{}: body too flat; got {} m by {} m; expected a ratio above {}",
                               where, 2 * half.minCoeff(), 2 * half.maxCoeff(), kFlattest));
}

}  // namespace

Collider::Collider(const Shape& shape, std::string_view where) : shape_(shape) {
  const auto size = [&](double value, std::string_view what) {
    return CheckedSize(value, where, what);
  };
  std::visit(
      Visitor{[&](const Sphere& s) {
                core_ = Core::kPoint;
                radius_ = size(s.radius, "sphere radius");
                bounding_radius_ = radius_;
              },
              [&](const Box& s) {
                core_ = Core::kBox;
                half_ =
                    0.5 * Vector3d(size(s.size.x(), "box size x"), size(s.size.y(), "box size y"),
                                   size(s.size.z(), "box size z"));
                CheckThickness(half_, where);
                bounding_radius_ = half_.norm();
              },
              [&](const Cylinder& s) {
                core_ = Core::kCylinder;
                const double r = size(s.radius, "cylinder radius");
                half_ = Vector3d(r, r, 0.5 * size(s.length, "cylinder length"));
                CheckThickness(half_, where);
                bounding_radius_ = std::hypot(r, half_.z());
              },
              [&](const Capsule& s) {
                core_ = Core::kSegment;
                radius_ = size(s.radius, "capsule radius");
                half_.z() = 0.5 * size(s.length, "capsule length");
                bounding_radius_ = half_.z() + radius_;
              },
              [&](const ConvexMesh& s) {
                if (!s.hull) {
                  throw ModelError(fmt::format(
                      "{}: convex mesh; got no hull; expected one of MakeConvexHull", where));
                }
                core_ = Core::kHull;
                hull_ = s.hull.get();
                centre_ = hull_->centre;
                bounding_radius_ = hull_->radius;
              }},
      shape_);
}

Vector3d Collider::Support(const Vector3d& direction) const {
  switch (core_) {
    case Core::kPoint:
      return Vector3d::Zero();
    case Core::kSegment:
      return {0.0, 0.0, std::copysign(half_.z(), direction.z())};
    case Core::kBox:
      return {std::copysign(half_.x(), direction.x()), std::copysign(half_.y(), direction.y()),
              std::copysign(half_.z(), direction.z())};
    case Core::kCylinder: {
      const double across = std::hypot(direction.x(), direction.y());
      const double scale = across > 0.0 ? half_.x() / across : 0.0;
      return {direction.x() * scale, direction.y() * scale,
              std::copysign(half_.z(), direction.z())};
    }
    case Core::kHull:
      break;
  }
  return hull_->vertices[internal::FarthestVertex(*hull_, direction)];
}

std::shared_ptr<const Collider> MakeCollider(const Shape& shape, std::string_view where) {
  return std::make_shared<const Collider>(shape, where);
}

double BoundingRadius(const Collider& collider) {
  return collider.centre().norm() + collider.bounding_radius();
}

}  // namespace oca::models
