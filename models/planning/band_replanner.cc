// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_replanner.h"

#include <algorithm>
#include <utility>

#include "oca/models/planning/obstacle_prediction.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

constexpr double kArrived = 0.01;         // rad, m; of all joints
constexpr double kOnPlan = 0.005;         // rad, m; of the arm
constexpr std::uint64_t kFreshPlans = 8;  // that look for a better way though theirs is clear
constexpr int kMostPause = 20;            // plans between two searches that fail

}  // namespace

BandReplanner::BandReplanner(std::shared_ptr<const robot::RobotModel> model,
                             const ReplanSettings& settings)
    : model_(std::move(model)), settings_(settings) {}

double BandReplanner::Since(double time, const BandMemory& memory) const {
  return std::clamp(time - memory.seen_at, 0.0, settings_.prediction);
}

void BandReplanner::TellClear(const BandSituation& now, const BandSituation::Positions& planned,
                              const BandMemory& memory, robot::ClearMotion& motion) const {
  motion.clear_for = 0.0;
  motion.own_links = settings_.self_collision;
  motion.bodies.clear();
  for (const geometry::Obstacle& seen : memory.seen) motion.bodies.push_back(seen.body->id);
  if (now.request != memory.request) return;
  const bool followed = (now.measured - planned).cwiseAbs().maxCoeff() <= kOnPlan;
  if (memory.plans == 0 || now.time < memory.sure_from || !followed ||
      !AsForeseen({memory.seen, memory.seen_estimates}, {now.obstacles, now.estimates},
                  Since(now.time, memory))) {
    return;
  }
  const bool next = !memory.next.empty() && now.time >= memory.change;
  const double until = next ? memory.next_until : memory.held_until;
  motion.clear_for = std::clamp(until - now.time, 0.0, settings_.planner.most_horizon);
}

std::vector<BandBody> BandReplanner::MakeBodies(const BandSituation& now,
                                                Estimates estimates) const {
  std::vector<BandBody> bodies;
  for (const geometry::Obstacle& obstacle : now.obstacles) {
    const bool stands = Stands(obstacle) || settings_.prediction == 0.0;
    const auto pose = [obstacle, time = now.time, longest = settings_.prediction,
                       stands](double t) {
      return stands ? obstacle.X_WO : Foreseen(obstacle, std::clamp(t - time, 0.0, longest));
    };
    bodies.push_back({obstacle.body->id, obstacle.body->collider, pose, stands});
    if (estimates.empty()) continue;
    Estimate(now.time, obstacle, estimates[bodies.size() - 1], bodies.back());
  }
  return bodies;
}

void BandReplanner::Estimate(double time, const geometry::Obstacle& obstacle,
                             const geometry::ObstacleEstimate& estimate, BandBody& body) const {
  const auto ahead = [time, longest = settings_.prediction](double t) {
    return std::clamp(t - time, 0.0, longest);
  };
  if (!estimate.covariance.isZero(0.0)) {
    body.covariance = [estimate, ahead, stands = body.stands](double t) -> Eigen::Matrix3d {
      return CovarianceAhead(estimate, stands ? 0.0 : ahead(t));
    };
  }
  if (body.stands) return;
  body.pose = [obstacle, estimate, ahead](double t) {
    return LikelyAhead(obstacle, estimate, ahead(t)).X_WO;
  };
}

bool BandReplanner::Astray(const BandSituation& now, BandMemory& memory) const {
  memory.planned.resize(now.measured.size());
  now.request->Evaluate(now.time, 0, memory.planned);
  memory.At(now.time).Add(now.time, 0, memory.planned);
  return (now.measured - memory.planned).cwiseAbs().maxCoeff() > settings_.restart_distance;
}

bool BandReplanner::Kept(const BandSituation& now, BandMemory& memory) const {
  if (now.obstacles.empty() && !settings_.self_collision && memory.held.empty() &&
      memory.next.empty()) {
    return true;
  }
  return (memory.plans >= kFreshPlans ||
          (memory.plans > 0 && memory.start == BandStart::kRequest)) &&
         memory.clear && now.request == memory.request &&
         SameStanding(memory.seen, now.obstacles, now.estimates) && !Astray(now, memory);
}

