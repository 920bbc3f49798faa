// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/hold_joints.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/nearest_name.h"
#include "oca/models/robot/joint_limits.h"

namespace oca::robot {
namespace {

using Names = std::vector<std::string>;

// A list of names longer than this only makes a message hard to read.
constexpr std::size_t kMostShown = 12;

/// `one of a, b; nearest is 'a'`
std::string OneOf(const Names& known, const std::string& name) {
  if (known.empty()) return "none, there is none";
  const std::string nearest = fmt::format("nearest is '{}'", models::NearestName(name, known));
  return known.size() > kMostShown ? nearest
                                   : fmt::format("one of {}; {}", fmt::join(known, ", "), nearest);
}

Names NamesOf(const std::vector<SrdfGroup>& groups) {
  Names names;
  for (const SrdfGroup& group : groups) names.push_back(group.name);
  return names;
}

const SrdfGroup& FindGroup(const std::vector<SrdfGroup>& groups, const std::string& name,
                           const std::string& where) {
  const auto found = std::find_if(groups.begin(), groups.end(),
                                  [&](const SrdfGroup& group) { return group.name == name; });
  if (found != groups.end()) return *found;
  throw models::ModelError(
      fmt::format("{}: unknown group; got '{}'; expected {} (groups are in the "
                  "SRDF)",
                  where, name, OneOf(NamesOf(groups), name)));
}

/// Gathers the joints of a group.
class GroupReader {
 public:
  GroupReader(const RobotModel& robot, const std::vector<SrdfGroup>& groups)
      : robot_(robot), groups_(groups) {
    for (const SrdfGroup& group : groups) by_name_.emplace(group.name, &group);
  }

  void Add(const std::string& name) {
    const auto found = by_name_.find(name);
    const SrdfGroup& group =
        found == by_name_.end() ? FindGroup(groups_, name, "group") : *found->second;
    if (open_.contains(&group)) {
      throw models::ModelError(
          fmt::format("group: '{}'; got one that is in itself; expected an end", name));
    }
    if (!done_.insert(&group).second) return;
    open_.insert(&group);
    for (const std::string& joint : group.joints) {
      if (const auto number = NumberOf(joint)) joints_.insert(*number);
    }
    for (const std::string& link : group.links) {
      const int joint = robot_.FindLink(link) - 1;
      if (joint >= 0) joints_.insert(joint);
    }
    for (const SrdfGroup::Chain& chain : group.chains) AddChain(chain);
    for (const std::string& inner : group.groups) Add(inner);
    open_.erase(&group);
  }

  std::vector<int> joints() const { return {joints_.begin(), joints_.end()}; }

 private:
  /// None of a virtual joint.
  std::optional<int> NumberOf(const std::string& joint) const {
    const auto& joints = robot_.joints();
    const auto found = std::find_if(joints.begin(), joints.end(),
                                    [&](const Joint& other) { return other.name.text() == joint; });
    if (found == joints.end()) return std::nullopt;
    return static_cast<int>(found - joints.begin());
  }

  /// Up from both ends to where they meet; links are numbered parents first.
  void AddChain(const SrdfGroup::Chain& chain) {
    int low = robot_.FindLink(chain.base_link);
    int high = robot_.FindLink(chain.tip_link);
    while (low != high) {
      if (low > high) std::swap(low, high);
      joints_.insert(high - 1);
      high = robot_.joints()[static_cast<std::size_t>(high) - 1].parent_link;
    }
  }

  const RobotModel& robot_;
  const std::vector<SrdfGroup>& groups_;
  std::unordered_map<std::string_view, const SrdfGroup*> by_name_;
  std::set<const SrdfGroup*> open_, done_;  // open: those around what is being added
  std::set<int> joints_;
};

/// Works out where the positions of a robot are held.
class Holder {
 public:
  Holder(const RobotModel& robot, const Srdf& srdf, const HeldJoints& held)
      : robot_(robot),
        srdf_(srdf),
        held_(held),
        positions_(static_cast<std::size_t>(robot.num_positions())) {}

  std::vector<Joint> Hold() {
    models::ModelErrors errors;
    for (const auto& state : held_.states) {
      errors.Try([&] { HoldState(state.first, state.second); });
    }
    for (const auto& joint : held_.positions) {
      errors.Try([&] { HoldJoint(joint.first, joint.second); });
    }
    if (!held_.group.empty()) errors.Try([&] { HoldOthers(); });
    errors.Throw();
    std::vector<Joint> joints = robot_.joints();
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const KinematicStep& step = robot_.steps()[j];
      if (step.column < 0 || !At(step.column)) continue;
      Fix(step.multiplier * *At(step.column) + step.offset, joints[j]);
    }
    return joints;
  }

 private:
  std::optional<double>& At(int column) { return positions_[static_cast<std::size_t>(column)]; }

  const Joint& LeaderOf(int column) const {
    return robot_.joints()[static_cast<std::size_t>(
        robot_.FindJoint(robot_.position_names()[static_cast<std::size_t>(column)].text()))];
  }

  static void Fix(double position, Joint& joint) {
    if (joint.type == JointType::kPrismatic) {
      joint.X_PJ.translate(Eigen::Vector3d(position * joint.axis));
    } else {
      joint.X_PJ.rotate(Eigen::AngleAxisd(position, joint.axis));
    }
    joint.type = JointType::kFixed;
    joint.mimic.reset();
    joint.held = true;
  }

