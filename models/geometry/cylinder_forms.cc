// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/cylinder_forms.h"

#include <algorithm>
#include <cmath>

#include "oca/models/geometry/gjk.h"

namespace oca::geometry::internal {
namespace {

using Eigen::Vector3d;

// The segment seen in the half-plane of a point's distance from the axis, whose square is
// A s^2 + 2 B s + C, and its height.
class Profile {
 public:
  Profile(const Vector3d& half, const Segment& segment)
      : radius_(half.x()),
        half_(half.z()),
        centre_(segment.centre),
        direction_(segment.direction),
        A_(segment.direction.head<2>().squaredNorm()),
        B_(segment.direction.head<2>().dot(segment.centre.head<2>())),
        C_(segment.centre.head<2>().squaredNorm()),
        low_(-segment.half),
        high_(segment.half) {}

  // The parameter of the segment's point that is nearest to the cylinder.
  double Nearest();

 private:
  // Half the derivative of the squared distance, never falling; and of that.
  struct Slope {
    double value, change;
  };
  Slope SlopeAt(double s) const;
  void CutAt(double s);
  void CutAtSide();
  double RootBetween() const;

  double radius_, half_;
  Vector3d centre_, direction_;
  double A_, B_, C_;
  double low_, high_;                       // the least lies between
  double flat_low_{0.0}, flat_high_{-1.0};  // or anywhere here, where the slope is zero
};

Profile::Slope Profile::SlopeAt(double s) const {
  const Vector3d p = centre_ + s * direction_;
  const double rise = direction_.z();
  const double over = p.z() - std::clamp(p.z(), -half_, half_);
  Slope slope{over * rise, over != 0.0 ? rise * rise : 0.0};
  const double across = std::sqrt(p.x() * p.x() + p.y() * p.y());
  if (across > radius_) {
    const double rate = (p.x() * direction_.x() + p.y() * direction_.y()) / across;
    const double beside = across - radius_;
    slope.value += beside * rate;
    slope.change += rate * rate + beside * std::max(A_ - rate * rate, 0.0) / across;
  }
  return slope;
}

void Profile::CutAt(double s) {
  if (!(s > low_ && s < high_)) return;
  const double slope = SlopeAt(s).value;
  if (slope < 0.0) {
    low_ = s;
  } else if (slope > 0.0) {
    high_ = s;
  } else if (flat_high_ < flat_low_) {
    flat_low_ = flat_high_ = s;
  } else {
    flat_low_ = std::min(flat_low_, s), flat_high_ = std::max(flat_high_, s);
  }
}

void Profile::CutAtSide() {
  const double inside = B_ * B_ - A_ * (C_ - radius_ * radius_);
  if (!(inside > 0.0) || A_ == 0.0) return;
  const double sum = -(B_ + std::copysign(std::sqrt(inside), B_));  // no digits cancel
  CutAt(sum / A_);
  if (sum != 0.0) CutAt((C_ - radius_ * radius_) / sum);
}

// No face is crossed between low and high: the slope is smooth there.
double Profile::RootBetween() const {
  constexpr int kMostTurns = 60;
  double low = low_, high = high_;
  double s = 0.5 * (low + high);
  for (int step = 0; step < kMostTurns; ++step) {
    const Slope slope = SlopeAt(s);
    if (slope.value == 0.0) return s;
    (slope.value < 0.0 ? low : high) = s;
    double next = s - slope.value / slope.change;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - s) <= 1e-16 * (high_ - low_) || next == low || next == high) return next;
    s = next;
  }
  return s;
}

double Profile::Nearest() {
  if (SlopeAt(low_).value >= 0.0) return low_;
  if (SlopeAt(high_).value <= 0.0) return high_;
  if (direction_.z() != 0.0) {
    CutAt((-half_ - centre_.z()) / direction_.z());
    CutAt((half_ - centre_.z()) / direction_.z());
  }
  CutAtSide();
  if (flat_low_ <= flat_high_) return 0.5 * (flat_low_ + flat_high_);
  const double middle = 0.5 * (low_ + high_);
  const bool beside = std::abs(centre_.z() + direction_.z() * middle) <= half_;
  if (beside && A_ > 0.0) return std::clamp(-B_ / A_, low_, high_);
  return RootBetween();
}

}  // namespace

bool CylinderToSegment(const Vector3d& half, const Segment& segment, CoreDistance* found) {
  const Vector3d p = segment.At(Profile(half, segment).Nearest());
  const double across = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const double scale = across > half.x() ? half.x() / across : 1.0;
  const Vector3d nearest(scale * p.x(), scale * p.y(), std::clamp(p.z(), -half.z(), half.z()));
  const Vector3d gap = p - nearest;
  const double distance = gap.norm();
  if (!(distance > kTouch * (half.x() + half.z() + segment.half))) return false;
  *found = {.distance = distance, .point_a = nearest, .point_b = p, .normal = -gap / distance};
  return true;
}

}  // namespace oca::geometry::internal
