// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/scene_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/models/error.h"

namespace oca::drafts::internal {
namespace {

// Of a quintic from rest to rest, as shares of way / time and way / time^2: its first derivative in
// the middle, its second one at 1/2 - 1/sqrt(12).
constexpr double kQuinticSpeed = 1.875;
constexpr double kQuinticAcceleration = 5.7735026918962576;

}  // namespace

scenes::JointPositions Over(const scenes::JointPositions& over, scenes::JointPositions under) {
  if (over.where.empty()) return under;
  under.where = over.where;
  for (const auto& said : over.positions) {
    auto& known = under.positions;
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const auto& one) { return one.first == said.first; });
    if (found == known.end()) {
      known.push_back(said);
    } else {
      found->second = said.second;
    }
  }
  return under;
}

Eigen::VectorXd NeutralPositions(const robot::RobotModel& model) {
  return Eigen::VectorXd::Zero(model.num_positions())
      .cwiseMax(model.lower_limits())
      .cwiseMin(model.upper_limits());
}

Eigen::VectorXd PositionsOf(const robot::RobotModel& model, const scenes::JointPositions& joints,
                            const std::string& file, const char* what,
                            std::vector<std::string>& told) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.num_positions());
  models::ModelErrors errors;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const std::string& name = model.position_names()[static_cast<std::size_t>(i)].text();
    const double* const position = joints.Find(name);
    if (position == nullptr) {
      errors.Add(fmt::format("{}: {}: joint '{}'; got none; expected its position",
                             joints.where.empty() ? file : joints.where, what, name));
      continue;
    }
    q[i] = *position;
    const double lower = model.lower_limits()[i], upper = model.upper_limits()[i];
    if (q[i] >= lower && q[i] <= upper) continue;
    told.push_back(fmt::format("{}: {}: joint '{}' at {} is beyond its limits, {} to {}",
                               joints.where, what, name, q[i], lower, upper));
  }
  errors.Throw();
  return q;
}

std::vector<std::string> OtherJoints(const DraftRobot& robot, const scenes::JointPositions& joints,
                                     const char* what) {
  std::vector<std::string> lines;
  for (const auto& [name, position] : joints.positions) {
    const auto& all = robot.model->joints();
    const auto joint = std::find_if(all.begin(), all.end(), [&joint_name = name](const auto& one) {
      return one.name.text() == joint_name;
    });
    const std::string begin = fmt::format("{}: {}: joint '{}'", joints.where, what, name);
    if (joint == all.end()) {
      lines.push_back(begin + ": the model has none of that name");
    } else if (joint->held) {
      const auto held = robot.held.find(name);
      if (held != robot.held.end() && held->second == position) continue;
      lines.push_back(fmt::format(
          "{} at {}: it is not of the arm, and held{}", begin, position,
          held == robot.held.end() ? std::string() : fmt::format(" at {}", held->second)));
    } else if (!joint->movable()) {
      lines.push_back(fmt::format("{} at {}: the model has it fixed", begin, position));
    }
  }
  return lines;
}

double StraightTime(const robot::RobotModel& model, const Eigen::VectorXd& start,
                    const Eigen::VectorXd& goal, double accelerations) {
  double time = 0.0;
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const double way = std::fabs(goal[i] - start[i]);
    const double fastest = model.velocity_limits()[i];
    const double limit = std::min(accelerations, model.acceleration_limits()[i]);
    time = std::max(time, std::sqrt(kQuinticAcceleration * way / limit));
    // A limit of 0 says that there is none: LimitsOfPositions.
    if (std::isfinite(fastest) && fastest > 0.0) {
      time = std::max(time, kQuinticSpeed * way / fastest);
    }
  }
  return time;
}

}  // namespace oca::drafts::internal
