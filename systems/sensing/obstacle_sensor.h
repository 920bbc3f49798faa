// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"
#include "oca/framework/dataflow/signal.h"
#include "oca/framework/dataflow/system.h"
#include "oca/systems/signals/signals.h"

namespace oca::systems {

/// The last samples of an ObstacleSensor, a ring, and the newest one that got through.
struct SensorLine {
  std::vector<ObstacleSet> ring;
  int next{0};         ///< the place of the oldest sample
  ObstacleSet held;    ///< what the sensor shows; its stamp is when it came in
  ObstacleSet coming;  ///< what it shows from its stamp on
};

/// Obstacles as a sensor with faults reports them: late, noisy, with samples lost, or not at all
/// for a while. Every `period` it takes a sample; at each tick t_k, and until the next, it shows
///
///     out = sample(t_j),  t_j the latest tick <= t_k - latency whose sample was not lost
///     sample = in, each pose moved by noise: p + position_noise g_1, turned by angle_noise g_2
///
/// g are standard normal, an entry an axis, drawn anew for each obstacle and tick; a sample is lost
/// with probability `dropout`, and all from `stale_from` to `stale_until` are. What is drawn at
/// tick k depends on `seed` and k alone. Twists are reported as they are, and go stale with the
/// poses; with `velocities` false they are not known, as to a camera, and who reads this takes what
/// moves for what stands unless an ObstacleTracker tells it. Until the first sample arrives there
/// are no obstacles. With latency 0 a sample is seen at once. The stamp of what is shown is the
/// time at which it came in, t_j + latency.
///
/// A latency between two periods is a whole number of the longest time that divides both: samples
/// of every 1/30 s, 0.05 s late, come in at (2 j + 3) / 60 s.
///
/// in    in         ObstacleSet
/// out   obstacles  ObstacleSet
/// state line       the samples on their way, and the one that is shown
/// throws ConfigError if latency is more than 1000 times what divides it and the period, if stale
///        times are not in order
class ObstacleSensor final : public System {
 public:
  static constexpr int kMostSteps = 1000;
  static constexpr SystemDoc kDoc{
      "reports obstacles late, noisy, with samples lost, or not for a while",
      "out(t_k) = in(t_j) + noise, t_j the latest tick <= t_k - latency whose sample was not lost",
      ""};
  struct Params {
    Period period{};
    Period latency{};
    bool velocities{true};
    double dropout{0.0};
    double position_noise{0.0};
    double angle_noise{0.0};
    double stale_from{0.0};
    double stale_until{0.0};
    int seed{0};
    static void Describe(Fields<Params>& fields);
  };
  static Params Example();

  explicit ObstacleSensor(const Params& params);

 private:
  std::int64_t TickOf(double time) const;
  void Report(std::int64_t tick, ObstacleSet& set) const;
  bool Lost(std::int64_t tick) const;
  void AddNoise(std::int64_t tick, ObstacleSet& set) const;
  Output<ObstacleSet> DeclareObstacles();
  void CalcLate(double time, const SensorLine& line, ObstacleSet& set) const;
  void CalcNow(double time, const ObstacleSet& truth, const SensorLine& line,
               ObstacleSet& set) const;
  void Sample(double time, const ObstacleSet& truth, SensorLine& line) const;

  const Params params_;
  const Period step_;  ///< what divides period and latency
  const int every_;    ///< steps a period
  const int steps_;    ///< of the latency
  const DiscreteState<SensorLine> line_;

 public:
  const Input<ObstacleSet> in;
  const Output<ObstacleSet> obstacles;
};

}  // namespace oca::systems

namespace oca {

template <>
struct Signal<systems::SensorLine> {
  static constexpr const char* kName = "SensorLine";
  static Fault Check(const systems::SensorLine& line, Look look);
};

}  // namespace oca
