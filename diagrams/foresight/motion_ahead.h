// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/period.h"
#include "oca/models/motion/trajectory.h"

namespace oca::foresight {

/// A motion that is known before it is made, and the system that knows it.
struct MotionAhead {
  std::shared_ptr<const motion::Trajectory> motion;  ///< rad or m; never null
  Period period;                                     ///< of its samples; 0: none
  const System* source;
};

/// What the nearest system up the line from an output, through states too, knows ahead: one with an
/// output of type RequestAhead that holds a motion.
/// throws ConfigError, which begins with `where`, if there is none, two are equally near, or it has
///        another length than the output
MotionAhead MotionAheadOf(const Diagram& diagram, const OutputHandle& output,
                          const std::string& where);

/// Joint positions at every time, s, in any order: one number a joint, rad or m.
using Positions = std::function<Eigen::VectorXd(double time)>;

/// Joint positions that are known before they are taken, and the system that knows them.
struct PositionsAhead {
  Positions at;
  const System* source;
  bool requested;  ///< of somebody who may evade; else they are what the output will be
};

/// Of a motion that its source samples: all of it, or at a time what is shown just before it, that
/// of the next tick.
enum class Samples { kBetween, kShown };

/// A Vector output at every time, if time alone moves it; else what MotionAheadOf says is
/// requested. `diagram` must outlive the answer. One answer a thread.
/// throws ConfigError as MotionAheadOf; WiringError if the output is no Vector
PositionsAhead PositionsAheadOf(const Diagram& diagram, const OutputHandle& output, Samples samples,
                                const std::string& where);

}  // namespace oca::foresight
