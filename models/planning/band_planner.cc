// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_planner.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "oca/models/planning/rrt_connect.h"
#include "oca/models/planning/smooth_step.h"
#include "oca/models/random.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

// Intervals of a band, s.
constexpr double kFine = 0.1;  // of the first fine_span while something moves
constexpr double kGrowth = 1.3;
constexpr double kCoarse = 0.4;
constexpr int kFewest = 8;
constexpr std::size_t kMostGrowing = 10;  // intervals from kFine to kCoarse, and a few

constexpr int kFewestSteps = 5;  // on a start, less is no trial
// Of paths where the work of a plan is bounded.
constexpr int kBoundedNodes = 150;
constexpr int kBoundedShortcuts = 50;
constexpr std::uint64_t kPathTurn = 3;  // one of so many bounded searches tries paths

constexpr double kMuchCheaper = 0.7;
constexpr double kAtRest = 1e-9;

/// 0 before 0, 1 after 1, with two derivatives that vanish at both.
/// 1 between first and last, falling to 0 within `ramp` on either side.
double Window(double time, double first, double last, double ramp) {
  return SmoothStep((time - first + ramp) / ramp) * SmoothStep((last + ramp - time) / ramp);
}

}  // namespace

BandPlanner::BandPlanner(std::shared_ptr<const robot::RobotModel> model,
                         const BandPlannerSettings& settings, bool self_collision,
                         const robot::OwnRanges& own)
    : settings_(settings),
      band_(model, settings.band, self_collision, own),
      standing_(std::make_unique<robot::Clearance>(std::move(model), self_collision)) {
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

int BandPlanner::StepsLeft(int wanted) const {
  if (settings_.most_evaluations == 0) return wanted;
  const long left = settings_.most_evaluations - (band_.evaluations() - begun_);
  // A start costs its look at the finer grid of Check too.
  return static_cast<int>(std::clamp<long>(left / band_.num_samples() - 3, 0, wanted));
}

std::vector<double> BandPlanner::TimesOf(const BandTask& task) const {
  const bool moving = Moves(task.bodies);
  const double horizon = HorizonOf(task, moving);
  std::vector<double> times{task.start};
  double step = kFine;
  // Even where the start is so late that a step does not show.
  const auto most = static_cast<std::size_t>(settings_.fine_span / kFine) + kMostGrowing;
  while (moving && times.back() - task.start + step < horizon && step < kCoarse &&
         times.size() < most) {
    times.push_back(times.back() + step);
    if (times.back() - task.start > settings_.fine_span) step *= kGrowth;
  }
  const double rest = task.start + horizon - times.back();
  const int count = std::max(moving ? 1 : kFewest, static_cast<int>(std::ceil(rest / kCoarse)));
  const double from = times.back();
  for (int i = 1; i <= count; ++i) times.push_back(from + i * rest / count);
  return times;
}

void BandPlanner::Prepare(const BandTask& task) {
  zero_ = BandCurve(task.deviation[0].size(), TimesOf(task));
  zero_.StartWith(task.deviation[0], task.deviation[1], task.deviation[2]);
  band_.Prepare(zero_, task.request, task.bodies, true);
  VectorXd goal(zero_.size());
  task.request(zero_.end(), 0, goal);
  end_fixed_ = band_.Distance(goal, zero_.end()) >= settings_.band.clear_distance;
  band_.FixEnd(end_fixed_);
}

BandCurve BandPlanner::Shaped(const BandTask& task,
                              const std::function<VectorXd(double)>& shape) const {
  BandCurve curve = zero_;
  VectorXd request(curve.size());
  curve.Follow([&](double time) -> VectorXd {
    task.request(time, 0, request);
    const VectorXd q =
        (request + shape(time)).cwiseMax(model().lower_limits()).cwiseMin(model().upper_limits());
    return q - request;
  });
  if (end_fixed_) curve.controls().rightCols(3).setZero();
  return curve;
}

BandPlan BandPlanner::Finish(BandStart kind, BandCurve curve, int iterations) {
  BandPlan plan{.curve = std::move(curve), .start = kind};
  plan.cost = band_.Relax(plan.curve, iterations);
  plan.check = band_.Check(plan.curve);
  return plan;
}

bool BandPlanner::Better(const BandPlan& plan, const BandPlan& best) const {
  const bool clear = plan.check.clear();
  if (clear != best.check.clear()) return clear;
  if (!clear) return plan.check.violation < 0.95 * best.check.violation;
  const auto way = [&](const BandCheck& check) {
    return check.way + kMarginWay * std::max(settings_.band.margin - check.min_distance, 0.0);
  };
  return way(plan.check) < way(best.check);
}

void BandPlanner::Keep(BandPlan plan, BandPlan& best) const {
  if (Better(plan, best)) best = std::move(plan);
}

BandPlan BandPlanner::Plan(const BandTask& task, const BandCurve* last) {
  begun_ = band_.evaluations();
  Prepare(task);
  const bool at_rest = task.deviation[0].cwiseAbs().maxCoeff() < kAtRest &&
                       task.deviation[1].cwiseAbs().maxCoeff() < kAtRest;
  BandPlan best{.curve = zero_, .check = band_.Check(zero_), .start = BandStart::kRequest};
  const bool nothing_near = best.check.min_distance >= settings_.band.margin;
  const bool enough = nothing_near || (last == nullptr && best.check.clear());
  if (!at_rest || !enough) best = Bend(task, best.check, last);
  best.evaluations = band_.evaluations() - begun_;
  return best;
}

BandPlan BandPlanner::Bend(const BandTask& task, const BandCheck& trouble, const BandCurve* last) {
  BandCurve warm = zero_;
  if (last != nullptr && !last->empty()) {
    VectorXd x(zero_.size());
    warm = Shaped(task, [&](double time) -> VectorXd {
      last->Evaluate(time, 0, x);
      return x;
    });
  }
  BandPlan best = Finish(BandStart::kLast, warm, settings_.iterations);
  if (!best.check.clear() && end_fixed_ && Moves(task.bodies)) {
    // What flies may be between the arm and where it is to be at the end.
    end_fixed_ = false;
    band_.FixEnd(false);
    Keep(Finish(BandStart::kLast, std::move(warm), settings_.iterations), best);
  }
  if (trouble.clear() || !best.check.clear()) {
    BandPlan back = Finish(BandStart::kRequest, zero_, settings_.iterations);
    if (!best.check.clear() || back.cost < kMuchCheaper * best.cost) Keep(std::move(back), best);
  }
  if ((!best.check.clear() && task.explore) || (task.fresh && !trouble.clear())) {
    if (trouble.clear()) {
      const BandPlan tried = best;
      Explore(task, tried.check, tried.curve, best);
    } else {
      Explore(task, trouble, zero_, best);
    }
  }
  return best;
}

void BandPlanner::Explore(const BandTask& task, const BandCheck& trouble, const BandCurve& troubled,
                          BandPlan& best) {
  std::vector<Start> starts;
  AddPauses(task, trouble, starts);
  AddDetours(task, trouble, starts);
  // Within a bounded search half the work goes into finding what is worth to be relaxed.
  const auto all = static_cast<std::ptrdiff_t>(starts.size());
  const std::ptrdiff_t looks = settings_.most_evaluations == 0
                                   ? all
                                   : std::clamp<std::ptrdiff_t>(StepsLeft(1000) / 2, 4, all);
  const auto first = static_cast<std::ptrdiff_t>(task.search * looks % all);
  std::rotate(starts.begin(), starts.begin() + first, starts.end());
  starts.resize(looks);
  AddRetreats(task, trouble, troubled, starts);
  for (Start& start : starts) start.cost = band_.Cost(start.curve);
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.cost < b.cost; });
  const auto count = std::min(starts.size(), static_cast<std::size_t>(settings_.relaxed_starts));
  for (std::size_t i = 0; i < count; ++i) {
    const int steps = StepsLeft(settings_.start_iterations);
    if (i > 0 && steps < kFewestSteps) break;
    Keep(Finish(starts[i].kind, std::move(starts[i].curve), std::max(steps, kFewestSteps)), best);
  }
  const bool turn = settings_.most_evaluations == 0 || task.search % kPathTurn == kPathTurn - 1;
  if (!best.check.clear() && turn) TryPaths(task, best);
}

