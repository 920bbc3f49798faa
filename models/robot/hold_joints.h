// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>
#include <vector>

#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/srdf.h"

namespace oca::robot {

/// Which joints a task does not move, and where they are.
struct HeldJoints {
  /// A group of the SRDF: all joints outside of it are held, and its passive ones; empty: none is
  /// held but those below.
  std::string group{};
  std::map<std::string, double> positions{};    ///< by the name of the joint, rad or m
  std::map<std::string, std::string> states{};  ///< by the name of the group: a state of it

  bool empty() const { return group.empty() && positions.empty() && states.empty(); }
};

/// The joints of a group, as numbers, ascending: those that it names, those that lead to its links,
/// those between the ends of its chains, and those of the groups in it.
/// throws ModelError if there is no such group, or it is in itself
/// source MoveIt, "URDF and SRDF"
std::vector<int> JointsOfGroup(const RobotModel& robot, const std::vector<SrdfGroup>& groups,
                               const std::string& group);

/// The joints of a robot with those that are held fixed where they are held: X_PJ becomes X_PJ
/// times their motion there. What mimics a held joint is held with it. A joint stands where
/// `positions` have it, else where `states` have it, else, outside of `group`, at 0 or the limit
/// nearest to it.
///
/// throws ModelError `held.NAME: ...` for what is no joint that moves by itself (a mimic is held by
///        its leader) or a position beyond its limits, `group: ...` for what is no group, one of
///        which nothing moves, or one with a mimic whose leader is outside
std::vector<Joint> HoldJoints(const RobotModel& robot, const Srdf& srdf, const HeldJoints& held);

}  // namespace oca::robot