void BandReplanner::Follow(const BandSituation& now, BandMemory& memory) const {
  if (memory.resting.size() != now.measured.size() ||
      (now.measured - memory.resting).cwiseAbs().maxCoeff() > settings_.stuck_motion ||
      now.time < now.request->times().back()) {
    memory.resting = now.measured;
    memory.moved = now.time;
  }
  const double away = (now.measured - now.request->goal()).cwiseAbs().maxCoeff();
  memory.stuck = away > kArrived && now.time - memory.moved >= settings_.stuck_time;
}

BandTask BandReplanner::MakeTask(const BandSituation& now, double start,
                                 std::span<const BandBody> bodies,
                                 const std::optional<BandSituation::Positions>& rate,
                                 BandMemory& memory) const {
  BandTask task;
  task.start = start;
  task.request = [request = now.request.get()](double t, int derivative, Eigen::Ref<VectorXd> out) {
    request->Evaluate(t, derivative, out);
  };
  task.request_end = now.request->times().back();
  task.bodies = bodies;
  task.seed = settings_.seed + memory.plans;
  for (int d = 0; d < 3; ++d) {
    task.deviation[d].setZero(now.measured.size());
    if (!memory.held.empty()) memory.held.Evaluate(task.start, d, task.deviation[d]);
  }
  if (Astray(now, memory)) {
    const VectorXd v = rate ? VectorXd(*rate) : VectorXd::Zero(now.measured.size());
    task.deviation[0] = now.measured + settings_.period * v;
    task.deviation[0] -= now.request->Evaluate(task.start, 0);
    task.deviation[1] = v - now.request->Evaluate(task.start, 1);
    task.deviation[2].setZero();
  }
  const int pause = std::min(memory.failures, kMostPause);
  task.search = memory.plans;
  task.fresh = memory.plans < kFreshPlans;
  task.explore =
      Moves(bodies) || pause < 3 || memory.plans % static_cast<std::uint64_t>(pause) == 0;
  return task;
}

void BandReplanner::Plan(const BandSituation& now, double start,
                         const std::optional<BandSituation::Positions>& rate,
                         BandMemory& memory) const {
  if (Kept(now, memory)) return;
  const bool foreseen = memory.plans > 0 && now.request == memory.request &&
                        AsForeseen({memory.seen, memory.seen_estimates},
                                   {now.obstacles, now.estimates}, Since(now.time, memory)) &&
                        !Astray(now, memory);
  if (!memory.next.empty()) {
    memory.held = memory.next;
    memory.held_until = memory.next_until;
  }
  std::vector<geometry::ObstacleEstimate> estimates(now.estimates.begin(), now.estimates.end());
  if (estimates.empty()) {
    estimates =
        Accelerations(memory.seen, now.obstacles, now.time - memory.seen_at, memory.changes);
  }
  const std::vector<BandBody> bodies = MakeBodies(now, estimates);
  const BandTask task = MakeTask(now, start, bodies, rate, memory);
  if (settings_.self_collision && now.request != memory.request) {
    memory.own = robot::OwnRangesAlong(model_, now.request.get(), settings_.self_distance);
  }
  BandPlanner planner(model_, settings_.planner, settings_.self_collision, memory.own);
  BandPlan found = planner.Plan(task, memory.held.empty() ? nullptr : &memory.held);
  memory.next = std::move(found.curve);
  memory.change = task.start;
  memory.next_until = found.check.touch;
  if (Moves(bodies)) memory.next_until = std::min(memory.next_until, memory.next.end());
  if (!foreseen) memory.sure_from = task.start;
  memory.request = now.request;
  memory.seen_at = now.time;
  memory.seen = now.obstacles;
  memory.seen_estimates = std::move(estimates);
  memory.plans += 1;
  memory.start = found.start;
  memory.clear = found.check.clear();
  memory.failures = memory.clear ? 0 : memory.failures + 1;
  memory.nearest = found.check.min_distance;
  memory.distance = found.check.distance;
  memory.link = found.check.link;
  memory.obstacle = found.check.body;
  memory.time = found.check.time;
  memory.cost = found.cost;
  memory.evaluations = static_cast<std::uint64_t>(found.evaluations);
}

}  // namespace oca::planning
