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
constexpr double kOnTightPlan = 0.001;    // rad, m; where it passes nearer than kTight
constexpr double kTight = 0.01;           // m
constexpr double kOffFor = 0.3;           // s; off its band, after which an arm has left it
constexpr double kMoreTime = 1.25;        // times what a plan took that was late, for the next
constexpr double kSameTime = 1e-9;        // s
constexpr double kHorizonKept = 0.5;      // of the horizon: a plan that ends sooner is made anew

}  // namespace

BandReplanner::BandReplanner(std::shared_ptr<const robot::RobotModel> model,
                             const ReplanSettings& settings)
    : model_(std::move(model)),
      settings_(settings),
      reach_(ReachBallOf(*model_)),
      arm_(model_, settings.self_collision) {
  arm_.covers();  // all plans share them
}

double BandReplanner::Since(double time, const BandMemory& memory) const {
  return std::clamp(time - memory.seen_at, 0.0, settings_.prediction);
}

void BandReplanner::TellClear(const BandSituation& now, const BandSituation::Positions& planned,
                              const BandMemory& memory, robot::ClearMotion& motion) const {
  motion.clear_for = motion.standing_for = 0.0;
  motion.own_links = settings_.self_collision;
  motion.bodies.clear();
  motion.standing.clear();
  for (const geometry::Obstacle& seen : memory.seen) motion.bodies.push_back(seen.body->id);
  if (now.request != memory.request || memory.report.plans == 0) return;
  const double off = (now.measured - planned).cwiseAbs().maxCoeff();
  if (!(off <= kOnPlan)) return;
  const bool next = !memory.next.empty() && now.time >= memory.report.change;
  const BandTrust& until = next ? memory.next_until : memory.held_until;
  const auto left = [&](double time) {
    return std::clamp(time - now.time, 0.0, settings_.planner.most_horizon);
  };
  const bool sure = now.time >= memory.sure_from;
  const bool tight = memory.report.kept < kTight;
  if (!tight || off <= kOnTightPlan) {
    FindStill(memory.seen, now.obstacles, motion.standing);
    if (!sure) {  // the band was not made for what is new
      std::erase_if(motion.standing, [&](models::Name name) {
        return std::find(memory.still.begin(), memory.still.end(), name) == memory.still.end();
      });
    }
    motion.standing_for = left(until.standing);
  }
  if (sure && AsForeseen({memory.seen, memory.seen_estimates}, {now.obstacles, now.estimates},
                         Since(now.time, memory))) {
    motion.clear_for = left(until.all);
  }
}

bool BandReplanner::Astray(const BandSituation& now, BandMemory& memory) const {
  memory.planned.resize(now.measured.size());
  now.request->Evaluate(now.time, 0, memory.planned);
  memory.At(now.time).Add(now.time, 0, memory.planned);
  const double off = (now.measured - memory.planned).cwiseAbs().maxCoeff();
  if (off <= kOnPlan || memory.report.plans == 0) memory.off_since = now.time;
  // A filter that keeps the arm off a band which passes nearer than it allows would keep it for
  // ever.
  const bool rest = std::all_of(now.obstacles.begin(), now.obstacles.end(), Stands);
  return off > settings_.restart_distance || (rest && now.time - memory.off_since > kOffFor);
}

bool BandReplanner::Covers(const BandSituation& now, const BandMemory& memory) const {
  const double end = memory.next.empty() ? now.time : memory.next.end();
  return end >= now.request->times().back() ||
         end - now.time >= kHorizonKept * settings_.planner.most_horizon;
}

bool BandReplanner::Kept(const BandSituation& now, BandMemory& memory) const {
  if (now.obstacles.empty() && !settings_.self_collision && memory.held.empty() &&
      memory.next.empty()) {
    return true;
  }
  return (memory.report.plans >= kFreshPlans ||
          (memory.report.plans > 0 && memory.report.start == BandStart::kRequest)) &&
         memory.report.clear && memory.report.reaches &&
         memory.search.state() != PathSearch::State::kSearching && now.request == memory.request &&
         Covers(now, memory) && SameStanding(memory.seen, now.obstacles, now.estimates) &&
         !Astray(now, memory);
}