void BandPlanner::AddPauses(const BandTask& task, const BandCheck& trouble,
                            std::vector<Start>& starts) const {
  VectorXd here(zero_.size());
  task.request(task.start, 0, here);
  here += task.deviation[0];
  VectorXd request(zero_.size());
  for (const double more : {0.3, 1.0, 2.0}) {
    const double until = trouble.last + more;
    if (until > zero_.end() - 0.5) break;
    const auto shape = [&](double time) -> VectorXd {
      task.request(time, 0, request);
      return (here - request) * SmoothStep((zero_.end() - time) / (zero_.end() - until));
    };
    starts.push_back({BandStart::kPause, Shaped(task, shape), 0.0});
  }
}

void BandPlanner::AddRetreats(const BandTask& task, const BandCheck& trouble, const BandCurve& from,
                              std::vector<Start>& starts) {
  if (trouble.min_distance >= settings_.band.margin) return;
  VectorXd q(zero_.size()), x(zero_.size()), out(zero_.size());
  task.request(trouble.time, 0, q);
  from.Evaluate(trouble.time, 0, x);
  if (!band_.DistanceGradient(q + x, trouble.time, out)) return;
  const double largest = out.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) return;
  const double room = std::max(0.3, 0.5 * (zero_.end() - trouble.last));
  for (const double size : {0.4, 1.0, -0.7}) {
    const auto shape = [&](double time) -> VectorXd {
      return (size / largest) * out *
             Window(time, trouble.first, trouble.last, std::min(1.5, room));
    };
    starts.push_back({BandStart::kDetour, Shaped(task, shape), 0.0});
  }
}

