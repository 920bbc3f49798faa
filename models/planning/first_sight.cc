// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/first_sight.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "oca/models/robot/clearance.h"
#include "oca/models/robot/travel_bound.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

constexpr double kTick = 0.01;   // s
constexpr double kAfter = 2.0;   // s; later any arm can have gone far
constexpr double kMoved = 1e-9;  // m

/// The last tick at which all that moves is where it was at time 0.
std::optional<double> TimeOfFirstSight(const ClairvoyantTask& task) {
  std::vector<Eigen::Isometry3d> first;
  for (const BandBody& body : task.bodies) first.push_back(body.pose(0.0));
  const auto ticks = static_cast<long>(std::floor(task.duration / kTick));
  for (long k = 1; k <= ticks; ++k) {
    const double time = static_cast<double>(k) * kTick;
    for (std::size_t b = 0; b < first.size(); ++b) {
      if (task.bodies[b].stands) continue;
      const Eigen::Isometry3d now = task.bodies[b].pose(time);
      if ((now.matrix() - first[b].matrix()).cwiseAbs().maxCoeff() > kMoved) return time - kTick;
    }
  }
  return std::nullopt;
}

/// How far a joint gets in a direction within its limits, from a speed in that direction.
double Farthest(double speed, double most, double acceleration, double time) {
  if (!std::isfinite(acceleration)) return most * time;
  const double faster = std::max(most - speed, 0.0) / acceleration;
  if (time <= faster) return speed * time + 0.5 * acceleration * time * time;
  return speed * faster + 0.5 * acceleration * faster * faster +
         std::max(most, speed) * (time - faster);
}

/// d_j(t).
void FillPaths(const robot::RobotModel& model, const VectorXd& q, const VectorXd& v,
               const VectorXd& request, double time, VectorXd& paths) {
  for (Eigen::Index j = 0; j < q.size(); ++j) {
    const double most = model.velocity_limits()[j];
    const double acceleration = model.acceleration_limits()[j];
    const double up = q[j] + Farthest(v[j], most, acceleration, time) - request[j];
    const double down = request[j] - q[j] + Farthest(-v[j], most, acceleration, time);
    paths[j] = std::max({up, down, 0.0});
  }
}

}  // namespace

FirstSight LookAtFirstSight(const std::shared_ptr<const robot::RobotModel>& model,
                            const ClairvoyantTask& task) {
  FirstSight sight;
  sight.time = TimeOfFirstSight(task);
  if (!sight.time) return sight;
  std::vector<robot::PlacedBody> placed;
  for (const BandBody& body : task.bodies) placed.push_back(body.At(*sight.time));
  robot::Clearance clearance(model, false, std::move(placed));
  for (const auto& [link, body] : task.ignored) clearance.Ignore(link, body);
  const robot::TravelBound bound(*model);
  const Eigen::Index n = model->num_positions();
  VectorXd q(n), v(n), request(n), paths(n);
  task.request(*sight.time, 0, q);
  task.request(*sight.time, 1, v);
  std::vector<double> travel(static_cast<std::size_t>(model->num_links()));
  std::vector<robot::NearPair> pairs;
  const double end = std::min(task.duration, *sight.time + kAfter);
  const auto ticks = static_cast<long>(std::floor((end - *sight.time) / kTick));
  for (long k = 0; k <= ticks; ++k) {
    const double time = *sight.time + static_cast<double>(k) * kTick;
    task.request(time, 0, request);
    clearance.MoveTo(request);
    for (std::size_t b = 0; b < task.bodies.size(); ++b) {
      clearance.MoveBody(static_cast<int>(b), task.bodies[b].pose(time));
    }
    clearance.Collect(0.0, pairs);
    if (pairs.empty()) continue;
    FillPaths(*model, q, v, request, time - *sight.time, paths);
    if (!paths.allFinite()) break;
    bound.Calc(clearance.X_WL(), paths, travel);
    for (const robot::NearPair& pair : pairs) {
      const double reach = travel[static_cast<std::size_t>(pair.link)];
      if (sight.too_late || !(reach < -pair.distance)) continue;
      sight = {sight.time,
               true,
               time,
               -pair.distance,
               reach,
               model->links()[pair.link].name,
               task.bodies[static_cast<std::size_t>(pair.body)].name};
    }
    if (sight.too_late) break;
  }
  return sight;
}

}  // namespace oca::planning
