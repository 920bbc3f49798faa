// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include "oca/models/robot/avoidance_velocity.h"
#include "oca/models/robot/inverse_kinematics.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/models/robot/urdf.h"

namespace oca::robot::test {

// Arms and what is near them, for laws that choose joint velocities.

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

/// A bent LWR 4 with three obstacles, the second at `distance`.
inline const Eigen::VectorXd& BentArm() {
  static const Eigen::VectorXd q =
      (Eigen::VectorXd(7) << 0.2, 0.7, -0.3, -1.1, 0.4, 0.6, 0.1).finished();
  return q;
}
inline ProximitySet AroundBentArm(const RobotModel& model, double distance) {
  const auto X_WL = LinkPoses(model, BentArm());
  const auto at = [&](int link) -> Eigen::Vector3d { return X_WL[link].translation(); };
  const auto& links = model.links();
  return {{Near(links[4].name.text().data(), at(4), 0.3, Eigen::Vector3d(1, 2, 0.5).normalized()),
           Near(links[5].name.text().data(), at(5), distance, -Eigen::Vector3d::UnitZ()),
           Near(links[7].name.text().data(), at(7), 0.22, Eigen::Vector3d(-1, 1, 1).normalized())}};
}

/// An arm of the product that a law moves.
template <class Law>
class LawBench {
 public:
  explicit LawBench(const Law& law, const std::string& name = "planar2",
                    const Eigen::Isometry3d& X_WB = Eigen::Isometry3d::Identity())
      : law_(law), model_(Load(name, X_WB)) {
    law_.tip = TipLink(model_);
  }

  Eigen::VectorXd Answer(const Eigen::VectorXd& q, const Eigen::VectorXd& wish,
                         const ProximitySet& set) {
    law_.Choose(model_, set, LinkPoses(model_, q), wish, result_);
    return result_.velocity;
  }
  /// Of the last answer.
  const AvoidanceVelocity& result() const { return result_; }
  const RobotModel& model() const { return model_; }

 private:
  static RobotModel Load(const std::string& name, const Eigen::Isometry3d& X_WB) {
    LoadOptions options;
    options.X_WB = X_WB;
    return LoadUrdf(OCA_SOURCE_DIR "/models/robots/" + name + "/" + name + ".urdf", options);
  }
  Law law_;
  const RobotModel model_;
  AvoidanceVelocity result_;
};

/// The steepest |change of the answer| over the distance (per m) as an obstacle comes from afar to
/// deep penetration, in steps of 0.1 mm.
template <class Law>
double SteepestChange(const Law& law) {
  LawBench<Law> bench(law, "lwr4");
  const Eigen::VectorXd wish = Eigen::VectorXd::LinSpaced(7, -0.5, 0.7);
  constexpr double kStep = 1e-4;
  double steepest = 0.0;
  Eigen::VectorXd last = bench.Answer(BentArm(), wish, AroundBentArm(bench.model(), 0.6));
  for (int i = 1; i < 8000; ++i) {
    const Eigen::VectorXd u =
        bench.Answer(BentArm(), wish, AroundBentArm(bench.model(), 0.6 - i * kStep));
    steepest = std::max(steepest, (u - last).norm() / kStep);
    last = u;
  }
  return steepest;
}

}  // namespace oca::robot::test
