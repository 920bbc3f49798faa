// SPDX-License-Identifier: BSD-3-Clause
// What is near a band, what is asked of it, and whether it keeps that: BandOptimizer.
#include <algorithm>
#include <cmath>

#include "oca/models/planning/band_optimizer.h"

namespace oca::planning {
namespace {

constexpr double kExcessTolerance = 1e-3;  // that still counts as within the limits
constexpr double kExcessPrice = 0.05;      // m; an excess of 1 counts as so much missing distance
constexpr double kNearPause = 1.0;         // s
constexpr double kYieldRounding = 1e-6;    // m
constexpr double kSpeedSpan = 0.01;        // s; along which the speed of a body is taken
constexpr double kOutWithin = 1.0;         // s; a start nearer than hard_distance must be left

}  // namespace

void BandOptimizer::AskAhead(int count, double reach) {
  candidates_ = {};
  if (!something_near_) return;
  if (!batch_) batch_.emplace(clearance_, moving_);
  ++batches_;
  candidates_ = batch_->Near(ahead_, count, reach, balls_ahead_);
}

void BandOptimizer::Visit(const Sample& sample, int lane, double reach) {
  ++evaluations_;
  q_ = ahead_.col(lane);
  pairs_.clear();
  places_.clear();
  for (const BatchClearance::Candidate& candidate : candidates_) {
    if ((candidate.lanes >> lane & 1u) != 0) places_.push_back(candidate.pair);
  }
  if (places_.empty()) return;
  ++exact_looks_;
  clearance_.MoveTo(q_);
  for (const int b : moving_) {
    const auto body = static_cast<std::size_t>(b);
    clearance_.MoveBody(b, poses_[static_cast<std::size_t>(sample.first_pose) + body]);
    if (bodies_[body].covariance)
      clearance_.SetCovariance(b, bodies_[body].covariance(sample.time));
  }
  clearance_.Collect(reach, places_, pairs_);
}

void BandOptimizer::YieldAt(const Eigen::VectorXd& start, const Eigen::VectorXd* goal) {
  left_.clear();
  yield_start_ = start;
  AddLeft(start, checks_.front().time, false);
  if (goal == nullptr) return;
  yield_goal_ = *goal;
  AddLeft(*goal, checks_.back().time, true);
}

void BandOptimizer::AddLeft(const Eigen::VectorXd& q, double time, bool at_goal) {
  if (!something_near_) return;
  PlaceAt(q, time);
  clearance_.Collect(settings_.margin, pairs_);
  for (const robot::NearPair& pair : pairs_) {
    if (Flies(pair)) continue;
    left_.push_back(
        {pair.link, pair.body, pair.other_link, pair.distance - kYieldRounding, at_goal});
  }
}

bool BandOptimizer::IsOf(const Left& left, const robot::NearPair& pair) {
  return left.link == pair.link && left.body == pair.body && left.other_link == pair.other_link;
}

double BandOptimizer::LeftByGoal(const robot::NearPair& pair) const {
  double most = robot::kUnlimited;
  for (const Left& left : left_) {
    if (!left.at_goal || !IsOf(left, pair)) continue;
    most = std::min(most, left.distance + kYieldSlope * (q_ - yield_goal_).norm());
  }
  return most;
}

double BandOptimizer::LeftByEnds(const robot::NearPair& pair, double time) const {
  double most = LeftByGoal(pair);
  for (const Left& left : left_) {
    if (left.at_goal || !IsOf(left, pair)) continue;
    const double lacking = std::max(settings_.hard_distance * pair.scale - left.distance, 0.0);
    const double share = std::min((time - checks_.front().time) / kOutWithin, 1.0);
    most =
        std::min(most, left.distance + share * lacking + kYieldSlope * (q_ - yield_start_).norm());
  }
  return most;
}

double BandOptimizer::Reach() const {
  return std::max({settings_.clear_distance, settings_.trust_distance, settings_.flying_distance});
}

BandOptimizer::Lack BandOptimizer::LackAt(double nearest, double time, BandCheck& check) {
  Lack lack;
  if (!(nearest < Reach())) return lack;
  for (const robot::NearPair& pair : pairs_) {
    const double clear = settings_.clear_distance;
    if (Flies(pair)) {
      const double lacking = std::max(clear - pair.distance, 0.0);
      lack.wide = std::max(lack.wide, lacking);
      lack.hard = std::max(lack.hard, lacking);
      lack.contact = std::max(lack.contact, settings_.flying_distance - pair.distance);
      if (pair.distance < settings_.flying_distance) {
        check.touch_flying = std::min(check.touch_flying, time);
      }
      continue;
    }
    const double most = LeftByEnds(pair, time);
    const double wide = std::min(clear, most);
    const double hard = std::min({settings_.hard_distance * pair.scale, clear, most});
    if (pair.distance < wide) check.kept = std::min(check.kept, pair.distance / pair.scale);
    lack.wide = std::max(lack.wide, wide - pair.distance);
    lack.hard = std::max(lack.hard, hard - pair.distance);
    lack.contact = std::max(lack.contact, hard - pair.distance);
    if (pair.distance < std::min(settings_.trust_distance, most)) {
      check.touch_trust = std::min(check.touch_trust, time);
    }
    if (pair.distance < hard) check.touch_hard = std::min(check.touch_hard, time);
  }
  return lack;
}

BandCheck BandOptimizer::Check(const BandCurve& curve) {
  BandCheck check{.min_distance = settings_.margin, .distance = settings_.margin};
  if (!something_near_) return check;
  Eigen::VectorXd before;
  const double reach = std::max(settings_.margin, Reach());
  for (std::size_t i = 0; i < checks_.size(); ++i) {
    const Sample& sample = checks_[i];
    const int lane = static_cast<int>(i % BatchClearance::kLanes);
    if (lane == 0) {
      LookAhead(std::span(checks_).subspan(i), reach,
                [&](const Sample& at, Eigen::VectorXd& into) { curve.Evaluate(at.time, 0, into); });
    }
    Visit(sample, lane, reach);
    if (before.size() > 0) check.way += (q_ - before).cwiseAbs().sum();
    before = q_;
    robot::NearPair pair;
    for (const robot::NearPair& near : pairs_) {
      if (near.distance <= settings_.margin && near.distance < pair.distance) pair = near;
    }
    if (pair.distance < check.min_distance) {
      check.min_distance = pair.distance;
      check.distance = pair.distance / pair.scale;
      check.time = sample.time;
      check.own_links = pair.body < 0;
      check.link = model().links()[pair.link].name;
      check.body = pair.body >= 0 ? bodies_[pair.body].name : model().links()[pair.other_link].name;
    }
    const double wanted = pair.link < 0 || Flies(pair) ? settings_.margin : LeftByGoal(pair);
    if (pair.distance < std::min(settings_.margin, wanted)) {
      if (check.near.empty() || sample.time - check.near.back().second > kNearPause) {
        check.near.emplace_back(sample.time, sample.time);
      }
      check.near.back().second = sample.time;
    }
    const double excess = std::max(AddedExcess(sample, curve) - kExcessTolerance, 0.0);
    const Lack lack = LackAt(pair.distance, sample.time, check);
    if (excess > 0.0) check.touch_limits = std::min(check.touch_limits, sample.time);
    check.contact += sample.weight * (lack.contact + kExcessPrice * excess);
    check.breach += sample.weight * (lack.hard + kExcessPrice * excess);
    if (!(lack.wide > 0.0 || excess > 0.0)) continue;
    if (check.wide()) check.first = sample.time;
    check.last = sample.time;
    check.violation += sample.weight * (lack.wide + kExcessPrice * excess);
  }
  return check;
}

bool BandOptimizer::Evades(const Sample& sample, const BandCurve* curve) {
  BandCheck check{};
  double nearest = robot::kUnlimited;
  for (const robot::NearPair& pair : pairs_) nearest = std::min(nearest, pair.distance);
  if (LackAt(nearest, sample.time, check).contact > 0.0) return false;
  return curve == nullptr || AddedExcess(sample, *curve) <= kExcessTolerance;
}

unsigned BandOptimizer::EvadesAtEnd(const Eigen::Ref<const Eigen::MatrixXd>& q, int count) {
  const Sample& end = checks_.back();
  balls_ahead_.clear();
  for (int k = 0; k < count; ++k) {
    const auto ball = balls_.begin() + end.first_ball;
    balls_ahead_.insert(balls_ahead_.end(), ball, ball + std::ssize(moving_));
  }
  ahead_.leftCols(count) = q.leftCols(count);
  AskAhead(count, Reach());
  unsigned evading = 0;
  for (int k = 0; k < count; ++k) {
    Visit(end, k, Reach());
    if (Evades(end, nullptr)) evading |= 1u << k;
  }
  return evading;
}

bool BandOptimizer::EvadesAll(const BandCurve& curve, double from) {
  const auto later = static_cast<std::size_t>(
      std::lower_bound(checks_.begin(), checks_.end(), from,
                       [](const Sample& sample, double time) { return sample.time < time; }) -
      checks_.begin());
  const auto evades = [&](std::span<const Sample> samples) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const int lane = static_cast<int>(i % BatchClearance::kLanes);
      if (lane == 0) {
        LookAhead(samples.subspan(i), Reach(), [&](const Sample& at, Eigen::VectorXd& into) {
          curve.Evaluate(at.time, 0, into);
        });
      }
      Visit(samples[i], lane, Reach());
      if (!Evades(samples[i], &curve)) return false;
    }
    return true;
  };
  const std::span<const Sample> all(checks_);
  return evades(all.subspan(later)) && evades(all.first(later));
}

