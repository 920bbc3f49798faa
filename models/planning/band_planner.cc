// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_planner.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "oca/models/planning/band_certificate.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

// Intervals of a band, s.
constexpr double kFine = 0.1;  // of the first fine_span while something moves or the arm returns
constexpr double kGrowth = 1.3;
constexpr double kCoarse = 0.4;
constexpr int kFewest = 8;
constexpr std::size_t kMostGrowing = 10;  // intervals from kFine to kCoarse, and a few

constexpr double kSameRoom = 1e-4;      // m; of the goal and of a band that comes no nearer
constexpr double kNotCertified = 1e-6;  // m s; what a band lacks that is not proved
constexpr double kEvadeAhead = 1.5;     // s; before what stands a band begins to bend
constexpr double kAtRest = 1e-9;
constexpr double kTurnTime = 0.35;  // s; for which what flies away may come back as fast

}  // namespace

BandPlanner::BandPlanner(const robot::Clearance& arm, const BandPlannerSettings& settings,
                         const robot::OwnRanges& own)
    : settings_(settings),
      band_(arm, settings.band, own),
      own_(own),
      standing_(std::make_unique<robot::Clearance>(arm)) {
  standing_->KeepOwn(own, settings.band.clear_distance);
}

double BandPlanner::HorizonOf(const BandTask& task, bool moving) const {
  double horizon =
      std::max(task.request_end + settings_.tail - task.start, settings_.least_horizon);
  if (moving) horizon = std::min(horizon, settings_.moving_horizon);
  for (Eigen::Index j = 0; j < task.deviation[0].size(); ++j) {
    const double speed = settings_.band.limit_share * model().velocity_limits()[j];
    horizon = std::max(horizon, 2.5 * std::fabs(task.deviation[0][j]) / speed);
  }
  return std::min(horizon, settings_.most_horizon);
}

PlanWork BandPlanner::Work() const {
  return {1, band_.exact_looks() - begun_.exact, certified_looks_,
          band_.batches() - begun_.batches + path_looks_};
}

long BandPlanner::LooksLeft(double price, long most) const {
  const double left = most_time_ - settings_.prices.Of(Work());
  if (left >= price * static_cast<double>(most)) return most;
  return std::max(static_cast<long>(left / price), 0L);
}

int BandPlanner::StepsLeft(int wanted) const {
  constexpr long kUnbounded = 1'000'000'000;
  const PlanWork work = Work();
  const long evaluations = band_.evaluations() - begun_.evaluations;
  const long left =
      LooksLeft(settings_.prices.band, settings_.most_evaluations == 0
                                           ? kUnbounded
                                           : settings_.most_evaluations - evaluations - work.exact);
  // A start costs its look at the finer grid of Check too.
  return static_cast<int>(std::clamp<long>(left / band_.num_samples() - 3, 0, wanted));
}

std::vector<double> BandPlanner::TimesOf(const BandTask& task, const Grid& grid) const {
  const bool moving = Moves(task.bodies);
  const double horizon =
      std::min(std::max(HorizonOf(task, moving), grid.least_horizon), settings_.most_horizon);
  std::vector<double> times{task.start};
  double step = kFine;
  // Even where the start is so late that a step does not show.
  const auto most = static_cast<std::size_t>(settings_.fine_span / kFine) + kMostGrowing;
  const bool fine = moving || grid.returns;
  while (fine && times.back() - task.start + step < horizon && step < kCoarse &&
         times.size() < most) {
    times.push_back(times.back() + step);
    if (times.back() - task.start > settings_.fine_span) step *= kGrowth;
  }
  const double rest = task.start + horizon - times.back();
  const int count = std::max(fine ? 1 : kFewest, static_cast<int>(std::ceil(rest / grid.interval)));
  const double from = times.back();
  for (int i = 1; i <= count; ++i) times.push_back(from + i * rest / count);
  return times;
}

BandPlanner::Grid BandPlanner::GridOf(const BandTask& task, const BandCurve* last, bool moving) {
  Grid grid{0.0, kCoarse};
  if (last == nullptr || last->empty()) return grid;
  // A way that takes its time, or needs more points, goes on to do so.
  const double left = last->end() - task.start;
  const std::vector<double> times = last->times();
  if (left > 0.0) grid.least_horizon = left;
  if (!moving && left > 0.0) grid.interval = std::min(kCoarse, times.back() - *(times.end() - 2));
  return grid;
}

VectorXd BandPlanner::GoalAt(const BandTask& task, double time) const {
  VectorXd goal(model().num_positions());
  task.request(time, 0, goal);
  if (task.end.size() > 0) goal += task.end;
  return goal;
}

