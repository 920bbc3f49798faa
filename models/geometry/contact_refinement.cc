// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/contact_refinement.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace oca::geometry::internal {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Tangents = Eigen::Matrix<double, 3, 2>;

constexpr int kMostSteps = 20;
constexpr double kLongestStep = 0.1;        // rad
constexpr double kLastStep = 1e-9;          // rad; the next one is its square
constexpr double kSupportRounding = 2e-15;  // of a support, of the size of the pair
constexpr double kMostRest = 1e-11;  // the same, where a rim follows the last digit of a normal

class Contact {
 public:
  Contact(const CorePair& pair, const Vector3d& normal) : pair_(pair), n_(normal) {}

  void Add(const CorePair::Difference& point) {
    for (int k = 0; k < count_; ++k) {
      if (SameBranch(pair_.a, points_[k].a, point.a) &&
          SameBranch(pair_.b, points_[k].b, point.b)) {
        return;
      }
    }
    if (count_ < 3) points_[count_++] = point;
    weights_.fill(1.0 / count_);
  }
  bool Solve();
  const Vector3d& normal() const { return n_; }
  Vector3d PointA() const {
    return Sum([this](int k) { return points_[k].a; });
  }
  Vector3d PointB() const {
    return pair_.X_AB * Sum([this](int k) { return points_[k].b; });
  }

 private:
  template <class Of>
  Vector3d Sum(const Of& of) const {
    Vector3d sum = Vector3d::Zero();
    for (int k = 0; k < count_; ++k) sum += weights_[k] * of(k);
    return sum;
  }
  Matrix3d FollowNormal();
  Vector2d Step(const Tangents& tangents, const Matrix3d& curvature);
  bool DropNegative();
  bool AddExtreme();

  const CorePair& pair_;
  Vector3d n_;
  int count_{0};
  std::array<CorePair::Difference, 3> points_;
  std::array<double, 3> weights_{};
};

// All branches at the present normal; the mean of their curvatures.
Matrix3d Contact::FollowNormal() {
  const Matrix3d R_AB = pair_.X_AB.linear();
  const Vector3d to_b = R_AB.transpose() * n_;
  Matrix3d mean = Matrix3d::Zero();
  for (int k = 0; k < count_; ++k) {
    Matrix3d of_a, of_b;
    Follow(pair_.a, -n_, &points_[k].a, &of_a);
    Follow(pair_.b, to_b, &points_[k].b, &of_b);
    points_[k].w = points_[k].a - pair_.X_AB * points_[k].b;
    mean += weights_[k] * (of_a + R_AB * of_b * R_AB.transpose());
  }
  return mean;
}

// Solves  w_0 + sum mu_k e_k - M delta = 0  and  e_k . delta = -n . e_k,  e_k = w_k - w_0, in the
// tangent plane, with M = curvature + d.
Vector2d Contact::Step(const Tangents& tangents, const Matrix3d& curvature) {
  const Vector2d w = tangents.transpose() * points_[0].w;
  Matrix2d M = tangents.transpose() * curvature * tangents;
  M.diagonal().array() += n_.dot(points_[0].w);
  if (count_ == 1) return M.inverse() * w;
  const auto edge = [this](int k) -> Vector3d { return points_[k].w - points_[0].w; };
  Vector2d delta, mu = Vector2d::Zero();
  if (count_ == 2) {
    const Vector2d e = tangents.transpose() * edge(1);
    const double length = e.norm();
    const Vector2d along = e / length, across(-along.y(), along.x());
    delta = -n_.dot(edge(1)) / length * along;
    delta += across.dot(w - M * delta) / across.dot(M * across) * across;
    mu[0] = along.dot(M * delta - w) / length;
  } else {
    Matrix2d E;
    E << tangents.transpose() * edge(1), tangents.transpose() * edge(2);
    delta = -E.transpose().inverse() * Vector2d(n_.dot(edge(1)), n_.dot(edge(2)));
    mu = E.inverse() * (M * delta - w);
  }
  weights_ = {1.0 - mu.sum(), mu[0], mu[1]};
  return delta;
}

// The nearest point is not between the branches: one of them goes.
bool Contact::DropNegative() {
  int worst = 0;
  for (int k = 1; k < count_; ++k) {
    if (weights_[k] < weights_[worst]) worst = k;
  }
  if (count_ == 1 || weights_[worst] >= 0.0) return false;
  points_[worst] = points_[--count_];
  weights_.fill(1.0 / count_);
  return true;
}

