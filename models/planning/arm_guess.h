// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::planning {

/// Which joints of a robot are its arm, and where its hand is.
struct ArmGuess {
  std::vector<int> joints;  ///< numbers of the arm's joints, from the base on; they mimic none
  std::vector<int> others;  ///< of all others that have a position of their own
  int tip{0};               ///< number of the link
};

inline constexpr int kMostArmJoints = 7;

/// Guessed from the tree alone: the longest chain of joints that move, up to where it branches into
/// fingers or ends in a jaw, of which the last seven are the arm. A hand begins where, after four
/// joints or more, several joints go on with at most five each, or one does that others mimic, that
/// slides by at most 0.15 m (unless it carries a joint that turns, or slides on along the line of
/// the slide before it, as a telescope does), or whose name, or its link's, says finger, jaw or
/// claw (a joint's also gripper). Mimics within the chain belong to it. Of chains of one length the
/// first is taken. The tip is what the last joint carries, at its fixed frame that lies farthest
/// from the joint.
/// throws ModelError if fewer than two joints of a chain move
ArmGuess GuessArm(const robot::RobotModel& model);

/// Of `link` and the links that fixed joints carry beyond it the one whose frame is farthest from
/// its own.
int FarthestFixedTo(const robot::RobotModel& model, int link);

/// The joints that have a position of their own and are surely none of the arm, whatever their
/// number: GuessArm's `others`; and the last joint of its chain, however short that is, if its name
/// says so as above, or a joint mimics it that it does not carry, as the other finger does. None of
/// a robot that has no arm.
std::vector<int> JointsBesideArm(const robot::RobotModel& model);

}  // namespace oca::planning