void BandReplanner::Follow(const BandSituation& now, BandMemory& memory) const {
  const double away = (now.measured - now.request->goal()).cwiseAbs().maxCoeff();
  const bool leads = memory.report.plans > 0 && memory.report.clear && memory.report.reaches &&
                     memory.report.block == BandBlock::kNone && !memory.next.empty() &&
                     now.time < memory.next.end();
  if (memory.followed != now.request || now.time < now.request->times().back() || leads ||
      away < memory.nearest_away - settings_.stuck_motion) {
    memory.nearest_away = away;
    memory.moved = now.time;
    memory.followed = now.request;
  }
  memory.report.stuck = away > kArrived && now.time - memory.moved >= settings_.stuck_time;
}

void BandReplanner::Forget(const BandSituation& now, BandMemory& memory) const {
  if (memory.report.plans > 0 && now.request == memory.request) {
    // What comes opens no way to a goal that the arm rests before.
    const bool rests = memory.rest.size() > 0;
    if (rests ? AllStay(memory.seen, now.obstacles, reach_)
              : SameRest(memory.seen, now.obstacles, reach_)) {
      return;
    }
  }
  memory.search.Reset();
  memory.rest.resize(0);
  memory.report.Unblock();
}

VectorXd BandReplanner::EndFor(const BandSituation& now, const BandMemory& memory) const {
  const VectorXd goal = now.request->goal();
  const VectorXd end =
      memory.rest.size() > 0
          ? memory.rest
          : VectorXd(goal.cwiseMax(model_->lower_limits()).cwiseMin(model_->upper_limits()));
  if ((end - goal).cwiseAbs().maxCoeff() == 0.0) return {};
  return end - goal;
}

void BandReplanner::GiveWay(const BandSituation& now, const BandPlan& found,
                            BandMemory& memory) const {
  const VectorXd goal = now.request->goal();
  Eigen::Index joint = 0;
  const double beyond =
      (goal - model_->upper_limits()).cwiseMax(model_->lower_limits() - goal).maxCoeff(&joint);
  const bool leads = found.check.clear() && found.reaches;
  const bool failed = memory.search.state() == PathSearch::State::kExhausted && !leads;
  if (failed && memory.rest.size() > 0) {  // even to there the way is lost: look again
    memory.search.Reset();
    memory.rest.resize(0);
  } else if (leads && memory.rest.size() == 0) {
    memory.report.Unblock();
  } else if (failed) {
    memory.rest = memory.search.nearest();
    memory.search.AimAtNearest();
    const bool contact = found.goal_room <= 0.0;
    memory.report.block = contact ? BandBlock::kContact : BandBlock::kWay;
    memory.report.block_link = contact ? found.goal_link : found.rest_link;
    memory.report.block_body = contact ? found.goal_body : found.rest_body;
    memory.report.block_amount = contact ? -found.goal_room : found.rest_room;
  }
  if (beyond > 0.0 && memory.report.block == BandBlock::kNone) {
    memory.report.block = BandBlock::kLimit;
    memory.report.block_link = model_->position_names()[static_cast<std::size_t>(joint)];
    memory.report.block_body = {};
    memory.report.block_amount = beyond;
  }
}

BandTask BandReplanner::MakeTask(const BandSituation& now, double start,
                                 std::span<const BandBody> bodies,
                                 const std::optional<BandSituation::Positions>& rate,
                                 BandMemory& memory) const {
  BandTask task;
  task.start = start;
  const double until = start - now.time;
  task.most_time = settings_.plan_budget > 0.0 ? std::min(until, settings_.plan_budget) : until;
  task.request = [request = now.request.get()](double t, int derivative, Eigen::Ref<VectorXd> out) {
    request->Evaluate(t, derivative, out);
  };
  task.request_end = now.request->times().back();
  task.bodies = bodies;
  task.end = EndFor(now, memory);
  task.path_search = &memory.search;
  task.seed = settings_.seed + memory.report.plans;
  for (int d = 0; d < 3; ++d) {
    task.deviation[d].setZero(now.measured.size());
    if (!memory.held.empty()) memory.held.Evaluate(task.start, d, task.deviation[d]);
  }
  if (Astray(now, memory)) {
    const VectorXd v = rate ? VectorXd(*rate) : VectorXd::Zero(now.measured.size());
    task.deviation[0] = now.measured + until * v;
    task.deviation[0] -= now.request->Evaluate(task.start, 0);
    task.deviation[1] = v - now.request->Evaluate(task.start, 1);
    task.deviation[2].setZero();
  }
  const int pause = std::min(memory.failures, kMostPause);
  task.plans_before = memory.report.plans;
  task.fresh = memory.report.plans < kFreshPlans;
  task.explore =
      Moves(bodies) || pause < 3 || memory.report.plans % static_cast<std::uint64_t>(pause) == 0;
  return task;
}

