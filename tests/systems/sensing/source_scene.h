// SPDX-License-Identifier: BSD-3-Clause
// Obstacles of the tests of ObstacleSource.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "oca/framework/dataflow/error.h"
#include "oca/systems/sensing/obstacle_source.h"

namespace oca::systems::source_scene {

/// At rest.
inline ObstacleSource::ObstacleParams Ball(const std::string& id, const Eigen::Vector3d& xyz) {
  ObstacleSource::ObstacleParams params;
  params.id = id;
  params.shape.radius = 0.1;
  params.pose = PoseParams{xyz, {}, {}};
  return params;
}

/// A ball that moves along x at 1 m/s.
inline ObstacleSource::ObstacleParams MovingBall() {
  ObstacleSource::ObstacleParams params = Ball("ball", Eigen::Vector3d::Zero());
  params.motion.emplace();
  params.motion->type = MotionType::kLinear;
  params.motion->velocity = Eigen::Vector3d(1.0, 0.0, 0.0);
  return params;
}

/// What a refusal says.
inline std::string RefusalOf(const ObstacleSource::Params& params) {
  try {
    ObstacleSource source(params);
  } catch (const ConfigError& error) {
    return error.what();
  }
  ADD_FAILURE() << "was accepted";
  return "";
}

}  // namespace oca::systems::source_scene
