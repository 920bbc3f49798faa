// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::planning {

/// A motion straight in the joints, and a ball in its way.
struct FirstMotion {
  Eigen::VectorXd from, to;                       ///< n; rad or m
  Eigen::Vector3d ball{Eigen::Vector3d::Zero()};  ///< its centre, world, m
  double size{0.0};                               ///< m; the arm's reach, or a part of it
  double radius{0.0};                             ///< m
  double depth{0.0};                              ///< m; how deep the arm would go into it
  double room{0.0};                               ///< m; from the ball, where it starts and ends
};

/// How large an arm is, m: how far a link's origin gets from that of the first joint that moves it,
/// at most. That is the lengths between the joints and how far sliding ones go together, along a
/// line or across each other. The range of each counts no more than all lengths together: a long
/// rail makes no large arm.
/// throws ModelError if a sliding joint has no range, or the bound is 0
double ReachOf(const robot::RobotModel& model, int link);

/// Motions to try a robot with, best first, at most `count`: one joint turns, or slides, the tip
/// goes half of its reach or more, and a ball of a twelfth of the reach lies across its way, clear
/// of where it starts and ends. Postures are drawn from the middle of the ranges: the arm bent, no
/// link below the base's foot, own links apart. Where there is none of these, links may be below
/// the base, as of an arm that hangs; then the tip's way and the room shorter. All distances scale
/// with the motion's size: the reach, or, where that gives none, its half or its quarter, as of an
/// arm whose first joints slide by little.
///
/// No joint goes farther than `ways` has for it, rad or m, n; empty: than its range lets it.
///
/// Whether an arm can evade is not known here. The same seed gives the same motions; none if
/// nothing of the kind is found. `progress` is told now and then what share of the postures was
/// tried; false: it ends.
/// throws ModelError for a robot whose solids Clearance refuses, or whose postures cannot be drawn
std::vector<FirstMotion> ProposeMotions(const std::shared_ptr<const robot::RobotModel>& model,
                                        int tip, std::size_t count, std::uint64_t seed = 0,
                                        const std::function<bool(double share)>& progress = {},
                                        const Eigen::VectorXd& ways = {});

}  // namespace oca::planning
