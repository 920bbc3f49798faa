// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/joint_limits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "oca/models/error.h"
#include "oca/models/motion/key_points.h"

namespace oca::robot {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kTurnsOfDegrees = 8.0;  // of a range, more than which may be meant as degrees
// Of the larger end of a range: what digits in a file take from ranges that are meant to touch.
constexpr double kLimitRounding = 1e-9;

double Given(double limit) { return limit == 0.0 ? kUnlimited : limit; }

PositionLimits OwnLimits(const Joint& joint) {
  return {joint.lower_limit,         joint.upper_limit,        Given(joint.velocity_limit),
          Given(joint.effort_limit), joint.acceleration_limit, joint.jerk_limit};
}

/// What a mimic leaves its leader.
PositionLimits ThroughMimic(const Joint& joint, const KinematicStep& step) {
  PositionLimits limits = OwnLimits(joint);
  limits.effort = kUnlimited;
  const double m = step.multiplier;
  if (m == 0.0) return {};  // it stands still: see Bind
  limits.lower = (limits.lower - step.offset) / m;
  limits.upper = (limits.upper - step.offset) / m;
  if (m < 0.0) std::swap(limits.lower, limits.upper);
  limits.velocity /= std::fabs(m);
  limits.acceleration /= std::fabs(m);
  limits.jerk /= std::fabs(m);
  return limits;
}

void Intersect(const PositionLimits& other, PositionLimits& limits) {
  limits.lower = std::max(limits.lower, other.lower);
  limits.upper = std::min(limits.upper, other.upper);
  limits.velocity = std::min(limits.velocity, other.velocity);
  limits.acceleration = std::min(limits.acceleration, other.acceleration);
  limits.jerk = std::min(limits.jerk, other.jerk);
}

std::string RangeText(double lower, double upper) {
  return fmt::format("[{:.9g}, {:.9g}]", lower, upper);
}

bool Below(double a, double b) {
  return a < b - kLimitRounding * std::max(std::fabs(a), std::isfinite(b) ? std::fabs(b) : 0.0);
}

/// Takes what a mimic leaves of `limits`. Two ends that rounding has made cross are one.
void Bind(models::Name robot, const Joint& mimic, const KinematicStep& step, const Joint& leader,
          PositionLimits& limits) {
  const PositionLimits before = limits;
  const double m = step.multiplier;
  Intersect(ThroughMimic(mimic, step), limits);
  const bool stands_outside =
      m == 0.0 && (Below(step.offset, mimic.lower_limit) || Below(mimic.upper_limit, step.offset));
  if (stands_outside || Below(limits.upper, limits.lower)) {
    throw models::ModelError(fmt::format(
        "robot '{}' joint '{}': mimic; got {} times the position of '{}' plus {}, which is outside "
        "its own limits {} {} wherever '{}' may stand, {} {}; expected limits that both can keep",
        robot.text(), mimic.name.text(), m, leader.name.text(), step.offset,
        RangeText(mimic.lower_limit, mimic.upper_limit), PositionUnit(mimic), leader.name.text(),
        RangeText(before.lower, before.upper), PositionUnit(leader)));
  }
  if (limits.upper < limits.lower) {
    limits.lower = limits.upper = 0.5 * limits.lower + 0.5 * limits.upper;
  }
}

const Joint& LeaderOf(const std::vector<Joint>& joints, Eigen::Index column) {
  return *std::find_if(joints.begin(), joints.end(),
                       [&](const Joint& joint) { return joint.position_index == column; });
}

bool IsMimic(const Joint& joint) { return joint.movable() && joint.mimic.has_value(); }

std::string Quoted(const std::vector<std::string>& names) {
  return fmt::format("joint{} '{}'", names.size() > 1 ? "s" : "", fmt::join(names, "', '"));
}

/// One line for all joints of which `holds` is true.
template <typename Predicate>
void WarnOfAll(const RobotModel& model, const char* what, Predicate&& holds,
               std::vector<std::string>& lines) {
  std::vector<std::string> names;
  for (const Joint& joint : model.joints()) {
    if (joint.movable() && holds(joint)) names.push_back(joint.name.text());
  }
  if (!names.empty()) lines.push_back(Quoted(names) + ": " + what);
}

void WarnOfMimics(const RobotModel& model, std::vector<std::string>& lines) {
  for (const Joint& leader : model.joints()) {
    const int column = leader.position_index;
    if (column < 0) continue;
    const PositionLimits own = OwnLimits(leader);
    const double lower = model.lower_limits()[column];
    const double upper = model.upper_limits()[column];
    const double velocity = model.velocity_limits()[column];
    const double acceleration = model.acceleration_limits()[column];
    const double jerk = model.jerk_limits()[column];
    std::vector<std::string> bounds;
    const char* unit = PositionUnit(leader);
    if (Below(own.lower, lower) || Below(upper, own.upper)) {
      bounds.push_back(fmt::format("{} {}", RangeText(lower, upper), unit));
    }
    if (Below(velocity, own.velocity)) bounds.push_back(fmt::format("{:.9g} {}/s", velocity, unit));
    if (Below(acceleration, own.acceleration)) {
      bounds.push_back(fmt::format("{:.9g} {}/s^2", acceleration, unit));
    }
    if (Below(jerk, own.jerk)) bounds.push_back(fmt::format("{:.9g} {}/s^3", jerk, unit));
    if (bounds.empty()) continue;
    std::vector<std::string> mimics;
    for (int j = 0; j < model.num_joints(); ++j) {
      const Joint& joint = model.joints()[j];
      if (IsMimic(joint) && model.steps()[j].column == column) mimics.push_back(joint.name.text());
    }
    lines.push_back(fmt::format("joint '{}': the limits of what mimics it, {}, bind it to {}",
                                leader.name.text(), Quoted(mimics), fmt::join(bounds, ", ")));
  }
}

/// Whole numbers, many turns apart: -170 and 170, as a person writes degrees.
bool LooksLikeDegrees(const Joint& joint, double lower, double upper) {
  return joint.type != JointType::kPrismatic && upper - lower > kTurnsOfDegrees * 2.0 * kHalfTurn &&
         lower == std::round(lower) && upper == std::round(upper);
}

void WarnOfRanges(const RobotModel& model, std::vector<std::string>& lines) {
  for (const Joint& joint : model.joints()) {
    const int i = joint.position_index;
    if (i < 0) continue;
    const double lower = model.lower_limits()[i];
    const double upper = model.upper_limits()[i];
    if (!std::isfinite(lower) || !std::isfinite(upper)) continue;
    if (HasOwnRange(model, i)) {
      if (!LooksLikeDegrees(joint, lower, upper)) continue;
      lines.push_back(fmt::format(
          "joint '{}': range {} rad, {:.0f} turns; it is kept, but looks like degrees",
          joint.name.text(), RangeText(lower, upper), (upper - lower) / (2.0 * kHalfTurn)));
      continue;
    }
    lines.push_back(fmt::format("joint '{}': range {} {}, wider than {}; it is kept, but {}",
                                joint.name.text(), RangeText(lower, upper), PositionUnit(joint),
                                joint.type == JointType::kPrismatic ? "100 m" : "100 turns",
                                DrawnRange(model, i)
                                    ? "where postures are drawn they are drawn from one turn"
                                    : "nothing that draws postures covers it"));
  }
}

}  // namespace

