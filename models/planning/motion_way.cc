// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/motion_way.h"

#include <cmath>

namespace oca::planning {

MotionWay WayOf(const ClairvoyantTask& task, const BandCurve& curve, Eigen::Index size,
                double arrived) {
  constexpr double kStep = 0.01;  // s
  const auto at = [&](double time) {
    Eigen::VectorXd q(size);
    task.request(time, 0, q);
    if (!curve.empty()) curve.Add(time, 0, q);
    return q;
  };
  Eigen::VectorXd goal(size);
  task.request(task.duration, 0, goal);
  MotionWay way;
  Eigen::VectorXd last = at(0.0);
  const int steps = static_cast<int>(std::lround(task.duration / kStep));
  for (int k = 0; k <= steps; ++k) {
    const double time = k == steps ? task.duration : kStep * k;
    const Eigen::VectorXd q = at(time);
    way.length += (q - last).norm();
    last = q;
    const bool there = (q - goal).cwiseAbs().maxCoeff() <= arrived;
    way.time = !there ? std::nullopt : way.time ? way.time : std::optional(time);
  }
  return way;
}

}  // namespace oca::planning
