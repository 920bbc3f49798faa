// SPDX-License-Identifier: BSD-3-Clause
// What the tests of ElasticBand drive: a planar arm that is asked to turn past a post, and follows.
#pragma once

#include <string>

#include "oca/models/geometry/collider.h"
#include "oca/models/robot/urdf.h"
#include "oca/systems/methods/elastic_band.h"
#include "tests/systems/system_bench.h"

namespace oca::systems::band_bench {

inline ModelSet Planar() {
  ModelSet models;
  models.Add("arm", std::make_shared<const robot::RobotModel>(
                        robot::LoadUrdf(OCA_SOURCE_DIR "/models/robots/planar3/planar3.urdf")));
  return models;
}

/// Joint 1 turns by 90 degrees between 0.5 and 4.5 s.
inline RequestAhead Turn() {
  return {std::make_shared<const motion::Trajectory>(
      motion::Trajectory::CubicHermite({{.time = 0.5, .position = Eigen::Vector3d(0, 0, 0)},
                                        {.time = 4.5, .position = Eigen::Vector3d(1.57, 0, 0)}}))};
}

inline ObstacleSet BoxAt(const Eigen::Vector3d& place, double size = 0.1) {
  auto body = std::make_shared<ObstacleBody>();
  body->id = models::Name("post");
  body->collider = geometry::MakeCollider(geometry::Box{Eigen::Vector3d(size, size, 0.4)}, "post");
  Obstacle obstacle;
  obstacle.body = body;
  obstacle.X_WO.translation() = place;
  return {{obstacle}};
}

class Bench : public SystemBench<ElasticBand> {
 public:
  explicit Bench(const ObstacleSet& obstacles,
                 const ElasticBand::Params& params = ElasticBand::Example())
      : SystemBench(params, Planar()) {
    (*this)->ahead.Fix(context(), Turn());
    (*this)->obstacles.Fix(context(), obstacles);
    Measure(Eigen::Vector3d::Zero());
  }
  void Measure(const Eigen::VectorXd& q) { (*this)->measured_position.Fix(context(), q); }
  Eigen::VectorXd Position() { return (*this)->position.Eval(context()); }
  const BandReport& Plan() { return (*this)->plan.Eval(context()); }
  /// To the tick at k periods, that included; the arm follows.
  void Tick(int k) {
    AdvanceTo((k + 0.5) * 0.01);
    Measure(Position());
  }
};

/// Ticks from k on, the arm following; how far it went in the last two seconds, summed.
inline double WayOf(Bench& bench, int& k, int ticks) {
  double way = 0.0;
  Eigen::VectorXd last = bench.Position();
  for (const int end = k + ticks; k < end; ++k) {
    bench.Tick(k);
    if (k >= end - 200) way += (bench.Position() - last).norm();
    last = bench.Position();
  }
  return way;
}

}  // namespace oca::systems::band_bench