double BandReplanner::TimeToPlan(const BandMemory& memory) const {
  return std::max(settings_.plan_time, memory.lead);
}

void BandReplanner::Plan(const BandSituation& now, double start,
                         const std::optional<BandSituation::Positions>& rate,
                         BandMemory& memory) const {
  if (now.time < memory.busy_until - kSameTime || Kept(now, memory)) return;
  BandMemory made = memory;
  MakePlan(now, start, rate, made);
  if (made.report.charged <= start - now.time + kSameTime) {
    memory = std::move(made);
    memory.lead = 0.0;
    memory.busy_until = start;
    return;
  }
  memory.report.work = made.report.work;
  memory.report.charged = made.report.charged;
  memory.busy_until = now.time + made.report.charged;
  memory.lead = kMoreTime * std::max(made.report.charged, memory.lead);
  ++memory.report.overruns;
}

void BandReplanner::Note(const BandPlan& found, BandMemory& memory) const {
  memory.report.plans += 1;
  memory.report.start = found.start;
  memory.report.clear = found.check.clear();
  memory.report.reaches = found.reaches;
  memory.report.level = found.level;
  memory.report.kept = std::min(found.check.kept, found.goal_room);
  memory.report.goal_room = found.goal_room;
  memory.report.lack = found.lack;
  memory.failures = memory.report.clear && memory.report.reaches ? 0 : memory.failures + 1;
  memory.report.nearest = found.check.min_distance;
  memory.report.distance = found.check.distance;
  memory.report.link = found.check.link;
  memory.report.obstacle = found.check.body;
  memory.report.time = found.check.time;
  const double hard = settings_.planner.band.hard_distance;
  if (memory.report.clear && memory.report.lack != BandLack::kNone &&
      memory.report.distance < hard) {
    memory.report.tight = true;
  } else if (memory.report.distance >= 2.0 * hard) {
    memory.report.tight = false;
  }
  memory.report.cost = found.cost;
  memory.report.work = found.work;
  memory.report.charged = settings_.planner.prices.Of(found.work);
}

void BandReplanner::MakePlan(const BandSituation& now, double start,
                             const std::optional<BandSituation::Positions>& rate,
                             BandMemory& memory) const {
  const bool foreseen = memory.report.plans > 0 && now.request == memory.request &&
                        AsForeseen({memory.seen, memory.seen_estimates},
                                   {now.obstacles, now.estimates}, Since(now.time, memory)) &&
                        !Astray(now, memory);
  if (!foreseen) FindStill(memory.seen, now.obstacles, memory.still);
  if (now.request != memory.request) memory.still.clear();
  Forget(now, memory);
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
  BandPlanner planner(arm_, settings_.planner, memory.own);
  IgnoreOwnLinks(now, planner);
  BandPlan found = planner.Plan(task, memory.held.empty() ? nullptr : &memory.held);
  memory.next = std::move(found.curve);
  memory.report.change = task.start;
  const BandCheck& check = found.check;
  memory.next_until = {check.touch(), std::min(check.clear() ? check.touch_hard : check.touch_trust,
                                               check.touch_limits)};
  if (Moves(bodies) || memory.next.end() < task.request_end) {  // nothing is known beyond
    memory.next_until.all = std::min(memory.next_until.all, memory.next.end());
    memory.next_until.standing = std::min(memory.next_until.standing, memory.next.end());
  }
  if (!foreseen) memory.sure_from = task.start;
  memory.request = now.request;
  memory.seen_at = now.time;
  memory.seen = now.obstacles;
  memory.seen_estimates = std::move(estimates);
  Note(found, memory);
  GiveWay(now, found, memory);
}

}  // namespace oca::planning
