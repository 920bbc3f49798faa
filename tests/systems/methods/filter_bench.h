// SPDX-License-Identifier: BSD-3-Clause
// An arm that a SafetyFilter leads, and what it is asked.
#pragma once

#include <memory>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/methods/safety_filter.h"
#include "oca/systems/sensing/model_links.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems::filter_bench {

constexpr double kDt = 0.01;  // period of the filter, s

inline SafetyFilter::Params Hundred() { return {.period = Period(1, 100), .safe_distance = 0.05}; }

/// A filter whose arm is exactly where the filter sends it.
class Loop {
 public:
  Loop(const SafetyFilter::Params& params, const ModelSet& models, const Eigen::VectorXd& q)
      : bench_(params, models), model_(models.Get("")), q_(q) {
    NameLinks(*model_, poses_);
    bench_->measured_position.Fix(bench_.context(), q_);
  }

  /// One tick with `request`; `around` tells the proximities of the links' poses.
  template <class Around>
  const FilterActivity& Tick(const Eigen::VectorXd& request, const Around& around) {
    robot::ForwardKinematics(*model_, q_, poses_.poses);
    bench_->links.Fix(bench_.context(), poses_);
    bench_->position.Fix(bench_.context(), request);
    bench_->proximities.Fix(bench_.context(), around(poses_));
    bench_.AdvanceTo((ticks_++ + 0.5) * kDt);
    const Eigen::VectorXd next = request + bench_->delta.Eval(bench_.context());
    velocity_ = (next - q_) / kDt;
    q_ = next;
    return bench_->activity.Eval(bench_.context());
  }
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& velocity() const { return velocity_; }
  SystemBench<SafetyFilter>& bench() { return bench_; }

 private:
  SystemBench<SafetyFilter> bench_;
  const std::shared_ptr<const robot::RobotModel> model_;
  LinkPoses poses_;
  Eigen::VectorXd q_, velocity_;
  int ticks_{0};
};

/// The forearm of planar2, stretched along x, whose tip at (0.9, 0, 0) has an obstacle at
/// `distance` in the direction y that moves with `speed` towards it.
inline ProximitySet BesideTheTip(double distance, double speed) {
  Proximity proximity;
  proximity.link = models::Name("planar2_link_2");
  proximity.obstacle = models::Name("ball");
  proximity.distance = distance;
  proximity.point_on_link = Eigen::Vector3d(0.9, 0, 0);
  proximity.point_on_obstacle = Eigen::Vector3d(0.9, distance, 0);
  proximity.normal = -Eigen::Vector3d::UnitY();
  proximity.obstacle_velocity = -speed * Eigen::Vector3d::UnitY();
  return {{proximity}};
}

}  // namespace oca::systems::filter_bench
