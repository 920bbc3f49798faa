// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "oca/diagrams/record/foxglove.h"
#include "oca/diagrams/record/record_channel.h"
#include "oca/diagrams/runs/signal_facts.h"
#include "oca/systems/signals/signals.h"

namespace oca::record {

/// Draws what a diagram's signals show: links, obstacles, distances, forces, torques and the paths
/// of the tips, as Foxglove messages.
///
/// Which outputs to sample follows from the types of the signals and the roles of the systems
/// (systems/roles.h); Draw gets their values in the order of sources().
class Scene {
 public:
  Scene(const loading::LoadedDiagram& loaded, const runs::SignalFacts& facts);

  const std::vector<OutputHandle>& sources() const { return sources_; }
  /// Channels that Emit numbers from 0.
  static std::vector<RecordChannel> Channels();
  using Emit = std::function<void(int channel, const std::string& json)>;

  /// The robots' links, once.
  void DrawRobots(std::uint64_t time, const Emit& emit) const;
  /// One instant; `values` as SampleQueue gives them.
  void Draw(std::uint64_t time, std::span<const void* const> values, const Emit& emit);
  /// What is left of the tips' paths.
  void Finish(std::uint64_t time, const Emit& emit);

 private:
  enum Channel { kTf, kRobots, kObstacles, kForces, kTrails };

  /// The path of a point, in pieces that begin where the one before ends.
  struct Trail {
    std::string id;
    Colour colour;
    std::vector<Eigen::Vector3d> points{};
    int pieces{0};
  };
  struct Robot {
    std::string name;
    std::shared_ptr<const robot::RobotModel> model;
    std::vector<std::string> frames;        ///< of the links
    std::optional<std::size_t> links;       ///< source
    std::optional<std::size_t> request;     ///< source
    int tip;                                ///< link
    std::vector<Eigen::Isometry3d> X_WL{};  ///< of a robot without `links`; of the request
    Trail requested, actual;
  };

  void AddRobots(const loading::LoadedDiagram& loaded, const runs::SignalFacts& facts);
  std::vector<std::size_t> AddSources(const std::vector<OutputHandle>& outputs);
  void DrawTransforms(std::uint64_t time, std::span<const void* const> values, const Emit& emit);
  void DrawObstacles(std::uint64_t time, std::span<const void* const> values, const Emit& emit);
  void DrawForces(std::uint64_t time, std::span<const void* const> values, const Emit& emit);
  void DrawTrails(std::uint64_t time, std::span<const void* const> values, const Emit& emit);
  void Extend(Trail& trail, const Eigen::Vector3d& point, std::uint64_t time,
              std::string& entities);
  void CloseTrail(Trail& trail, std::uint64_t time, std::string& entities);

  std::vector<OutputHandle> sources_;
  std::vector<Robot> robots_;
  std::vector<std::size_t> obstacles_, proximities_, forces_, wrenches_;
  double far_{1.0};  ///< m; from there on a distance is green
  std::map<std::string, const systems::ObstacleBody*> shown_;
  SceneEntity distances_entity_{"distances", "world"};
  SceneEntity forces_entity_{"forces", "world"};
  SceneEntity torques_entity_{"torques", "world"};
  std::string text_;
};

}  // namespace oca::record