BandOptimizer::Room BandOptimizer::RoomAt(const Eigen::VectorXd& q, double time) {
  Room room{settings_.clear_distance, settings_.clear_distance, {}, {}};
  if (!something_near_) return room;
  PlaceAt(q, time);
  clearance_.Collect(settings_.clear_distance, pairs_);
  for (const robot::NearPair& pair : pairs_) {
    if (Flies(pair)) {
      room.flying = std::min(room.flying, pair.distance);
    } else if (pair.distance / pair.scale < room.standing) {
      room.standing = pair.distance / pair.scale;
      room.link = model().links()[static_cast<std::size_t>(pair.link)].name;
      room.body = pair.body >= 0 ? bodies_[static_cast<std::size_t>(pair.body)].name
                                 : model().links()[static_cast<std::size_t>(pair.other_link)].name;
    }
  }
  return room;
}

double BandOptimizer::DistanceToMoving(const Eigen::VectorXd& q, double time, double ahead) {
  std::vector<double> speeds(bodies_.size(), 0.0);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].stands) continue;
    const Eigen::Vector3d way =
        bodies_[b].pose(time + kSpeedSpan).translation() - bodies_[b].pose(time).translation();
    speeds[b] = way.norm() / kSpeedSpan;
  }
  double least = settings_.margin;
  const double fastest = speeds.empty() ? 0.0 : *std::max_element(speeds.begin(), speeds.end());
  PlaceAt(q, time);
  clearance_.Collect(settings_.margin + ahead * fastest, pairs_);
  for (const robot::NearPair& pair : pairs_) {
    if (!Flies(pair)) continue;
    least = std::min(least, pair.distance - ahead * speeds[static_cast<std::size_t>(pair.body)]);
  }
  return least;
}

}  // namespace oca::planning