void BandPlanner::LookAtGoal(const BandTask& task, double end) {
  const VectorXd goal = GoalAt(task, end);
  end_room_ = band_.RoomAt(goal, end);
  // Where the request still goes on the band may end elsewhere as well.
  const bool rests = end >= task.request_end;
  const bool clear =
      end_room_.flying >= settings_.band.clear_distance &&
      (rests ? end_room_.standing > 0.0 : end_room_.standing >= settings_.band.clear_distance);
  end_ = clear ? BandEnd::kGoal : BandEnd::kFree;
  band_.FixEnd(clear);
  VectorXd start(goal.size());
  task.request(task.start, 0, start);
  start += task.deviation[0];
  band_.YieldAt(start, clear ? &goal : nullptr);
}

void BandPlanner::Prepare(const BandTask& task, const Grid& grid) {
  zero_ = BandCurve(task.deviation[0].size(), TimesOf(task, grid));
  zero_.StartWith(task.deviation[0], task.deviation[1], task.deviation[2]);
  band_.Prepare(zero_, task.request, task.bodies, true);
  LookAtGoal(task, zero_.end());
  if (end_ == BandEnd::kGoal && task.end.size() > 0)
    zero_.controls().rightCols(3).colwise() = task.end;
}

void BandPlanner::PrepareStanding(const BandTask& task) {
  std::vector<robot::PlacedBody> placed;
  for (const BandBody& body : task.bodies) {
    if (body.stands) placed.push_back(body.At(task.start));
  }
  anything_stands_ = !placed.empty() || !standing_->own_pairs().empty();
  standing_->SetBodies(std::move(placed));
  int place = 0;
  for (const BandBody& body : task.bodies) {
    if (!body.stands) continue;
    for (const int link : body.ignored) standing_->Ignore(link, place);
    ++place;
  }
  standing_->KeepOwn(own_, settings_.band.clear_distance);
}

int BandPlanner::LevelOf(const BandCheck& check) const {
  if (check.wide()) return 0;
  int level = 1;
  for (const double share : kClearShares) {
    if (check.kept >= share * settings_.band.clear_distance) return level;
    ++level;
  }
  return level;
}

void BandPlanner::SetEnd(Start& start) {
  const bool fixed = start.end == BandEnd::kGoal;
  band_.FixEnd(fixed);
  if (fixed) start.curve.controls().rightCols(3) = zero_.controls().rightCols(3);
}

BandPlan BandPlanner::Finish(Start start, int iterations) {
  SetEnd(start);
  BandPlan plan{.curve = std::move(start.curve), .start = start.kind};
  plan.cost = band_.Relax(plan.curve, std::max(StepsLeft(iterations), kFewestSteps));
  Judge(start.end, plan);
  return plan;
}

BandPlan BandPlanner::Unrelaxed(Start start) {
  SetEnd(start);
  BandPlan plan{.curve = std::move(start.curve), .start = start.kind};
  plan.cost = band_.Cost(plan.curve);
  Judge(start.end, plan);
  return plan;
}

void BandPlanner::Judge(BandEnd end, BandPlan& plan) {
  plan.check = band_.Check(plan.curve);
  plan.level = LevelOf(plan.check);
  plan.reaches = end == BandEnd::kGoal;
  plan.goal_room = end_room_.standing;
  plan.goal_link = end_room_.link;
  plan.goal_body = end_room_.body;
  const BandCheck& check = plan.check;
  if (!(check.min_distance < settings_.band.margin)) {
    plan.lack = BandLack::kNone;
  } else if (plan.reaches && check.link == end_room_.link && check.body == end_room_.body &&
             check.distance > end_room_.standing - kSameRoom) {
    plan.lack = BandLack::kGoal;
  } else if (check.time < begin_ + kFine) {
    plan.lack = BandLack::kStart;
  } else {
    plan.lack = check.own_links ? BandLack::kOwnLinks : BandLack::kPassage;
  }
}

void BandPlanner::Certify(const BandTask& task, BandPlan& plan) {
  if (plan.certified || !plan.check.clear()) return;
  plan.certified = true;
  if (!anything_stands_ || plan.check.min_distance >= settings_.band.margin) return;
  BandCertificate certificate(*standing_, settings_.band.hard_distance,
                              settings_.band.clear_distance);
  const double until = certificate.Until(task.request, plan.curve, task.start);
  certified_looks_ += certificate.evaluations();
  if (until == BandCheck::kNever) return;
  plan.certified = false;
  plan.check.touch_hard = std::min(plan.check.touch_hard, until);
  plan.check.breach += kNotCertified;
  if (plan.check.wide()) plan.check.first = plan.check.last = until;
  plan.check.violation += kNotCertified;
}

bool BandPlanner::Better(const BandPlan& plan, const BandPlan& best) const {
  const bool clear = plan.check.clear();
  if (clear != best.check.clear()) return clear;
  if (!clear && plan.check.evades() != best.check.evades()) return plan.check.evades();
  if (!clear) return plan.check.violation < 0.95 * best.check.violation;
  // What stands may set off, where other things move.
  if (moving_ && (plan.level == 0) != (best.level == 0)) return plan.level == 0;
  if (plan.reaches != best.reaches) return plan.reaches;
  if (plan.level != best.level) return plan.level < best.level;
  const auto way = [&](const BandCheck& check) {
    return check.way + kMarginWay * std::max(settings_.band.margin - check.min_distance, 0.0);
  };
  return way(plan.check) < way(best.check);
}