const char* PositionUnit(const Joint& joint) {
  return joint.type == JointType::kPrismatic ? "m" : "rad";
}

std::vector<PositionLimits> LimitsOfPositions(models::Name robot, const std::vector<Joint>& joints,
                                              const std::vector<KinematicStep>& steps) {
  std::vector<PositionLimits> all;
  for (const Joint& joint : joints) {  // in the order of their positions
    if (joint.position_index >= 0) all.push_back(OwnLimits(joint));
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!IsMimic(joints[j])) continue;
    const int column = steps[j].column;
    Bind(robot, joints[j], steps[j], LeaderOf(joints, column),
         all[static_cast<std::size_t>(column)]);
  }
  return all;
}

void GiveLimits(std::vector<Joint>& joints, const Eigen::VectorXd& limits, const std::string& what,
                double least, double Joint::*field) {
  if (limits.size() == 0) return;
  std::vector<Joint*> moving;
  for (Joint& joint : joints) {
    if (joint.movable() && !joint.mimic) moving.push_back(&joint);
  }
  if (limits.size() != 1 && limits.size() != std::ssize(moving)) {
    throw models::ModelError(
        fmt::format("{}: got {} numbers; expected 1 or {}", what, limits.size(), moving.size()));
  }
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const double limit = limits[limits.size() == 1 ? 0 : static_cast<Eigen::Index>(i)];
    if (!(limit >= least)) {
      throw models::ModelError(fmt::format("{}: joint '{}'; got {}; expected {:g} or more", what,
                                           moving[i]->name.text(), limit, least));
    }
    moving[i]->*field = limit;
  }
}

