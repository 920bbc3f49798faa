// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "oca/framework/dataflow/context.h"
#include "oca/framework/dataflow/diagram.h"
#include "oca/models/planning/band_optimizer.h"
#include "oca/models/robot/link_colliders.h"
#include "oca/systems/signals/signals.h"

namespace oca::tools {

/// An output ObstacleSet that depends on time alone, looked at whenever.
class ObstacleScript {
 public:
  /// `diagram` holds the output and, if it was made for the script, belongs to it.
  ObstacleScript(std::shared_ptr<const Diagram> diagram, const OutputHandle& output);

  /// All that is there at any time from 0 to `duration`, looked for every millisecond. What comes
  /// later or goes earlier is far away while it is not there. The bodies keep the script alive.
  static std::vector<planning::BandBody> Bodies(const std::shared_ptr<ObstacleScript>& script,
                                                double duration);

 private:
  Eigen::Isometry3d PoseOf(const systems::ObstacleBody& body, std::size_t place, double time);

  const std::shared_ptr<const Diagram> diagram_;
  const Output<systems::ObstacleSet> output_;
  Context context_;
};

/// The motion of a robot or a frame that does not evade: its links at every time.
class OtherMotion {
 public:
  OtherMotion(std::shared_ptr<const robot::RobotModel> model,
              std::function<Eigen::VectorXd(double time)> positions);

  const robot::RobotModel& model() const { return *model_; }
  const Eigen::Isometry3d& X_WL(int link, double time);
  /// Whether no link moves from 0 to `duration`, looked at every millisecond.
  bool Stands(double duration);

 private:
  const std::shared_ptr<const robot::RobotModel> model_;
  const std::function<Eigen::VectorXd(double time)> positions_;
  double time_{0.0};
  std::vector<Eigen::Isometry3d> X_WL_;
};

/// The solids of a link of it, under the name that the distance block gives the link.
std::vector<planning::BandBody> BodiesOf(const std::shared_ptr<OtherMotion>& motion,
                                         const robot::LinkCollider& link, models::Name name,
                                         bool stands);

}  // namespace oca::tools