void BandPlanner::AddDetours(const BandTask& task, const BandCheck& trouble,
                             std::vector<Start>& starts) const {
  const Eigen::Index n = zero_.size();
  const double room = std::max(0.3, 0.5 * (zero_.end() - trouble.last));
  const auto add = [&](BandStart kind, const VectorXd& out, double ramp) {
    const auto shape = [&](double time) -> VectorXd {
      return out * Window(time, trouble.first, trouble.last, std::min(ramp, room));
    };
    starts.push_back({kind, Shaped(task, shape), 0.0});
  };
  VectorXd out = VectorXd::Zero(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (const double size : {0.5, -0.5, 1.2, -1.2}) {
      out.setZero();
      out[j] = size;
      add(BandStart::kDetour, out, 1.5);
    }
  }
  models::Random random(models::Random::Seed(task.seed, "band"));
  for (int i = 0; i < settings_.random_starts; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) out[j] = random.Uniform(-1.0, 1.0);
    out *= random.Uniform(0.3, 1.8) / out.cwiseAbs().maxCoeff();
    add(BandStart::kRandom, out, random.Uniform(0.5, 3.0));
  }
}

void BandPlanner::TryPaths(const BandTask& task, BandPlan& best) {
  std::vector<robot::PlacedBody> placed;
  for (const BandBody& body : task.bodies) {
    if (body.stands) placed.push_back(body.At(task.start));
  }
  if (placed.empty()) return;
  standing_->SetBodies(std::move(placed));
  VectorXd here(zero_.size()), goal(zero_.size()), request(zero_.size());
  task.request(task.start, 0, here);
  here += task.deviation[0];
  task.request(zero_.end(), 0, goal);
  const bool bounded = settings_.most_evaluations > 0;
  for (int i = 0; i < (bounded ? std::min(settings_.paths, 1) : settings_.paths); ++i) {
    RrtOptions options;
    options.seed = models::Random::Seed(task.seed, static_cast<std::uint64_t>(i));
    options.most_nodes = bounded ? kBoundedNodes : settings_.path_nodes;
    if (bounded) options.shortcuts = kBoundedShortcuts;
    std::optional<std::vector<VectorXd>> path;
    for (const double margin : {1.3 * settings_.band.clear_distance, 0.015}) {
      options.margin = margin;
      path = RrtConnect(*standing_, here, goal, options);
      if (path) break;
    }
    if (!path) continue;
    std::vector<double> lengths{0.0};
    for (std::size_t k = 1; k < path->size(); ++k) {
      lengths.push_back(lengths.back() + ((*path)[k] - (*path)[k - 1]).norm());
    }
    const double begin = task.start + 0.2;
    const double end = zero_.end() - std::min(0.5, 0.2 * (zero_.end() - task.start));
    const auto shape = [&](double time) -> VectorXd {
      const double at = lengths.back() * SmoothStep((time - begin) / (end - begin));
      const auto above = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, at);
      const auto k = static_cast<std::size_t>(above - lengths.begin());
      const double span = lengths[k] - lengths[k - 1];
      const double share = span > 0.0 ? (at - lengths[k - 1]) / span : 0.0;
      task.request(time, 0, request);
      return (*path)[k - 1] + share * ((*path)[k] - (*path)[k - 1]) - request;
    };
    const int steps = std::max(StepsLeft(2 * settings_.start_iterations), kFewestSteps);
    Keep(Finish(BandStart::kPath, Shaped(task, shape), steps), best);
  }
}

}  // namespace oca::planning