std::vector<std::string> LimitWarnings(const RobotModel& model) {
  std::vector<std::string> lines;
  const auto bounded = [&](const Joint& joint) {
    const int column =
        model.steps()[static_cast<std::size_t>(&joint - model.joints().data())].column;
    return column >= 0 && std::isfinite(model.velocity_limits()[column]);
  };
  const auto zero = [](const Joint& joint) { return joint.velocity_limit == 0.0; };
  WarnOfAll(
      model,
      "velocity limit 0 or none, as exporters write for 'not filled in'; counts as not given: "
      "nothing "
      "bounds the speed",
      [&](const Joint& joint) { return zero(joint) && !bounded(joint); }, lines);
  WarnOfAll(
      model,
      "velocity limit 0 or none, as exporters write for 'not filled in'; counts as not given",
      [&](const Joint& joint) { return zero(joint) && bounded(joint); }, lines);
  WarnOfAll(
      model, "no velocity limit; nothing bounds the speed",
      [&](const Joint& joint) {
        return joint.position_index >= 0 && !zero(joint) && !bounded(joint);
      },
      lines);
  WarnOfAll(
      model, "no effort limit, or 0; counts as not given, and no method of avoidance reads it",
      [](const Joint& joint) { return joint.effort_limit == 0.0; }, lines);
  WarnOfRanges(model, lines);
  WarnOfMimics(model, lines);
  return lines;
}

bool HasOwnRange(const RobotModel& model, Eigen::Index index) {
  const double width = model.upper_limits()[index] - model.lower_limits()[index];
  const auto& steps = model.steps();
  return std::all_of(steps.begin(), steps.end(), [&](const KinematicStep& step) {
    if (step.column != index) return true;
    // Widths that overflow or are none count as too wide.
    return std::fabs(step.multiplier) * width <=
           (step.type == JointType::kPrismatic ? kWidestSlide : kWidestTurn);
  });
}

std::optional<std::pair<double, double>> DrawnRange(const RobotModel& model, Eigen::Index index) {
  const double lower = model.lower_limits()[index];
  const double upper = model.upper_limits()[index];
  if (HasOwnRange(model, index)) return std::pair(lower, upper);
  if (upper - lower < 2.0 * kHalfTurn) return std::nullopt;  // a mimic goes too far
  for (const KinematicStep& step : model.steps()) {
    if (step.column != index) continue;
    const bool repeats =
        step.type != JointType::kPrismatic && std::round(step.multiplier) == step.multiplier;
    if (!repeats) return std::nullopt;
  }
  // A whole turn, moved into the limits.
  const double first = std::clamp(-kHalfTurn, lower, std::max(upper - 2.0 * kHalfTurn, lower));
  return std::pair(first, first + 2.0 * kHalfTurn);
}

std::pair<double, double> PossibleRange(const RobotModel& model, Eigen::Index index) {
  std::pair<double, double> range{-motion::kFarthestPosition, motion::kFarthestPosition};
  for (int j = 0; j < model.num_joints(); ++j) {
    const KinematicStep& step = model.steps()[j];
    if (step.column != index || step.multiplier == 0.0) continue;
    const Joint& joint = model.joints()[j];
    const double beyond =
        step.type == JointType::kPrismatic ? kFarthestSlideBeyond : kFarthestTurnBeyond;
    double lower = std::max(joint.lower_limit - beyond, -motion::kFarthestPosition);
    double upper = std::min(joint.upper_limit + beyond, motion::kFarthestPosition);
    lower = (lower - step.offset) / step.multiplier;
    upper = (upper - step.offset) / step.multiplier;
    if (step.multiplier < 0.0) std::swap(lower, upper);
    range = {std::max(range.first, lower), std::min(range.second, upper)};
  }
  return range;
}

std::string ImpossibleState(const RobotModel& model, const Eigen::Ref<const Eigen::VectorXd>& q) {
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const auto [lower, upper] = PossibleRange(model, i);
    if (q[i] >= lower && q[i] <= upper) continue;
    const Joint& joint = LeaderOf(model.joints(), i);
    return fmt::format("position of joint '{}'; got {} {}; expected {:g} to {:g}, {}",
                       joint.name.text(), q[i], PositionUnit(joint), lower, upper, kPossibleRule);
  }
  return "";
}

}  // namespace oca::robot
