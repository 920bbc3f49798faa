// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/signals/signals.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {

// Arms and what is near them, for methods that choose joint velocities.

inline LinkPoses PosesOf(const robot::RobotModel& model, const Eigen::VectorXd& q) {
  LinkPoses poses;
  NameLinks(model, poses);
  robot::ForwardKinematics(model, q, poses.poses);
  return poses;
}

/// An obstacle at `distance` in the direction -n of a point of a link, that moves with `velocity`.
inline Proximity Near(const std::string& link, const Eigen::Vector3d& point, double distance,
                      const Eigen::Vector3d& n,
                      const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero()) {
  Proximity proximity;
  proximity.link = models::Name(link);
  proximity.obstacle = models::Name("ball");
  proximity.distance = distance;
  proximity.point_on_link = point;
  proximity.point_on_obstacle = point - distance * n;
  proximity.normal = n;
  proximity.obstacle_velocity = velocity;
  return proximity;
}

/// The obstacle of Near above (in +y) a point of an arm that is stretched along x.
inline Proximity Above(const std::string& link, double x, double distance, double speed = 0.0) {
  return Near(link, {x, 0, 0}, distance, -Eigen::Vector3d::UnitY(),
              -speed * Eigen::Vector3d::UnitY());
}

inline Proximity Moved(const Eigen::Isometry3d& X, Proximity proximity) {
  proximity.point_on_link = X * proximity.point_on_link;
  proximity.point_on_obstacle = X * proximity.point_on_obstacle;
  proximity.normal = X.linear() * proximity.normal;
  proximity.obstacle_velocity = X.linear() * proximity.obstacle_velocity;
  return proximity;
}

/// The scene behind a mirror in the plane y = 0.
inline Proximity Mirrored(Proximity proximity) {
  for (Eigen::Vector3d* v : {&proximity.point_on_link, &proximity.point_on_obstacle,
                             &proximity.normal, &proximity.obstacle_velocity}) {
    v->y() = -v->y();
  }
  return proximity;
}

/// A method S, with inputs proximities, links and wish, on a bench.
template <class S>
class MethodBench {
 public:
  explicit MethodBench(const typename S::Params& params, const std::string& name = "planar2",
                       const Eigen::Isometry3d& X_WB = Eigen::Isometry3d::Identity())
      : model_(LoadTestModel(name, X_WB)), bench_(params, Alone(name, model_)) {}

  Eigen::VectorXd Answer(const Eigen::VectorXd& q, const Eigen::VectorXd& wish,
                         const ProximitySet& set) {
    bench_->links.Fix(bench_.context(), PosesOf(*model_, q));
    return Answer(wish, set);
  }
  /// With the arm where it was.
  Eigen::VectorXd Answer(const Eigen::VectorXd& wish, const ProximitySet& set) {
    bench_->wish.Fix(bench_.context(), wish);
    bench_->proximities.Fix(bench_.context(), set);
    return bench_->velocity.Eval(bench_.context());
  }
  double share() { return bench_->share.Eval(bench_.context())[0]; }
  double rows() { return bench_->rows.Eval(bench_.context())[0]; }
  const robot::RobotModel& model() const { return *model_; }
  SystemBench<S>& bench() { return bench_; }

 private:
  static ModelSet Alone(const std::string& name,
                        const std::shared_ptr<const robot::RobotModel>& model) {
    ModelSet set;
    set.Add(name, model);
    return set;
  }
  const std::shared_ptr<const robot::RobotModel> model_;
  SystemBench<S> bench_;
};

/// A bent LWR 4 with three obstacles, the second at `distance`.
inline const Eigen::VectorXd& BentArm() {
  static const Eigen::VectorXd q =
      (Eigen::VectorXd(7) << 0.2, 0.7, -0.3, -1.1, 0.4, 0.6, 0.1).finished();
  return q;
}
inline ProximitySet AroundBentArm(const robot::RobotModel& model, double distance) {
  const LinkPoses poses = PosesOf(model, BentArm());
  const auto at = [&](int link) -> Eigen::Vector3d { return poses.poses[link].translation(); };
  const auto& links = model.links();
  return {{Near(links[4].name.text().data(), at(4), 0.3, Eigen::Vector3d(1, 2, 0.5).normalized()),
           Near(links[5].name.text().data(), at(5), distance, -Eigen::Vector3d::UnitZ()),
           Near(links[7].name.text().data(), at(7), 0.22, Eigen::Vector3d(-1, 1, 1).normalized())}};
}

/// The steepest |change of the answer| over the distance (per m) as an obstacle comes from afar to
/// deep penetration, in steps of 0.1 mm.
template <class S>
double SteepestChange(const typename S::Params& params) {
  MethodBench<S> method(params, "lwr4");
  const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -0.5, 0.7);
  constexpr double kStep = 1e-4;
  double steepest = 0.0;
  Eigen::VectorXd last = method.Answer(BentArm(), wish, AroundBentArm(method.model(), 0.6));
  for (int i = 1; i < 8000; ++i) {
    const Eigen::VectorXd u = method.Answer(wish, AroundBentArm(method.model(), 0.6 - i * kStep));
    steepest = std::max(steepest, (u - last).norm() / kStep);
    last = u;
  }
  return steepest;
}

}  // namespace oca::systems
