// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/scene_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/framework/dataflow/nearest.h"
#include "oca/models/error.h"

namespace oca::drafts::internal {
namespace {

// Of a quintic from rest to rest, as shares of way / time and way / time^2: its first derivative in
// the middle, its second one at 1/2 - 1/sqrt(12).
constexpr double kQuinticSpeed = 1.875;
constexpr double kQuinticAcceleration = 5.7735026918962576;

constexpr double kDigits = 1e-4;  // rad or m; what a file of four digits takes from a limit

/// The names of joints that the robot does not have, which may be misspelt.
void AddUnknown(const robot::RobotModel& model, const scenes::JointPositions& joints,
                const std::string& where, models::ModelErrors& errors) {
  std::vector<std::string> known;
  for (const robot::Joint& joint : model.joints()) known.push_back(joint.name.text());
  for (const auto& [name, position] : joints.positions) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    errors.Add(
        fmt::format("{}: joint '{}'; got a name that the robot does not have; expected one "
                    "of its joints{}",
                    where, name, DidYouMean(name, known)));
  }
}

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
                            std::vector<std::string>* told) {
  const std::string where = fmt::format("{}: {}", joints.where.empty() ? file : joints.where, what);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.num_positions());
  models::ModelErrors errors;
  bool missing = false;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const std::string& name = model.position_names()[static_cast<std::size_t>(i)].text();
    const double* const position = joints.Find(name);
    if (position == nullptr) {
      missing = true;
      errors.Add(fmt::format("{}: joint '{}'; got none; expected its position", where, name));
      continue;
    }
    q[i] = *position;
    const double lower = model.lower_limits()[i], upper = model.upper_limits()[i];
    if (q[i] >= lower && q[i] <= upper) continue;
    if (told != nullptr) {
      told->push_back(fmt::format("{}: joint '{}' at {} is beyond its limits, {} to {}", where,
                                  name, q[i], lower, upper));
    } else if (std::max(lower - q[i], q[i] - upper) > kDigits) {
      errors.Add(
          fmt::format("{}: joint '{}'; got {}; expected a position within its limits, {} to "
                      "{}",
                      where, name, q[i], lower, upper));
    }
  }
  if (missing) AddUnknown(model, joints, where, errors);
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
