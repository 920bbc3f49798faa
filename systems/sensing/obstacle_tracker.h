// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/system.h"
#include "oca/models/sensing/body_filter.h"
#include "oca/systems/signals/signals.h"
#include "oca/systems/signals/track_set.h"

namespace oca::systems {

/// The bodies that an ObstacleTracker has in sight, in room for a fixed number: a copy takes no
/// memory after the first one, and no time for room that is empty.
class TrackMemory {
 public:
  struct Body {
    std::shared_ptr<const ObstacleBody> body;
    sensing::BodyTrack track;
    TrackState state{TrackState::kNew};
    double seen{0.0};  ///< s; time of its last pose, used or not
  };
  explicit TrackMemory(int most = 0) : room_(static_cast<std::size_t>(most)) {}
  TrackMemory(const TrackMemory&) = default;
  TrackMemory& operator=(const TrackMemory& other);

  std::span<Body> bodies() { return std::span(room_).first(count_); }
  std::span<const Body> bodies() const { return std::span(room_).first(count_); }
  bool full() const { return count_ == room_.size(); }
  /// One more, whose content is anything; not if it is full.
  Body& Add() { return room_[count_++]; }
  /// Those that were not seen for longer than `longest` before `time`, s.
  void Forget(double time, double longest);

  std::optional<double> looked{};  ///< s; the time of the newest set

 private:
  std::vector<Body> room_;
  std::size_t count_{0};
};

/// Velocities, accelerations and covariances of obstacles from their poses, as a camera tells them:
/// a sensing::BodyFilter for each id, and all of it foreseen from the time of the poses to now.
///
///     poses of  t = stamp - latency   (a set without a stamp is of now)
///     out(now)  = filter(poses up to t), foreseen by now - t
///
/// Each tick it looks at what came in. A set of the time of the last one says nothing new, one of
/// an earlier time is left out. A body that a set lacks is `lost` and goes on as it did for
/// keep_time, then it is gone; until then it may come `back`. An id that comes twice in a set
/// counts once, at its first place. Of what there is no room for, the pose is passed on with a
/// velocity that is not known. What is at rest with more than 90 % has velocity 0.
///
/// Bodies are in the order in which they came into sight, those without room behind them.
/// Velocities that come in are not looked at. A set that comes in at a tick is used at this tick
/// already.
///
/// in    in         ObstacleSet
/// out   obstacles  ObstacleSet  with estimates; age is that of the poses
///       tracks     TrackSet     in the order of obstacles
/// state tracks     TrackMemory
/// throws ConfigError for parameters out of their bounds
/// source models/sensing/body_filter.h; docs/explanation/unannounced.md
class ObstacleTracker final : public System {
 public:
  static constexpr SystemDoc kDoc{
      "estimates how obstacles move from their poses, as a camera tells them",
      "interacting multiple model of five Kalman filters a body: rests, p'' = w, p''' = -turn^2 p' "
      "+ w "
      "twice, p'' = g + w; foreseen by latency",
      "Blom, Bar-Shalom 1988, The interacting multiple model algorithm"};
  struct Params {
    Period period{};
    Period latency{};
    double keep_time{0.5};
    int most_bodies{32};
    double position_noise{0.005};
    double angle_noise{0.01};
    double acceleration_density{5e-5};
    double turning_density{0.5};
    double erratic_density{60.0};
    double spin_density{0.1};
    double switching{0.05};
    double turning_end{0.3};
    double prior_speed{0.5};
    double fastest{10.0};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example() { return {.period = Period(1, 100), .latency = Period(1, 20)}; }

  explicit ObstacleTracker(const Params& params);

 private:
  /// The memory after this instant's set.
  void CalcLooked(double time, const ObstacleSet& set, const TrackMemory& memory,
                  TrackMemory& looked) const;
  void Look(double sampled, const ObstacleSet& set, TrackMemory& memory) const;
  void See(double sampled, const Obstacle& obstacle, TrackMemory::Body& body) const;
  void CalcObstacles(double time, const ObstacleSet& set, const TrackMemory& looked,
                     ObstacleSet& result) const;
  void CalcTracks(double time, const ObstacleSet& set, const TrackMemory& looked,
                  TrackSet& result) const;
  void Keep(const TrackMemory& looked, TrackMemory& memory) const { memory = looked; }
  double SampledAt(double time, const ObstacleSet& set) const;

  const Params params_;
  const sensing::BodyFilter filter_;
  const DiscreteState<TrackMemory> memory_;

 public:
  const Input<ObstacleSet> in;

 private:
  const Cached<TrackMemory> looked_;

 public:
  const Output<ObstacleSet> obstacles;
  const Output<TrackSet> tracks;
};

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::TrackMemory> {
  static constexpr const char* kName = "TrackMemory";
  static Fault Check(const systems::TrackMemory& memory, Look look);
};

}  // namespace oca
