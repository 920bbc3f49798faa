// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "oca/framework/dataflow/diagram.h"
#include "oca/systems/commands/trajectory.h"

namespace oca::tools {

/// A motion that is known before it is made, and the system that knows it.
struct MotionAhead {
  std::shared_ptr<const systems::Trajectory> motion;
  const System* source;
};

/// What the nearest system up the line from an output knows ahead: one with an output of type
/// RequestAhead that holds a motion.
/// throws ConfigError, which begins with `where`, if there is none or two are equally near
MotionAhead MotionAheadOf(const Diagram& diagram, const OutputHandle& output,
                          const std::string& where);

}  // namespace oca::tools
