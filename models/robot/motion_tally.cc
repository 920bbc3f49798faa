// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/motion_tally.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace oca::robot {
namespace {

using Positions = MotionSample::Positions;

// A change of the delta below this is none, so that rounding does not count as chatter.
constexpr double kLeastChange = 1e-6;

// As near to the goal as this it is reached; rad, m.
constexpr double kArrived = 0.01;
// An arm that turns no joint by more than kStill, rad or m, in kPatience seconds stands.
constexpr double kStill = 0.02;
constexpr double kPatience = 2.0;
// What is nearer may be in the way, m; own links, which stand near by design, at their range.
constexpr double kInTheWay = 0.1;
// What rounding may take a joint beyond its limits: rad or m, and shares of the others.
constexpr double kTallyRounding = 1e-6;

// Stands for what blocks a joint whose goal is beyond its limit.
const models::Name kLimitName("limit");

double MaxNorm(const Eigen::Ref<const Eigen::VectorXd>& values) {
  return values.size() == 0 ? 0.0 : values.cwiseAbs().maxCoeff();
}

/// Sum of |now - before| over the components.
double PathLength(Positions now, const std::vector<double>& before) {
  double length = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    length += std::fabs(now[static_cast<Eigen::Index>(i)] - before[i]);
  }
  return length;
}

double Farthest(Positions one, Positions other) {
  return one.size() == 0 ? 0.0 : (one - other).cwiseAbs().maxCoeff();
}

