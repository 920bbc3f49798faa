// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/clearance.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oca/models/geometry/ball_cover.h"
#include "oca/models/geometry/obstacle.h"
#include "oca/models/robot/kinematics.h"

namespace oca::robot {
namespace {

// More balls keep closer to a solid and take longer.
constexpr int kMostBalls = 8;          // a solid
constexpr double kCoverSlack = 0.004;  // m

NearPair PairOf(const geometry::SignedDistance& found, int link, int body, int other_link) {
  return {found.distance, link, body, other_link, found.point_a, found.point_b, found.normal};
}

}  // namespace

Clearance::Clearance(std::shared_ptr<const RobotModel> model, bool self_collision,
                     std::vector<PlacedBody> bodies)
    : model_(std::move(model)),
      self_collision_(self_collision),
      links_(LinkCollidersOf(*model_)),
      places_(static_cast<std::size_t>(model_->num_links()), -1),
      bodies_(std::move(bodies)),
      X_WL_(static_cast<std::size_t>(model_->num_links()), Eigen::Isometry3d::Identity()) {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    places_[static_cast<std::size_t>(links_[i].number)] = static_cast<int>(i);
  }
  for (int i = 0; self_collision && i < std::ssize(links_); ++i) {
    for (int j = i + 1; j < std::ssize(links_); ++j) {
      const int a = links_[i].number;
      const int b = links_[j].number;
      if (model_->body(a) == model_->body(b) || model_->adjacent(a, b) ||
          model_->collision_disabled(a, b)) {
        continue;
      }
      own_pairs_.emplace_back(a, b);
      own_places_.emplace_back(i, j);
    }
  }
  own_scales_.assign(own_pairs_.size(), 1.0);
}

void Clearance::IgnoreOwn(int link, int other) {
  for (std::size_t i = own_pairs_.size(); i-- > 0;) {
    const auto& [a, b] = own_pairs_[i];
    if (!(a == link && b == other) && !(a == other && b == link)) continue;
    const auto at = static_cast<std::ptrdiff_t>(i);
    own_pairs_.erase(own_pairs_.begin() + at);
    own_places_.erase(own_places_.begin() + at);
    own_scales_.erase(own_scales_.begin() + at);
  }
  ++version_;
}

void Clearance::KeepOwn(const OwnRanges& ranges, double reference) {
  for (std::size_t i = 0; i < own_pairs_.size(); ++i) {
    own_scales_[i] =
        std::max(reference / ranges.of(own_pairs_[i].first, own_pairs_[i].second), 1.0);
  }
  ++version_;
}

const LinkCovers& Clearance::covers() {
  if (covers_ != nullptr) return *covers_;
  LinkCovers covers;
  for (const LinkCollider& link : links_) {
    auto& balls = covers.emplace_back();
    for (const LinkCollider::Element& element : link.elements) {
      for (const geometry::Ball& ball :
           geometry::CoverWithBalls(*element.collider, kMostBalls, kCoverSlack)) {
        balls.push_back({{element.X_LC * ball.centre, ball.radius},
                         geometry::InnerRadius(*element.collider, ball.centre)});
      }
    }
  }
  covers_ = std::make_shared<const LinkCovers>(std::move(covers));
  return *covers_;
}

void Clearance::MoveTo(const Eigen::Ref<const Eigen::VectorXd>& q) {
  ForwardKinematics(*model_, q, X_WL_);
}

bool Clearance::Ignored(int link, int body) const {
  return !ignored_.empty() &&
         std::find(ignored_.begin(), ignored_.end(), std::pair(link, body)) != ignored_.end();
}

geometry::SignedDistance Clearance::BodyDistance(const LinkCollider& link, const PlacedBody& body,
                                                 double max_distance) const {
  const Eigen::Isometry3d& X_WL = X_WL_[link.number];
  const double variance = body.covariance.trace();
  if (!(variance > 0.0)) {
    return DistanceToBody(link, X_WL, *body.collider, body.X_WO, max_distance);
  }
  const double most = geometry::kConfidence * std::sqrt(variance);
  geometry::SignedDistance found =
      DistanceToBody(link, X_WL, *body.collider, body.X_WO, max_distance + most);
  if (found.status == geometry::DistanceStatus::kBeyond) return found;
  const double nearer = geometry::Uncertainty(body.covariance, found.normal);
  found.distance -= nearer;
  found.point_b += nearer * found.normal;
  if (found.distance > max_distance) found.status = geometry::DistanceStatus::kBeyond;
  return found;
}

bool Clearance::LookAt(const LinkCollider& link, int body, double max_distance,
                       NearPair& pair) const {
  const geometry::SignedDistance found =
      BodyDistance(link, bodies_[static_cast<std::size_t>(body)], max_distance);
  if (found.status == geometry::DistanceStatus::kBeyond) return false;
  pair = PairOf(found, link.number, body, -1);
  return true;
}