  void CheckPosition(const std::string& where, const std::string& of, int column,
                     double position) const {
    const double lower = robot_.lower_limits()[column];
    const double upper = robot_.upper_limits()[column];
    if (std::isfinite(position) && position >= lower && position <= upper) return;
    throw models::ModelError(fmt::format("{}: got {} {}{}; expected {:.9g} to {:.9g}, its limits",
                                         where, position, PositionUnit(LeaderOf(column)), of, lower,
                                         upper));
  }

  void HoldJoint(const std::string& name, double position) {
    const std::string where = "held." + name;
    const int number = FindMoving(name, where);
    const int column = robot_.joints()[static_cast<std::size_t>(number)].position_index;
    CheckPosition(where, "", column, position);
    At(column) = position;
  }

  int FindMoving(const std::string& name, const std::string& where) const {
    const auto& joints = robot_.joints();
    const auto found = std::find_if(joints.begin(), joints.end(),
                                    [&](const Joint& joint) { return joint.name.text() == name; });
    if (found != joints.end() && found->position_index >= 0) {
      return static_cast<int>(found - joints.begin());
    }
    Names moving;
    for (const models::Name& other : robot_.position_names()) moving.push_back(other.text());
    std::string got = "no joint of the robot";
    std::string expected = "a joint that moves by itself: " + OneOf(moving, name);
    if (found != joints.end()) {
      const KinematicStep& step = robot_.steps()[static_cast<std::size_t>(found - joints.begin())];
      got = step.column < 0 ? "a fixed joint" : "a mimic";
      if (step.column >= 0) {
        expected =
            fmt::format("the joint that it follows, '{}'", LeaderOf(step.column).name.text());
      }
    }
    throw models::ModelError(fmt::format("{}: got {}; expected {}", where, got, expected));
  }

  void HoldState(const std::string& group, const std::string& name) {
    const std::string where = "held." + group;
    const auto& names = robot_.position_names();
    const bool is_joint = std::any_of(names.begin(), names.end(), [&](const models::Name& joint) {
      return joint.text() == group;
    });
    const bool is_group = std::any_of(srdf_.groups.begin(), srdf_.groups.end(),
                                      [&](const SrdfGroup& one) { return one.name == group; });
    if (is_joint && !is_group) {
      throw models::ModelError(
          fmt::format("{}: got '{}'; expected a finite number, rad or m", where, name));
    }
    FindGroup(srdf_.groups, group, where);
    Names known;
    const NamedState* state = nullptr;
    for (const NamedState& other : srdf_.states) {
      if (other.group != group) continue;
      known.push_back(other.name);
      if (other.name == name) state = &other;
    }
    if (state == nullptr) {
      throw models::ModelError(
          fmt::format("{}: unknown state; got '{}'; expected {}", where, name, OneOf(known, name)));
    }
    for (const auto& [joint, position] : state->positions) {
      const int column =
          robot_.joints()[static_cast<std::size_t>(robot_.FindJoint(joint))].position_index;
      if (column < 0) continue;  // a mimic follows its leader
      CheckPosition(where, fmt::format(" of joint '{}' in '{}'", joint, name), column, position);
      At(column) = position;
    }
  }

  void HoldOthers() {
    std::set<int> moving;
    const std::vector<int> joints = JointsOfGroup(robot_, srdf_.groups, held_.group);
    const auto in_group = [&](int joint) {
      return std::binary_search(joints.begin(), joints.end(), joint);
    };
    for (const int number : joints) {
      const KinematicStep& step = robot_.steps()[static_cast<std::size_t>(number)];
      const Joint& joint = robot_.joints()[static_cast<std::size_t>(number)];
      if (step.column < 0 || IsPassive(joint)) continue;
      const std::string& leader = LeaderOf(step.column).name.text();
      if (joint.position_index < 0 && !in_group(robot_.FindJoint(leader))) {
        throw models::ModelError(
            fmt::format("group: '{}'; got joint '{}' without '{}', which it mimics; expected both",
                        held_.group, joint.name.text(), leader));
      }
      if (joint.position_index >= 0 && !At(step.column)) moving.insert(step.column);
    }
    if (moving.empty()) {
      Names others = NamesOf(srdf_.groups);
      std::erase(others, held_.group);
      throw models::ModelError(fmt::format(
          "group: got '{}', of which no joint moves; expected a group of joints to move{}",
          held_.group,
          others.empty() ? "" : fmt::format(", perhaps of {}", fmt::join(others, ", "))));
    }
    for (int column = 0; column < robot_.num_positions(); ++column) {
      if (moving.contains(column) || At(column)) continue;
      At(column) = std::clamp(0.0, robot_.lower_limits()[column], robot_.upper_limits()[column]);
    }
  }

  bool IsPassive(const Joint& joint) const {
    return std::find(srdf_.passive.begin(), srdf_.passive.end(), joint.name.text()) !=
           srdf_.passive.end();
  }

  const RobotModel& robot_;
  const Srdf& srdf_;
  const HeldJoints& held_;
  std::vector<std::optional<double>> positions_;
};

}  // namespace

std::vector<int> JointsOfGroup(const RobotModel& robot, const std::vector<SrdfGroup>& groups,
                               const std::string& group) {
  GroupReader reader(robot, groups);
  reader.Add(group);
  return reader.joints();
}

std::vector<Joint> HoldJoints(const RobotModel& robot, const Srdf& srdf, const HeldJoints& held) {
  return Holder(robot, srdf, held).Hold();
}

}  // namespace oca::robot
