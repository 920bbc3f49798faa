// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/sensing/obstacle_motion.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// Obstacles that stand or move by script. At time t the output holds each obstacle that is there,
/// appear <= s < disappear, with its pose and twist in the world at the sample time
///
///     s = period floor(t / period), or t itself if period is 0.
///
/// s is computed from t alone and not stored: whatever else happens at a tick sees the obstacles
/// of that tick, not of the one before. Poses and motions are given in a frame, by default the
/// world; frames are at rest. Whatever drives `offsets`, a hand for example, moves the obstacles on
/// from there; how fast, nobody knows.
///
/// in    offsets    3 n  m       optional; added to the positions in the world, three numbers for
///                               each of the n obstacles of the parameter
/// out   obstacles  ObstacleSet  in the order of the parameter
/// state -
/// throws ConfigError for ids or frames that are empty or taken, unknown frames, bad shapes, poses,
///        motions and times, a negative period; files are relative to the working directory
/// source report section 3.2, Algorithm 1
class ObstacleSource final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "holds obstacles that stand or move by script",
      "pose = motion(s) for appear <= s < disappear, s = period floor(t / period)",
      "Jain, Sixt, Exner 2016, Algorithm 1"};
  struct Frame {
    std::string name{};
    PoseParams pose{};
    std::string parent{};
    static void Describe(Fields<Frame>& fields);
  };
  struct ObstacleParams {
    std::string id{};
    ShapeParams shape{};
    std::optional<PoseParams> pose{};
    std::string frame{};
    std::optional<MotionParams> motion{};
    std::optional<double> appear{};
    std::optional<double> disappear{};
    static void Describe(Fields<ObstacleParams>& fields);
  };
  struct Params {
    Period period{};
    std::vector<Frame> frames{};
    std::vector<ObstacleParams> obstacles{};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example();

  explicit ObstacleSource(const Params& params);

 private:
  struct Entry {
    std::shared_ptr<const ObstacleBody> body;
    std::shared_ptr<const ObstacleBody> free_body;  ///< the same, of any speed
    Eigen::Isometry3d X_WF;
    motion::ScriptedMotion motion;
    double appear;
    double disappear;
    bool stands;

    bool There(double time) const { return time >= appear && time < disappear; }
  };
  std::vector<Entry> MakeEntries(const Params& params);
  static void CheckStarts(const std::vector<Entry>& entries);
  Entry MakeEntry(const ObstacleParams& params, const Eigen::Isometry3d& X_WF);

  const Period period_;
  std::vector<std::string> warnings_;  ///< of the files that obstacles come from; by MakeEntries
  const std::vector<Entry> entries_;
  const std::vector<int> moving_;      ///< places in entries_ of those that do not stand
  const std::vector<double> changes_;  ///< times at which bodies come or go, ascending
  const std::uint64_t layout_;         ///< before the first of them; one more after each
  Output<ObstacleSet> DeclareObstacles(const Params& params);
  double SampleTime(double time) const;
  std::vector<int> MakeMoving() const;
  std::vector<double> MakeChanges() const;
  void CalcObstacles(double time, std::optional<VectorView> shifts, ObstacleSet& set) const;
  void FillIn(double sample_time, const VectorView* shifts, ObstacleSet& set) const;
  void CalcStanding(std::optional<VectorView> shifts, ObstacleSet& set) const;

 public:
  const OptionalInput<Vector> offsets;
  const Output<ObstacleSet> obstacles;
};

}  // namespace oca::systems
