// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "oca/framework/dataflow/context.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/models/planning/band_optimizer.h"
#include "oca/systems/signals/signals.h"

namespace oca::foresight {

/// The obstacles of an output ObstacleSet that time alone moves: looked at for any time, s, in any
/// order. Poses are in the world, m. It holds one time: one a thread.
class ObstaclesAhead {
 public:
  /// `diagram` holds the output and, if it was made for it, belongs to it; else it must outlive it.
  /// throws ConfigError, which begins with `where`, if the output depends on the run; WiringError
  ///        if it is no ObstacleSet
  ObstaclesAhead(std::shared_ptr<const Diagram> diagram, const OutputHandle& output,
                 const std::string& where);

  /// The obstacles of an output of a diagram, which must outlive them; those of a system that holds
  /// obstacles and samples them (HoldsObstacles) between its samples too, unless others move them.
  static std::shared_ptr<ObstaclesAhead> Of(const Diagram& diagram, const OutputHandle& output,
                                            const std::string& where);

  /// Those that are there at a time; valid until the next look.
  const systems::ObstacleSet& At(double time);

 private:
  const std::shared_ptr<const Diagram> diagram_;
  const Output<systems::ObstacleSet> output_;
  Context context_;
};

/// All that is there at any time from 0 to `duration` (s), looked for every millisecond, in the
/// order in which it is first seen. What comes later or goes earlier is far below while it is not
/// there. The bodies keep the obstacles alive, and look at them: one thread for all.
std::vector<planning::BandBody> BodiesInTime(const std::shared_ptr<ObstaclesAhead>& obstacles,
                                             double duration);

}  // namespace oca::foresight
