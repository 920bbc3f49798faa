// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "oca/framework/dataflow/signal.h"
#include "oca/models/planning/band_planner.h"
#include "oca/systems/signals/request_ahead.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// What an ElasticBand holds between its plans, and what the last one came to.
/// JSON: {"plans", "start": "request" | "last" | "pause" | "detour" | "random" | "path", "clear",
/// "stuck", "nearest", "link", "obstacle", "time", "cost", "evaluations"}; the bands themselves are
/// neither written nor read.
struct BandMemory {
  planning::BandCurve held{};                           ///< up to `change`
  planning::BandCurve next{};                           ///< from then on; empty: held goes on
  double change{0.0};                                   ///< s
  std::shared_ptr<const motion::Trajectory> request{};  ///< that next was made for
  std::vector<Obstacle> seen{};
  double seen_at{0.0};     ///< s
  double sure_from{0.0};   ///< s; from then on the bands were made for what is seen
  double held_until{0.0};  ///< s; at which held or next leave less than trust_distance
  double next_until{0.0};
  double moved{0.0};          ///< s; when the arm was last seen to get on
  Eigen::VectorXd resting{};  ///< where it was then
  Eigen::VectorXd planned{};  ///< where it should be at the last plan
  int failures{0};            ///< plans in a row that were not clear

  std::uint64_t plans{0};  ///< that were made so far
  planning::BandStart start{planning::BandStart::kRequest};
  bool clear{true};
  bool stuck{false};    ///< no progress to the goal for stuck_time; link and obstacle say why
  double nearest{0.0};  ///< m; the least distance foreseen, or the margin
  models::Name link{};  ///< the pair, empty if it is the margin
  models::Name obstacle{};
  double time{0.0};  ///< s; of the nearest
  double cost{0.0};
  std::uint64_t evaluations{0};  ///< configurations that the last plan looked at

  /// The band at a time; before the first plan empty.
  const planning::BandCurve& At(double t) const {
    return !next.empty() && t >= change ? next : held;
  }
};

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::BandMemory> {
  static constexpr const char* kName = "BandMemory";
  static Fault Check(const systems::BandMemory& value, Look look);
  static void WriteJson(const systems::BandMemory& value, std::string& out);
};

}  // namespace oca
