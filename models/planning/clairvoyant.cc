// SPDX-License-Identifier: BSD-3-Clause
#include "models/planning/clairvoyant.h"

#include <algorithm>
#include <cmath>

namespace oca::models {
namespace {

using Eigen::VectorXd;

constexpr double kGrid = 1e-3;  // s

BandPlannerSettings Settings(const ClairvoyantTask& task) {
  BandPlannerSettings settings;
  settings.band.margin = kClairvoyantReach;
  settings.band.clear_distance = 0.015;
  settings.band.clearance = 1e5;
  settings.band.limit_share = 0.97;
  settings.band.limits = 1e4;
  settings.iterations = 80;
  settings.start_iterations = 80;
  settings.relaxed_starts = task.starts;
  settings.random_starts = 4 * task.starts;
  settings.paths = 6;
  settings.path_nodes = 5000;
  settings.least_horizon = task.duration;
  settings.most_horizon = task.duration;
  settings.fine_span = task.duration;
  return settings;
}

double LargestShare(const VectorXd& x, const VectorXd& limits) {
  double share = 0.0;
  for (Eigen::Index j = 0; j < x.size(); ++j) share = std::max(share, std::fabs(x[j]) / limits[j]);
  return share;
}

/// Fills in what is true of the curve between the points that it was planned with.
void Judge(const RobotModel& model, ElasticBand& band, const ClairvoyantTask& task,
           ClairvoyantPlan& plan) {
  plan.min_distance = kClairvoyantReach;
  VectorXd motion[3], request(model.num_positions());
  for (int k = 0; k * kGrid <= task.duration; ++k) {
    const double time = k * kGrid;
    for (int d = 0; d < 3; ++d) {
      motion[d].resize(model.num_positions());
      plan.curve.Evaluate(time, d, motion[d]);
      task.request(time, d, request);
      motion[d] += request;
    }
    plan.min_distance = std::min(plan.min_distance, band.Distance(motion[0], time));
    plan.speed = std::max(plan.speed, LargestShare(motion[1], model.velocity_limits()));
    plan.acceleration =
        std::max(plan.acceleration, LargestShare(motion[2], model.acceleration_limits()));
  }
  constexpr double kRounding = 1.0 + 1e-9;
  plan.clear = plan.min_distance > 0.0 && plan.speed <= kRounding && plan.acceleration <= kRounding;
}

}  // namespace

ClairvoyantPlan PlanClairvoyantly(const std::shared_ptr<const RobotModel>& model,
                                  const ClairvoyantTask& task) {
  const BandPlannerSettings settings = Settings(task);
  BandPlanner planner(model, settings);
  BandTask band_task;
  for (VectorXd& x : band_task.deviation) x.setZero(model->num_positions());
  band_task.request = task.request;
  band_task.request_end = task.request_end;
  band_task.bodies = task.bodies;
  band_task.seed = task.seed;
  BandPlan found = planner.Plan(band_task, nullptr);
  ClairvoyantPlan plan{.start = found.start, .curve = std::move(found.curve)};
  ElasticBand band(model, settings.band);
  band.Prepare(plan.curve, task.request, task.bodies, true);
  Judge(*model, band, task, plan);
  return plan;
}

}  // namespace oca::models
