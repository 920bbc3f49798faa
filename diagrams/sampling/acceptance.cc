// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/sampling/acceptance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oca::sampling {

void BoundParams::Describe(Fields<BoundParams>& fields) {
  fields.Add("at_least", &BoundParams::at_least, "", "lower bound");
  fields.Add("at_most", &BoundParams::at_most, "", "upper bound");
}

void ClearPathParams::Describe(Fields<ClearPathParams>& fields) {
  fields.Add("margin", &ClearPathParams::margin, "m", "that the path keeps from everything")
      .Above(0.0);
  fields
      .Add("most_nodes", &ClearPathParams::most_nodes, "",
           "of its trees, until the planner gives up")
      .AtLeast(2.0);
}

void AcceptParams::Describe(Fields<AcceptParams>& fields) {
  using P = AcceptParams;
  fields.Add("model", &P::model, "", "the robot that is looked at");
  fields.Add("request", &P::request, "", "system whose `position` is requested of it");
  fields.Add("obstacles", &P::obstacles, "", "system whose `obstacles` are in its way");
  fields.Add("lowest_link_origin", &P::lowest_link_origin, "m",
             "height of the lowest link's origin, at home and at the goal");
  fields.Add("home_distance", &P::home_distance, "m",
             "of the robot at the first request from the obstacles, at the start");
  fields.Add("goal_distance", &P::goal_distance, "m",
             "of the robot at the last request from the obstacles, at the end");
  fields.Add("foot_distance", &P::foot_distance, "m",
             "least one of the link that the first joint moves, which cannot evade, over the run");
  fields.Add("requested_distance", &P::requested_distance, "m",
             "least one of the requested motion, looked at every 0.01 s");
  fields.Add("clear_path", &P::clear_path, "",
             "a planner finds a way from home to the goal, the obstacles standing as at the start");
}

Acceptance::Acceptance(const Value& value, Problems& problems) {
  if (value.null()) return;
  ReadFields(value, FieldsOf<AcceptParams>(), "sampling.accept", &params_, problems);
}

bool Acceptance::Accepts(TaskGeometry& task, std::uint64_t seed) {
  const Eigen::VectorXd home = task.Request(0.0);
  const Eigen::VectorXd goal = task.Goal();
  constexpr const char* kLowest = "lowest_link_origin";
  const auto& p = params_;
  if (p.lowest_link_origin &&
      (!Holds(kLowest, p.lowest_link_origin, task.LowestLinkOrigin(home)) ||
       !Holds(kLowest, p.lowest_link_origin, task.LowestLinkOrigin(goal)))) {
    return false;
  }
  if (p.home_distance && !Holds("home_distance", p.home_distance, task.Distance(home, 0.0))) {
    return false;
  }
  if (p.goal_distance &&
      !Holds("goal_distance", p.goal_distance, task.Distance(goal, task.duration()))) {
    return false;
  }
  if (p.foot_distance && !Holds("foot_distance", p.foot_distance, task.FootDistance()))
    return false;
  if (p.requested_distance) {
    // Known to hold, or not to, as soon as it is at the one bound or below the other.
    constexpr double kNone = -std::numeric_limits<double>::infinity();
    const auto& [at_least, at_most] = *p.requested_distance;
    const double below = at_least ? std::nextafter(*at_least, kNone) : kNone;
    const double least = task.RequestedDistance(at_most && !at_least ? *at_most : below);
    if (!Holds("requested_distance", p.requested_distance, least)) return false;
  }
  if (!p.clear_path) return true;
  return Count("clear_path",
               task.HasClearPath(p.clear_path->margin, p.clear_path->most_nodes, seed));
}

bool Acceptance::Holds(const char* condition, const std::optional<BoundParams>& bound,
                       double value) {
  return Count(condition, (!bound->at_least || value >= *bound->at_least) &&
                              (!bound->at_most || value <= *bound->at_most));
}

bool Acceptance::Count(const char* condition, bool holds) {
  if (holds) return true;
  const auto found = std::find_if(refusals_.begin(), refusals_.end(), [&](const Refusal& refusal) {
    return refusal.condition == condition;
  });
  if (found == refusals_.end()) {
    refusals_.push_back({condition, 1});
  } else {
    ++found->count;
  }
  return false;
}

std::string Acceptance::Refusals() const {
  std::string text;
  for (const Refusal& refusal : refusals_) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", refusal.condition, refusal.count);
  }
  return text;
}

}  // namespace oca::sampling
