// SPDX-License-Identifier: BSD-3-Clause
// The half of MotionTally that certifies distances between the samples.
#include <algorithm>
#include <cmath>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/motion_tally.h"

namespace oca::robot {
namespace {

bool Known(const MotionSample& sample) {
  return sample.travel != nullptr && sample.position && sample.proximities != nullptr &&
         sample.proximities->max_distance > 0.0;
}

double Nearest(const ProximitySet& set) {
  double nearest = set.max_distance;
  for (const Proximity& proximity : set.proximities) {
    nearest = std::min(nearest, proximity.distance);
  }
  return nearest;
}

}  // namespace

MotionTally::PairList& MotionTally::PairList::operator=(const PairList& other) {
  reserve(other.capacity());
  assign(other.begin(), other.end());
  return *this;
}

/// The pair of the last sample, marked as found; null if it was not listed. They come in the same
/// order mostly, so the one after `place` is tried first.
MotionTally::Pair* MotionTally::FindPair(const Proximity& proximity, std::size_t& place) {
  for (std::size_t tried = 0; tried < pairs_.size(); ++tried) {
    Pair& pair = pairs_[place];
    place = place + 1 == pairs_.size() ? 0 : place + 1;
    if (pair.link == proximity.link && pair.obstacle == proximity.obstacle) {
      pair.found = true;
      return &pair;
    }
  }
  return nullptr;
}

double MotionTally::TravelOf(const RobotModel& model, models::Name link) const {
  if (link.empty()) return 0.0;
  const auto& links = model.links();
  const auto found = std::find_if(links.begin(), links.end(),
                                  [&](const Link& other) { return other.name == link; });
  if (found != links.end()) return travel_[static_cast<std::size_t>(found - links.begin())];
  return *std::max_element(travel_.begin(), travel_.end());
}

double MotionTally::TravelOf(const MotionSample& sample, models::Name link,
                             models::Name own_link) const {
  const RobotModel& model = *sample.model;
  if (own_link.empty()) return TravelOf(model, link);
  const auto number = [&](models::Name name) {
    const auto& links = model.links();
    const auto found = std::find_if(links.begin(), links.end(),
                                    [&](const Link& other) { return other.name == name; });
    return found == links.end() ? -1 : static_cast<int>(found - links.begin());
  };
  const int one = number(link);
  const int other = number(own_link);
  if (one < 0 || other < 0) return TravelOf(model, link) + TravelOf(model, own_link);
  const Eigen::Map<const Eigen::VectorXd> path(path_.data(), std::ssize(path_));
  return sample.travel->Between(poses_, path, one, other);
}

void MotionTally::CalcTravel(const MotionSample& sample) {
  const Eigen::Map<const Eigen::VectorXd> before(looked_position_.data(),
                                                 std::ssize(looked_position_));
  Eigen::Map<Eigen::VectorXd> path(path_.data(), before.size());
  path = (*sample.position - before).cwiseAbs();
  ForwardKinematics(*sample.model, before, poses_);
  sample.travel->Calc(poses_, path, travel_);
}

double MotionTally::LeastInStep(const MotionSample& sample, double step) {
  const ProximitySet& now = *sample.proximities;
  const double fastest = std::max(fastest_, now.fastest);
  const double most = travel_.empty() ? 0.0 : *std::max_element(travel_.begin(), travel_.end());
  // What is listed neither before nor after; two links of the robot may come near each other.
  double least = LeastDistanceBetween(reach_, now.max_distance, 2.0 * most + step * fastest);
  std::size_t place = 0;
  for (const Proximity& proximity : now.proximities) {
    const Pair* const before = FindPair(proximity, place);
    const double speed =
        std::max(before ? before->obstacle_speed : fastest_, proximity.obstacle_speed);
    const double travel = TravelOf(sample, proximity.link, proximity.own_link) + step * speed;
    least = std::min(least, LeastDistanceBetween(before ? before->distance : reach_,
                                                 proximity.distance, travel));
  }
  for (const Pair& pair : pairs_) {
    if (pair.found) continue;
    const double travel = TravelOf(sample, pair.link, pair.own_link) +
                          step * std::max(pair.obstacle_speed, now.fastest);
    least = std::min(least, LeastDistanceBetween(pair.distance, now.max_distance, travel));
  }
  return least;
}

void MotionTally::Certify(const MotionSample& sample, double step) {
  if (samples_ == 0) {
    certain_ = Known(sample);
    if (certain_) {
      certified_ = Nearest(*sample.proximities);
      poses_.resize(sample.model->links().size());
      travel_.resize(poses_.size());
      path_.resize(static_cast<std::size_t>(sample.position->size()));
    }
  } else if (certain_) {
    certain_ = Known(sample);
    if (certain_) {
      CalcTravel(sample);
      certified_ = std::min(certified_, LeastInStep(sample, step));
    }
  }
  if (!certain_) return;
  const ProximitySet& now = *sample.proximities;
  reach_ = now.max_distance;
  fastest_ = now.fastest;
  pairs_.clear();
  pairs_.reserve(now.proximities.capacity());  // so that no later sample allocates
  for (const Proximity& p : now.proximities) {
    pairs_.push_back({p.link, p.obstacle, p.own_link, p.distance, p.obstacle_speed, false});
  }
}

}  // namespace oca::robot
