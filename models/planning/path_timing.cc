// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/path_timing.h"

#include <algorithm>
#include <cmath>

namespace oca::planning {
namespace {

using Eigen::VectorXd;

constexpr double kPathSpeed = 2.0;  // rad/s, in the 2-norm

/// The largest share of a limit; nothing moves where a limit is 0, which then is none.
double MostOf(const VectorXd& values, const VectorXd& limits) {
  double most = 0.0;
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    if (values[j] > 0.0 && limits[j] > 0.0) most = std::max(most, values[j] / limits[j]);
  }
  return most;
}

}  // namespace

std::vector<double> TimesAlong(const robot::RobotModel& model, const std::vector<VectorXd>& path) {
  std::vector<double> times{0.0};
  for (std::size_t k = 1; k < path.size(); ++k) {
    const VectorXd way = (path[k] - path[k - 1]).cwiseAbs();
    const double least = MostOf(way, model.velocity_limits());
    times.push_back(times.back() + std::max(least, way.norm() / kPathSpeed));
  }
  return times;
}

double DurationAlong(const robot::RobotModel& model, const std::vector<VectorXd>& path,
                     double limit_share) {
  VectorXd way = VectorXd::Zero(path.front().size());
  for (std::size_t k = 1; k < path.size(); ++k) way += (path[k] - path[k - 1]).cwiseAbs();
  const double bend = MostOf(way, model.acceleration_limits());
  return std::max(kStepSlope * TimesAlong(model, path).back(), std::sqrt(kStepBend * bend)) /
         limit_share;
}

VectorXd WayWithin(const robot::RobotModel& model, double duration, double limit_share) {
  const double time = limit_share * duration;
  return (model.velocity_limits() * (time / kStepSlope))
      .cwiseMin(model.acceleration_limits() * (time * time / kStepBend));
}

}  // namespace oca::planning