void BandPlanner::Keep(const BandTask& task, BandPlan plan, BandPlan& best) {
  if (!Better(plan, best)) return;
  Certify(task, plan);
  if (Better(plan, best)) best = std::move(plan);
}

BandPlan BandPlanner::Plan(const BandTask& task, const BandCurve* last) {
  begun_ = {band_.evaluations(), band_.exact_looks(), band_.batches()};
  begin_ = task.start;
  most_time_ = task.most_time;
  moving_ = Moves(task.bodies);
  certified_looks_ = path_looks_ = 0;
  PrepareStanding(task);
  std::optional<BandPlan> kept = KeepLast(task, last);
  BandPlan best;
  if (kept && kept->level == 0 && !task.fresh) {
    BandTask cheaper = task;  // only that is looked for
    cheaper.explore = false;
    cheaper.path_search = nullptr;
    best = PlanAnew(cheaper, last);
    if (!MuchCheaper(best, task, last)) best = *std::move(kept);
  } else {
    best = PlanAnew(task, last);
    if (kept) Keep(task, *std::move(kept), best);
  }
  if (task.path_search != nullptr && best.check.clear() && best.reaches && best.level == 0) {
    task.path_search->Reset();
  }
  best.work = Work();
  return best;
}

bool BandPlanner::HasArrived(const BandTask& task) const {
  if (moving_ || end_ == BandEnd::kFree || task.start < task.request_end) return false;
  const VectorXd off = task.deviation[0] - zero_.controls().rightCols(1);
  const double rates =
      std::max(task.deviation[1].cwiseAbs().maxCoeff(), task.deviation[2].cwiseAbs().maxCoeff());
  return std::max(off.cwiseAbs().maxCoeff(), rates) < kSameState;
}

BandPlan BandPlanner::PlanAnew(const BandTask& task, const BandCurve* last) {
  Grid grid = GridOf(task, last, moving_);
  Prepare(task, grid);
  LookLessFarInNeed(task, last);
  const bool at_rest = task.deviation[0].cwiseAbs().maxCoeff() < kAtRest &&
                       task.deviation[1].cwiseAbs().maxCoeff() < kAtRest;
  BandPlan best{.curve = zero_, .start = BandStart::kRequest};
  const bool arrived = HasArrived(task);
  if (arrived) best.curve.controls().colwise() = task.deviation[0];
  Judge(end_, best);
  if (!moving_ && !at_rest && !arrived && best.check.near.empty()) {
    grid.returns = true;
    Prepare(task, grid);
    best.curve = zero_;
    Judge(end_, best);
  }
  const bool nothing_near = best.check.min_distance >= settings_.band.margin;
  const bool enough = nothing_near || (last == nullptr && best.check.wide());
  const bool stays = (at_rest && enough) || arrived;
  if (stays) {
    best.cost = band_.Cost(best.curve);
    Certify(task, best);
  }
  if (!stays || !best.check.clear()) best = Bend(task, best.check, last);
  return best;
}

bool BandPlanner::MayReturn(const BandTask& task, const BandCheck& trouble) {
  if (!moving_) return true;
  if (!trouble.near.empty()) return false;
  VectorXd q(zero_.size()), x(zero_.size());
  for (const double later : {0.0, 0.5 * kTurnTime, kTurnTime}) {
    task.request(task.start + later, 0, q);
    zero_.Evaluate(task.start + later, 0, x);
    q += x;
    if (band_.DistanceToMoving(q, task.start, kTurnTime) < settings_.band.margin) return false;
  }
  return true;
}

BandPlan BandPlanner::Bend(const BandTask& task, const BandCheck& trouble, const BandCurve* last) {
  if (MayReturn(task, trouble)) band_.ReturnBetween(trouble.near, kEvadeAhead);
  BandPlan best = GoOnWith(task, last);
  // What flies may be between the arm and where it is to be at the end.
  const bool reached = best.check.wide() && best.reaches;
  const BandEnd end = !moving_ || reached ? end_ : BandEnd::kFree;
  if (trouble.wide() || !best.check.wide()) {
    BandPlan back = Finish({BandStart::kRequest, end, zero_}, settings_.iterations);
    if (!best.check.wide() || back.cost < kMuchCheaper * best.cost) {
      Keep(task, std::move(back), best);
    }
  }
  if ((!best.check.wide() && task.explore) || (task.fresh && !trouble.wide())) {
    if (trouble.wide()) {
      const BandPlan tried = best;
      Explore(task, tried.check, tried.curve, end, best);
    } else {
      Explore(task, trouble, zero_, end, best);
    }
  }
  if (!best.check.clear() && end_ == BandEnd::kGoal && !moving_) Wait(task, best);
  if (task.path_search != nullptr) GoOnSearching(task, best);
  return best;
}

}  // namespace oca::planning