Positions View(const std::vector<double>& values) {
  return Positions(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// Standard vectors keep their capacity where Eigen's let it go.
void Keep(Positions values, std::vector<double>& kept) {
  kept.assign(values.begin(), values.end());
}

std::optional<double> FinalError(const MotionSample& now) {
  const auto& goal = now.goal ? now.goal : now.request;
  if (!now.position || !goal) return std::nullopt;
  double error = 0.0;
  for (Eigen::Index i = 0; i < goal->size(); ++i) {
    error = std::max(error, std::fabs((*now.position)[i] - (*goal)[i]));
  }
  return error;
}

}  // namespace

void MotionTally::Add(const MotionSample& sample) {
  const double step = sample.time - last_time_;  // without meaning in the first sample
  if (samples_ == 0) first_time_ = sample.time;
  Look(sample);
  looks_ = 0;
  if (sample.position) AddPosition(*sample.position, sample.model, step);
  if (sample.position && sample.goal) {
    if (*FinalError(sample) > kArrived) {
      goal_time_.reset();
    } else if (!goal_time_) {
      goal_time_ = sample.time - first_time_;
    }
    AddStandstill(sample);
    AddProgress(sample);
  }
  if (sample.request) {
    if (samples_ > 0) request_path_ += PathLength(*sample.request, request_);
    Keep(*sample.request, request_);
  }
  if (sample.delta) AddDelta(*sample.delta);
  last_time_ = sample.time;
  ++samples_;
}

void MotionTally::Look(const MotionSample& sample) {
  const double step = sample.time - looked_at_;
  if (samples_ > 0 && in_contact_) contact_time_ += step;
  AddDistance(sample);
  Certify(sample, step);
  if (sample.position) Keep(*sample.position, looked_position_);
  looked_at_ = sample.time;
  ++looks_;
}

void MotionTally::AddDistance(const MotionSample& sample) {
  in_contact_ = false;
  if (sample.proximities == nullptr) return;
  looked_ |= sample.proximities->compared || !sample.proximities->proximities.empty();
  for (const Proximity& proximity : sample.proximities->proximities) {
    in_contact_ |= proximity.distance <= 0.0;
    // A distance that is none stays, so that the run fails by it.
    const bool none = std::isnan(proximity.distance);
    if (min_distance_ && !none && !(proximity.distance < *min_distance_)) continue;
    min_distance_ = proximity.distance;
    min_distance_link_ = proximity.link;
    min_distance_obstacle_ = proximity.obstacle;
    min_distance_time_ = sample.time;
  }
  if (in_contact_ && !first_contact_time_) first_contact_time_ = sample.time;
}

void MotionTally::CountViolations(Positions position, const RobotModel& model, double step) {
  for (Eigen::Index i = 0; i < position.size(); ++i) {
    bool beyond = position[i] < model.lower_limits()[i] - kTallyRounding ||
                  position[i] > model.upper_limits()[i] + kTallyRounding;
    if (samples_ > 0) {
      const double velocity = (position[i] - position_[i]) / step;
      const double acceleration = (velocity - velocity_[i]) / step;
      beyond |= std::fabs(velocity) > (1.0 + kTallyRounding) * model.velocity_limits()[i];
      beyond |= samples_ > 1 &&
                std::fabs(acceleration) > (1.0 + kTallyRounding) * model.acceleration_limits()[i];
    }
    limit_violations_ += beyond ? 1.0 : 0.0;
  }
}

void MotionTally::AddPosition(Positions position, const RobotModel* model, double step) {
  if (model != nullptr) CountViolations(position, *model, step);
  if (samples_ == 0) {
    velocity_.assign(static_cast<std::size_t>(position.size()), 0.0);
  } else {
    position_path_ += PathLength(position, position_);
    path_length_ += (position - View(position_)).stableNorm();  // squares may overflow
    for (Eigen::Index i = 0; i < position.size(); ++i) {
      const double velocity = (position[i] - position_[i]) / step;
      max_speed_ = std::max(max_speed_, std::fabs(velocity));
      if (samples_ > 1) {
        max_acceleration_ = std::max(max_acceleration_, std::fabs(velocity - velocity_[i]) / step);
      }
      velocity_[i] = velocity;
    }
  }
  Keep(position, position_);
}

void MotionTally::AddDelta(Positions delta) {
  max_abs_delta_ = std::max(max_abs_delta_, MaxNorm(delta));
  if (samples_ == 0) {
    delta_direction_.assign(static_cast<std::size_t>(delta.size()), 0.0);
  } else {
    for (Eigen::Index i = 0; i < delta.size(); ++i) {
      const double change = delta[i] - delta_[i];
      if (std::fabs(change) <= kLeastChange) continue;
      const double direction = change > 0.0 ? 1.0 : -1.0;
      if (direction == -delta_direction_[i]) reversals_ += 1.0;
      delta_direction_[i] = direction;
    }
  }
  Keep(delta, delta_);
}

void MotionTally::AddStandstill(const MotionSample& sample) {
  const Positions q = *sample.position;
  const bool as_requested = sample.request && Farthest(q, *sample.request) <= kArrived;
  if (samples_ == 0 || as_requested || Farthest(q, *sample.goal) <= kArrived ||
      Farthest(q, View(still_)) > kStill) {
    Keep(q, still_);
    still_since_ = sample.time;
    return;
  }
  const double stood = sample.time - still_since_;
  if (stood < kPatience * (1.0 - kTallyRounding) || stood <= stuck_time_) return;
  stuck_time_ = stood;
  NoteWhatBlocks(sample);
}

/// Once the request is at its goal an arm that goes about and comes no nearer is as stuck as one
/// that stands.
void MotionTally::AddProgress(const MotionSample& sample) {
  const double away = Farthest(*sample.position, *sample.goal);
  const bool requested = !sample.request || Farthest(*sample.request, *sample.goal) > kArrived;
  if (samples_ == 0 || requested || away <= kArrived || away < nearest_away_ - kStill) {
    nearest_away_ = away;
    gained_at_ = sample.time;
  } else if (sample.time - gained_at_ > std::max(kPatience, stuck_time_)) {
    NoteWhatBlocks(sample);
  }
}

void MotionTally::NoteWhatBlocks(const MotionSample& sample) {
  if (NoteLimit(sample)) return;
  // What blocked may be gone by the time that the arm goes on.
  if (sample.proximities == nullptr || sample.proximities->proximities.empty()) return;
  const auto& near = sample.proximities->proximities;
  const auto counted = [](const Proximity& pair) {
    return pair.distance / RangeShare(pair, kInTheWay);
  };
  const auto nearest = std::min_element(
      near.begin(), near.end(),
      [&](const Proximity& a, const Proximity& b) { return counted(a) < counted(b); });
  stuck_link_ = nearest->link;
  stuck_obstacle_ = nearest->obstacle;
  stuck_amount_ = nearest->distance;
}

/// A joint that stands at a limit which its goal is beyond; of several the one that lacks most.
bool MotionTally::NoteLimit(const MotionSample& sample) {
  if (sample.model == nullptr) return false;
  double most = kArrived;
  Eigen::Index joint = -1;
  for (Eigen::Index i = 0; i < sample.goal->size(); ++i) {
    const double lower = sample.model->lower_limits()[i];
    const double upper = sample.model->upper_limits()[i];
    const double goal = (*sample.goal)[i];
    const double limit = goal > upper ? upper : lower;
    const double beyond = goal > upper ? goal - upper : lower - goal;
    if (!(beyond > most) || std::fabs((*sample.position)[i] - limit) > kStill) continue;
    most = beyond;
    joint = i;
  }
  if (joint < 0) return false;
  stuck_link_ = sample.model->position_names()[static_cast<std::size_t>(joint)];
  stuck_obstacle_ = kLimitName;
  stuck_amount_ = most;
  return true;
}

MotionMetricsValue MotionTally::At(const MotionSample& now) const {
  MotionMetricsValue value;
  value.final_error = FinalError(now);
  if (samples_ == 0) return value;
  if (now.position && now.goal) {
    value.time_to_goal = goal_time_;
    value.stuck_time = stuck_time_;
    const double without_gain = now.time - gained_at_;
    if (!goal_time_ && without_gain >= kPatience * (1.0 - kTallyRounding)) {
      value.stuck_time = std::max(stuck_time_, without_gain);
    }
    value.stuck_link = stuck_link_;
    value.stuck_obstacle = stuck_obstacle_;
    if (!stuck_link_.empty()) value.stuck_amount = stuck_amount_;
  }
  if (now.position && now.model != nullptr) value.limit_violations = limit_violations_;
  const double duration = now.time - first_time_;
  value.min_distance = min_distance_;
  if (min_distance_) {
    value.min_distance_link = min_distance_link_;
    value.min_distance_obstacle = min_distance_obstacle_;
    value.min_distance_time = min_distance_time_;
  }
  if (certain_ && looked_) value.certified_min_distance = certified_;
  if (now.proximities != nullptr && looked_) {
    value.contact_time = contact_time_ + (in_contact_ ? now.time - looked_at_ : 0.0);
    value.first_contact_time = first_contact_time_;
  }
  if (now.delta) {
    value.max_abs_delta = max_abs_delta_;
    if (duration > 0.0 && now.delta->size() > 0) {
      value.delta_sign_changes_per_second =
          reversals_ / (static_cast<double>(now.delta->size()) * duration);
    }
  }
  if (now.position && samples_ > 1) {
    value.path_length = path_length_;
    value.max_joint_speed = max_speed_;
    value.final_speed = MaxNorm(View(velocity_));
  }
  if (now.position && samples_ > 2) value.max_joint_acceleration = max_acceleration_;
  if (now.position && request_path_ > 0.0) {
    value.total_variation_ratio = position_path_ / request_path_;
  }
  return value;
}

bool MotionTally::finite() const {
  const auto all_finite = [](const std::vector<double>& values) {
    return View(values).allFinite();
  };
  const double numbers[] = {certified_,
                            reach_,
                            fastest_,
                            last_time_,
                            looked_at_,
                            contact_time_,
                            max_abs_delta_,
                            position_path_,
                            path_length_,
                            request_path_,
                            max_speed_,
                            max_acceleration_,
                            limit_violations_,
                            stuck_time_,
                            stuck_amount_,
                            nearest_away_,
                            gained_at_,
                            min_distance_.value_or(0.0),
                            goal_time_.value_or(0.0)};
  return std::all_of(std::begin(numbers), std::end(numbers),
                     [](double number) { return std::isfinite(number); }) &&
         all_finite(position_) && all_finite(looked_position_) && all_finite(velocity_) &&
         all_finite(request_) && all_finite(delta_);
}

}  // namespace oca::robot
