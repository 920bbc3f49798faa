// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/collider.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/geometry/ball_tree.h"
#include "oca/models/geometry/core_forms.h"

namespace oca::geometry {
namespace {

using Eigen::Vector3d;

template <class... Cases>
struct Visitor : Cases... {
  using Cases::operator()...;
};

template <class... Cases>
Visitor(Cases...) -> Visitor<Cases...>;

double CheckedSize(double value, std::string_view where, std::string_view what) {
  if (!(std::isfinite(value) && value > 0.0)) {
    throw models::ModelError(
        fmt::format("{}: {}; got {}; expected a finite length above 0 m", where, what, value));
  }
  return value;
}

// Beyond it doubles no longer tell 1e-10 m apart.
constexpr double kFarthest = 1e6;  // m

// Relative thickness below which the volume of a body drowns in rounding.
constexpr double kFlattest = 1e-9;

// From so many parts on a tree finds the nearest one sooner than a look at each.
constexpr std::size_t kManyParts = 16;

void CheckThickness(const Vector3d& half, std::string_view where) {
  if (half.minCoeff() >= kFlattest * half.maxCoeff()) return;
  throw models::ModelError(
      fmt::format("{}: body too flat; got {} m by {} m; expected a ratio above {}", where,
                  2 * half.minCoeff(), 2 * half.maxCoeff(), kFlattest));
}

bool IsRigid(const Eigen::Isometry3d& X) {
  const Eigen::Matrix3d R = X.linear();
  const double skew = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return X.translation().allFinite() && skew <= 1e-9 && R.determinant() > 0.0;
}

}  // namespace

Collider::Collider(Shape shape, std::string_view where) : shape_(std::move(shape)) {
  const auto size = [&](double value, std::string_view what) {
    return CheckedSize(value, where, what);
  };
  std::visit(Visitor{[&](const Sphere& s) {
                       core_ = Core::kPoint;
                       radius_ = size(s.radius, "sphere radius");
                       bounding_radius_ = radius_;
                     },
                     [&](const Box& s) {
                       core_ = Core::kBox;
                       half_ = 0.5 * Vector3d(size(s.size.x(), "box size x"),
                                              size(s.size.y(), "box size y"),
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
                     [&](const Cone& s) {
                       core_ = Core::kCone;
                       const double r = size(s.radius, "cone radius");
                       half_ = Vector3d(r, r, 0.5 * size(s.length, "cone length"));
                       CheckThickness(half_, where);
                       bounding_radius_ = std::hypot(r, half_.z());
                     },
                     [&](const Ellipsoid& s) {
                       core_ = Core::kEllipsoid;
                       half_ = {size(s.radii.x(), "ellipsoid radius x"),
                                size(s.radii.y(), "ellipsoid radius y"),
                                size(s.radii.z(), "ellipsoid radius z")};
                       CheckThickness(half_, where);
                       bounding_radius_ = half_.maxCoeff();
                     },
                     [&](const HalfSpace&) {
                       core_ = Core::kHalfSpace;
                       bounding_radius_ = std::numeric_limits<double>::infinity();
                     },
                     [&](const auto& s) { Prepare(s, where); }},
             shape_);
  const double reach = centre_.norm() + bounding_radius_;
  if (core_ != Core::kHalfSpace && !(reach <= kFarthest)) {
    throw models::ModelError(
        fmt::format("{}: size; got points up to {:g} m from the origin; expected at most {:g} m",
                    where, reach, kFarthest));
  }
}

void Collider::Prepare(const ConvexMesh& mesh, std::string_view where) {
  if (!mesh.hull) {
    throw models::ModelError(
        fmt::format("{}: convex mesh; got no hull; expected one of MakeConvexHull", where));
  }
  core_ = Core::kHull;
  hull_ = mesh.hull.get();
  centre_ = hull_->centre;
  bounding_radius_ = hull_->radius;
}

void Collider::Prepare(const Compound& compound, std::string_view where) {
  core_ = Core::kCompound;
  if (compound.parts.empty()) {
    throw models::ModelError(
        fmt::format("{}: compound; got no parts; expected at least one", where));
  }
  Eigen::AlignedBox3d box;
  parts_.reserve(compound.parts.size());
  for (std::size_t i = 0; i < compound.parts.size(); ++i) {
    const CompoundPart& part = compound.parts[i];
    const auto name = [&] { return fmt::format("{}: part {}", where, i); };
    if (std::holds_alternative<Compound>(part.shape) ||
        std::holds_alternative<HalfSpace>(part.shape)) {
      throw models::ModelError(fmt::format(
          "{}; got a {}; expected a convex body that ends", name(),
          part.shape.index() == Shape(HalfSpace{}).index() ? "half-space" : "compound"));
    }
    if (!IsRigid(part.X_SP)) {
      throw models::ModelError(fmt::format(
          "{}: pose; got a NaN, an infinity or no rotation; expected a finite rigid motion",
          name()));
    }
    parts_.push_back({part.X_SP, SameAsLast(part.shape) ? parts_.back().collider
                                                        : MakeCollider(part.shape, name())});
    const Collider& collider = *parts_.back().collider;
    const Vector3d centre = part.X_SP * collider.centre();
    const Vector3d reach = Vector3d::Constant(collider.bounding_radius());
    box.extend(centre - reach).extend(centre + reach);
  }
  centre_ = box.center();
  for (const Part& part : parts_) {
    const double offset = (part.X_SP * part.collider->centre() - centre_).norm();
    bounding_radius_ = std::max(bounding_radius_, offset + part.collider->bounding_radius());
  }
  if (parts_.size() < kManyParts) return;
  std::vector<Ball> balls;
  balls.reserve(parts_.size());
  for (const Part& part : parts_) {
    balls.push_back({part.X_SP * part.collider->centre(), part.collider->bounding_radius()});
  }
  auto tree = std::make_shared<BallTree>();
  tree->Build(balls);
  part_balls_ = std::move(tree);
}

// The points of a cloud are thousands of equal spheres, an octree's leaves equal boxes.
bool Collider::SameAsLast(const Shape& shape) const {
  if (parts_.empty()) return false;
  const Shape& last = parts_.back().collider->shape();
  if (shape.index() != last.index()) return false;
  if (const auto* sphere = std::get_if<Sphere>(&shape)) {
    return std::get<Sphere>(last).radius == sphere->radius;
  }
  const auto* box = std::get_if<Box>(&shape);
  return box != nullptr && std::get<Box>(last).size == box->size;
}

Vector3d Collider::Support(const Vector3d& direction) const {
  if (core_ == Core::kHalfSpace) {
    return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  }
  if (core_ != Core::kCompound) return internal::CoreSupport(*this, direction);
  Vector3d farthest = Vector3d::Zero();
  double most = -std::numeric_limits<double>::infinity();
  for (const Part& part : parts_) {
    const Vector3d local = part.X_SP.linear().transpose() * direction;
    const double radius = part.collider->radius();
    Vector3d p = part.collider->Support(local);
    if (radius > 0.0 && !local.isZero(0.0)) p += radius * local.stableNormalized();
    p = part.X_SP * p;
    if (direction.dot(p) > most) most = direction.dot(p), farthest = p;
  }
  return farthest;
}

std::shared_ptr<const Collider> MakeCollider(Shape shape, std::string_view where) {
  return std::make_shared<const Collider>(std::move(shape), where);
}

}  // namespace oca::geometry