// A branch that the plane across the normal cuts off was missing.
bool Contact::AddExtreme() {
  const CorePair::Difference extreme = pair_.Support(-n_);
  double lowest = n_.dot(points_[0].w);
  int lightest = 0;
  for (int k = 1; k < count_; ++k) {
    lowest = std::min(lowest, n_.dot(points_[k].w));
    if (weights_[k] < weights_[lightest]) lightest = k;
  }
  if (n_.dot(extreme.w) >= lowest - kSupportRounding * pair_.Extent()) return false;
  if (count_ == 3) points_[lightest] = points_[--count_];
  Add(extreme);
  return true;
}

bool Contact::Solve() {
  weights_.fill(1.0 / count_);
  bool last = false, dropped = false;
  for (int step = 0; step < kMostSteps; ++step) {
    Matrix3d curvature = FollowNormal();
    if (!dropped) {
      if (AddExtreme()) {
        last = false;
        curvature = FollowNormal();
      } else if (last) {
        return true;
      }
    }
    Tangents tangents;
    tangents.col(0) = n_.unitOrthogonal();
    tangents.col(1) = n_.cross(tangents.col(0));
    const Vector2d delta = Step(tangents, curvature);
    dropped = DropNegative();
    if (dropped) continue;
    const double length = delta.norm();
    if (!std::isfinite(length)) return false;
    n_ = (n_ + tangents * delta * std::min(1.0, kLongestStep / length)).normalized();
    last = length <= kLastStep;
  }
  return false;
}

// The flat end of a cylinder or cone, A or B, faces the other core: the normal is that of the end.
// (A and B may be the same collider.)
bool FlatEnd(const CorePair& pair, bool of_a, double lower, CoreDistance* found) {
  const Collider& core = of_a ? pair.a : pair.b;
  const Vector3d axis = of_a ? Vector3d(Vector3d::UnitZ()) : Vector3d(pair.X_AB.linear().col(2));
  constexpr double kNearly = 0.01;
  const bool ends =
      core.core() == Collider::Core::kCylinder || core.core() == Collider::Core::kCone;
  if (!ends || found->normal.cross(axis).squaredNorm() > kNearly * kNearly) return false;
  const Vector3d n = found->normal.dot(axis) > 0.0 ? axis : Vector3d(-axis);
  // Of a cone the end is below.
  if (core.core() == Collider::Core::kCone && (n.dot(axis) > 0.0) != of_a) return false;
  const CorePair::Difference support = pair.Support(-n);
  const double reach = n.dot(support.w);
  if (reach < lower - kSupportRounding * pair.Extent()) return false;
  // The other core's point is the nearest one; what is below it on the end must be on the end.
  const Vector3d extreme = of_a ? Vector3d(pair.X_AB * support.b) : support.a;
  Vector3d other = of_a ? found->point_b : found->point_a;
  const double height = (extreme - other).dot(n);
  if (std::abs(height) > kSupportRounding * pair.Extent()) other = extreme;
  const Vector3d below = of_a ? Vector3d(other + reach * n) : Vector3d(other - reach * n);
  const Vector3d centre = of_a ? Vector3d(Vector3d::Zero()) : Vector3d(pair.X_AB.translation());
  if ((below - centre).cross(axis).norm() > core.half().x()) return false;
  found->distance = reach;
  found->normal = n;
  found->point_a = of_a ? below : other;
  found->point_b = of_a ? other : below;
  return true;
}

}  // namespace

bool RefineContact(const CorePair& pair, std::span<const CorePair::Difference> points,
                   CoreDistance* found) {
  const double lower = found->distance - (found->distance > 0.0 ? found->gap : 0.0);
  CoreDistance better = *found;
  const double rounding = kSupportRounding * pair.Extent();
  double rest_left = 0.0;
  if (!FlatEnd(pair, true, lower, &better) && !FlatEnd(pair, false, lower, &better)) {
    Contact contact(pair, found->normal);
    for (const CorePair::Difference& point : points) contact.Add(point);
    if (!contact.Solve()) return false;
    better.normal = contact.normal();
    better.distance = better.normal.dot(pair.Support(-better.normal).w);
    better.point_a = contact.PointA();
    better.point_b = contact.PointB();
    const Vector3d rest = better.point_a - better.point_b - better.distance * better.normal;
    rest_left = rest.norm();
    if (!(rest_left <= kMostRest * pair.Extent())) return false;
  }
  if (!(better.distance >= lower - rounding)) return false;
  better.gap = found->distance > 0.0 ? rest_left + rounding
                                     : std::max(found->gap - (better.distance - lower), 0.0);
  *found = better;
  return true;
}

}  // namespace oca::geometry::internal