bool Clearance::LookAtOwn(std::size_t own_pair, double max_distance, NearPair& pair) const {
  const double scale = own_scales_[own_pair];
  const geometry::SignedDistance found = OwnDistance(own_pair, max_distance / scale);
  if (found.status == geometry::DistanceStatus::kBeyond) return false;
  pair = PairOf(found, own_pairs_[own_pair].second, -1, own_pairs_[own_pair].first);
  pair.distance *= scale;
  pair.scale = scale;
  return true;
}

// Calls visit(pair) for each pair within the limit, which visit returns anew: below 0 ends the
// walk.
template <class Visit>
void Clearance::ForEach(double max_distance, const Visit& visit) const {
  double limit = max_distance;
  NearPair pair;
  for (const LinkCollider& link : links_) {
    if (model_->body(link.number) < 0) continue;
    for (int body = 0; body < std::ssize(bodies_); ++body) {
      if (Ignored(link.number, body) || !LookAt(link, body, limit, pair)) continue;
      limit = visit(pair);
      if (limit < 0.0) return;
    }
  }
  for (std::size_t i = 0; i < own_pairs_.size(); ++i) {
    if (!LookAtOwn(i, limit, pair)) continue;
    limit = visit(pair);
    if (limit < 0.0) return;
  }
}

geometry::SignedDistance Clearance::OwnDistance(std::size_t pair, double max_distance) const {
  const LinkCollider& other = links_[own_places_[pair].first];
  const LinkCollider& link = links_[own_places_[pair].second];
  return DistanceToLink(link, X_WL_[link.number], other, X_WL_[other.number], max_distance);
}

double Clearance::LinkDistance(int link, int body, double max_distance) const {
  const int place = places_[static_cast<std::size_t>(link)];
  const geometry::SignedDistance found =
      BodyDistance(links_[static_cast<std::size_t>(place)], bodies_[static_cast<std::size_t>(body)],
                   max_distance);
  return found.status == geometry::DistanceStatus::kBeyond ? kUnlimited : found.distance;
}

double Clearance::OwnPairDistance(std::size_t pair, double max_distance) const {
  const double scale = own_scales_[pair];
  const geometry::SignedDistance found = OwnDistance(pair, max_distance / scale);
  return found.status == geometry::DistanceStatus::kBeyond ? kUnlimited : scale * found.distance;
}

bool Clearance::NearerThan(double margin) const {
  bool nearer = false;
  ForEach(std::max(margin, 0.0), [&](const NearPair& pair) {
    nearer = pair.distance < margin || nearer;
    return nearer ? -1.0 : std::max(margin, 0.0);
  });
  return nearer;
}

NearPair Clearance::Nearest(double max_distance) const {
  NearPair nearest;
  ForEach(max_distance, [&](const NearPair& pair) {
    if (pair.distance < nearest.distance) nearest = pair;
    return std::clamp(nearest.distance, 0.0, max_distance);
  });
  return nearest;
}

void Clearance::Collect(double max_distance, std::vector<NearPair>& pairs) const {
  pairs.clear();
  ForEach(max_distance, [&](const NearPair& pair) {
    pairs.push_back(pair);
    return max_distance;
  });
}

void Clearance::Collect(double max_distance, std::span<const PairPlace> of,
                        std::vector<NearPair>& pairs) const {
  pairs.clear();
  NearPair pair;
  for (const PairPlace& place : of) {
    bool near = false;
    if (place.body < 0) {
      near = LookAtOwn(static_cast<std::size_t>(place.own_pair), max_distance, pair);
    } else {
      const int link = places_[static_cast<std::size_t>(place.link)];
      near = LookAt(links_[static_cast<std::size_t>(link)], place.body, max_distance, pair);
    }
    if (near) pairs.push_back(pair);
  }
}

void Clearance::LinkDistances(double max_distance, std::span<double> least) const {
  std::fill(least.begin(), least.end(), max_distance);
  LinkDistances(least);
}

void Clearance::LinkDistances(std::span<double> least) const {
  for (const LinkCollider& link : links_) {
    if (model_->body(link.number) < 0) continue;
    double& nearest = least[link.number];
    for (int b = 0; b < std::ssize(bodies_); ++b) {
      if (Ignored(link.number, b)) continue;
      const geometry::SignedDistance found = BodyDistance(link, bodies_[b], std::max(nearest, 0.0));
      if (found.status != geometry::DistanceStatus::kBeyond)
        nearest = std::min(nearest, found.distance);
    }
  }
}

void Clearance::OwnDistances(double max_distance, std::span<double> least) const {
  std::fill(least.begin(), least.end(), max_distance);
  OwnDistances(least);
}

void Clearance::OwnDistances(std::span<double> least) const {
  for (std::size_t i = 0; i < own_pairs_.size(); ++i) {
    const geometry::SignedDistance found = OwnDistance(i, least[i]);
    if (found.status != geometry::DistanceStatus::kBeyond) least[i] = found.distance;
  }
}

void Clearance::Gradient(const NearPair& pair, Eigen::Ref<Eigen::VectorXd> row) const {
  DistanceRow(*model_, X_WL_, pair.link, pair.point_on_link, pair.other_link, pair.point_on_other,
              pair.normal, row);
  row *= pair.scale;
}

}  // namespace oca::robot
