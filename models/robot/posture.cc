// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/posture.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "oca/models/error.h"
#include "oca/models/nearest_name.h"

namespace oca::robot {
namespace {

std::vector<std::string> PositionNames(const RobotModel& model) {
  std::vector<std::string> names;
  for (const models::Name& name : model.position_names()) names.push_back(name.text());
  return names;
}

std::string FullName(const NamedState& state) { return state.group + "/" + state.name; }

const NamedState& FindState(const RobotModel& model, std::string_view name) {
  const NamedState* found = nullptr;
  std::vector<std::string> names, same;
  for (const NamedState& state : model.states()) {
    names.push_back(state.name);
    if (state.name != name && FullName(state) != name) continue;
    found = &state;
    same.push_back(FullName(state));
  }
  if (same.size() == 1 && found != nullptr) return *found;
  if (same.empty()) {
    throw models::ModelError(
        fmt::format("got '{}'; expected a state of '{}': {}", name, model.name().text(),
                    names.empty() ? std::string("its SRDF has none")
                                  : fmt::format("{}; nearest is '{}'", fmt::join(names, ", "),
                                                models::NearestName(name, names))));
  }
  throw models::ModelError(fmt::format("got '{}', of which there are several; expected one of {}",
                                       name, fmt::join(same, ", ")));
}

}  // namespace

Eigen::VectorXd ZeroPosture(const RobotModel& model) {
  return Eigen::VectorXd::Zero(model.num_positions())
      .cwiseMax(model.lower_limits())
      .cwiseMin(model.upper_limits());
}

Eigen::VectorXd WithPositions(const RobotModel& model, const NamedPositions& positions,
                              Eigen::VectorXd q) {
  const std::vector<std::string> names = PositionNames(model);
  for (const auto& [name, position] : positions) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) {
      const auto& joints = model.joints();
      const auto joint =
          std::find_if(joints.begin(), joints.end(),
                       [&wanted = name](const Joint& j) { return j.name.text() == wanted; });
      throw models::ModelError(fmt::format(
          "got '{}'{}; expected joints of '{}': {}; nearest is '{}'", name,
          joint == joints.end() ? ""
          : joint->held         ? ", which is held"
          : joint->movable()    ? ", which is a mimic"
                                : ", which is fixed",
          model.name().text(), fmt::join(names, ", "), models::NearestName(name, names)));
    }
    q[found - names.begin()] = position;
  }
  return q;
}

Eigen::VectorXd WithState(const RobotModel& model, std::string_view state, Eigen::VectorXd q) {
  const NamedState& found = FindState(model, state);
  bool moves = false;
  for (const auto& [name, position] : found.positions) {
    const int index =
        model.joints()[static_cast<std::size_t>(model.FindJoint(name))].position_index;
    if (index < 0) continue;
    q[index] = position;
    moves = true;
  }
  if (moves) return q;
  throw models::ModelError(fmt::format(
      "got '{}', a state of no joint that moves; expected one of the joints of '{}': {}", state,
      model.name().text(), fmt::join(PositionNames(model), ", ")));
}

std::string OneAJoint(const RobotModel& model) {
  return fmt::format("{}, one a joint of '{}': {}", model.num_positions(), model.name().text(),
                     fmt::join(PositionNames(model), ", "));
}

}  // namespace oca::robot
