// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/clairvoyant.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/models/error.h"
#include "oca/models/planning/smooth_step.h"
#include "oca/models/random.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

constexpr double kMovingInterval = 0.1;  // s, of the band while anything moves
constexpr double kInterval = 0.2;        // s, else
constexpr int kFewestIntervals = 8;      // intervals
constexpr double kCoarseGrid = 1e-2;     // s; of the judge while the search goes on
constexpr int kSteps = 80;               // of a relaxation
constexpr int kFirstTries = 6;           // before the planner's, which are many

/// What a relaxation pays for: the later, the less a limit may be exceeded and the less room is
/// asked for.
struct Prices {
  double margin;
  double clearance;
  double limits;
  double limit_share;
};
constexpr Prices kPrices[] = {
    {kClairvoyantReach, 1e5, 1e4, 0.96}, {0.03, 1e5, 1e6, 0.97}, {0.015, 1e6, 1e7, 0.98}};

BandSettings SettingsOf(const Prices& prices) {
  BandSettings settings;
  settings.margin = prices.margin;
  settings.clear_distance = 0.3 * prices.margin;
  settings.clearance = prices.clearance;
  settings.limits = prices.limits;
  settings.limit_share = prices.limit_share;
  return settings;
}

BandPlannerSettings PlannerSettings(const ClairvoyantTask& task) {
  BandPlannerSettings settings;
  settings.band = SettingsOf(kPrices[0]);
  settings.iterations = kSteps;
  settings.start_iterations = kSteps;
  settings.relaxed_starts = task.starts;
  settings.random_starts = 4 * task.starts;
  settings.most_paths = 6;
  settings.path_nodes = 5000;
  settings.moving_horizon = task.duration;
  settings.least_horizon = task.duration;
  settings.most_horizon = task.duration;
  settings.fine_span = task.duration;
  return settings;
}

class Search {
 public:
  Search(const std::shared_ptr<const robot::RobotModel>& model, const ClairvoyantTask& task)
      : model_(model),
        task_(task),
        bodies_(task.bodies.begin(), task.bodies.end()),
        judge_(model, task.request, task.bodies, task.self_collision, task.ignored,
               kClairvoyantReach),
        random_(models::Random::Seed(task.seed, "clairvoyant")) {
    zero_ = BandCurve(model->num_positions(), Times());
    StartAtRest();
    VectorXd goal(model->num_positions());
    task.request(task.duration, 0, goal);
    end_fixed_ = judge_.Distance(goal, task.duration) > 0.0;
    for (const Prices& prices : kPrices) {
      bands_.push_back(std::make_unique<BandOptimizer>(model, SettingsOf(prices),
                                                       task.self_collision, task.own));
      bands_.back()->Prepare(zero_, task.request, bodies_, end_fixed_);
    }
  }

  ClairvoyantPlan Run() {
    best_ = {.verdict = Judged(zero_), .curve = zero_};
    if (best_.verdict.clear() || StartIsInTheWay()) return best_;
    if (Improve(zero_, BandStart::kRequest) || TryBent(0, kFirstTries) || TryPlanner()) {
      return best_;
    }
    TryBent(kFirstTries, task_.starts);
    return best_;
  }

 private:
  std::vector<double> Times() const {
    const bool moving = std::any_of(bodies_.begin(), bodies_.end(),
                                    [](const BandBody& body) { return !body.stands; });
    const double interval = moving ? kMovingInterval : kInterval;
    const int count =
        std::max(kFewestIntervals, static_cast<int>(std::ceil(task_.duration / interval)));
    std::vector<double> times;
    for (int i = 0; i <= count; ++i) times.push_back(task_.duration * i / count);
    return times;
  }

  void StartAtRest() {
    VectorXd position(zero_.size()), velocity(zero_.size());
    task_.request(0.0, 0, position);
    task_.request(0.0, 1, velocity);
    deviation_[0] = task_.start.size() > 0 ? VectorXd(task_.start - position)
                                           : VectorXd(VectorXd::Zero(zero_.size()));
    deviation_[1] =
        task_.start.size() > 0 ? VectorXd(-velocity) : VectorXd(VectorXd::Zero(zero_.size()));
    deviation_[2] = VectorXd::Zero(zero_.size());
    zero_.StartWith(deviation_[0], deviation_[1], deviation_[2]);
  }

  BandTask Task() const {
    BandTask task;
    for (int d = 0; d < 3; ++d) task.deviation[d] = deviation_[d];
    task.request = task_.request;
    task.request_end = task_.request_end;
    task.bodies = bodies_;
    task.seed = task_.seed;
    return task;
  }

  void FreeEnd() {
    end_fixed_ = false;
    for (const auto& band : bands_) band->FixEnd(false);
  }

  bool StartIsInTheWay() {
    VectorXd q(zero_.size());
    task_.request(0.0, 0, q);
    return !(judge_.Distance(q + deviation_[0], 0.0) > 0.0);
  }

  bool EndIsInTheWay() const {
    const auto& troubles = best_.verdict.troubles;
    return !troubles.empty() && troubles.back().second > task_.duration - 1.0;
  }

  MotionVerdict Judged(const BandCurve& curve) {
    MotionVerdict verdict = judge_.Judge(curve, task_.duration, kCoarseGrid);
    return verdict.clear() ? judge_.Judge(curve, task_.duration, kMotionGrid) : verdict;
  }

  /// Whether it is clear; the better one stays.
  bool Keep(const BandCurve& curve, BandStart start) {
    MotionVerdict verdict = Judged(curve);
    const bool clear = verdict.clear();
    if (clear || verdict.shortfall < best_.verdict.shortfall) {
      best_ = {std::move(verdict), start, best_.tries, curve};
    }
    return clear;
  }

  /// Relaxes a motion under one set of prices after the other.
  bool Improve(BandCurve curve, BandStart start) {
    ++best_.tries;
    if (curve.times() != zero_.times()) curve = OnOwnGrid(curve);
    if (end_fixed_) curve.controls().rightCols(3).setZero();
    for (const auto& band : bands_) {
      band->Relax(curve, kSteps);
      if (Keep(curve, start)) return true;
    }
    return false;
  }

  BandCurve OnOwnGrid(const BandCurve& other) const {
    BandCurve curve = zero_;
    VectorXd x(zero_.size());
    curve.Follow([&](double time) -> VectorXd {
      other.Evaluate(time, 0, x);
      return x;
    });
    return curve;
  }

  bool TryPlanner() {
    BandPlanner planner(model_, PlannerSettings(task_), task_.self_collision, task_.own);
    BandPlan found = planner.Plan(Task(), nullptr);
    const BandStart kind = found.start == BandStart::kLast ? BandStart::kRequest : found.start;
    return Keep(found.curve, kind) || Improve(std::move(found.curve), kind);
  }

  bool TryBent(int first, int last) {
    for (int i = first; i < std::min(last, task_.starts); ++i) {
      if (2 * i >= task_.starts && EndIsInTheWay()) FreeEnd();
      if (Improve(Bent(i % 2 == 0 ? best_.curve : zero_), BandStart::kRandom)) return true;
    }
    return false;
  }

  /// The curve with a bump at random around each of the times at which it fails, or some of them.
  BandCurve Bent(const BandCurve& from) {
    const MotionVerdict verdict = judge_.Judge(from, task_.duration, kCoarseGrid);
    struct Bump {
      double first, last, before, after;
      VectorXd out;
    };
    std::vector<Bump> bumps;
    for (const auto& [first, last] : verdict.troubles) {
      if (verdict.troubles.size() > 1 && random_.Unit() < 0.3) continue;
      bumps.push_back(
          {first, last, random_.Uniform(0.4, 3.0), random_.Uniform(0.4, 3.0), Direction()});
    }
    BandCurve curve = from;
    VectorXd x(curve.size()), request(curve.size());
    curve.Follow([&](double time) -> VectorXd {
      from.Evaluate(time, 0, x);
      task_.request(time, 0, request);
      x += request;
      for (const Bump& bump : bumps) {
        x += bump.out * SmoothStep((time - bump.first + bump.before) / bump.before) *
             SmoothStep((bump.last + bump.after - time) / bump.after);
      }
      return x.cwiseMax(model_->lower_limits()).cwiseMin(model_->upper_limits()) - request;
    });
    return curve;
  }

  /// Of one joint, or of all.
  VectorXd Direction() {
    const Eigen::Index n = zero_.size();
    VectorXd out = VectorXd::Zero(n);
    if (random_.Unit() < 0.4) {
      out[static_cast<Eigen::Index>(random_.Below(static_cast<std::uint64_t>(n)))] =
          random_.Unit() < 0.5 ? -1.0 : 1.0;
    } else {
      for (Eigen::Index j = 0; j < n; ++j) out[j] = random_.Uniform(-1.0, 1.0);
      out /= std::max(out.cwiseAbs().maxCoeff(), 1e-9);
    }
    return random_.Uniform(0.2, 1.6) * out;
  }

  const std::shared_ptr<const robot::RobotModel> model_;
  const ClairvoyantTask& task_;
  std::vector<BandBody> bodies_;
  MotionJudge judge_;
  models::Random random_;
  BandCurve zero_;  ///< the request, from where the arm is
  VectorXd deviation_[3];
  bool end_fixed_{true};
  std::vector<std::unique_ptr<BandOptimizer>> bands_;  ///< one for each of kPrices
  ClairvoyantPlan best_;
};

}  // namespace

ClairvoyantPlan PlanClairvoyantly(const std::shared_ptr<const robot::RobotModel>& model,
                                  const ClairvoyantTask& task) {
  if (!(task.duration > 0.0 && std::isfinite(task.duration))) {
    throw models::ModelError(
        fmt::format("plan: duration; got {} s; expected more than 0", task.duration));
  }
  if (task.start.size() != 0 && task.start.size() != model->num_positions()) {
    throw models::ModelError(fmt::format("plan: start; got {} positions; expected {}",
                                         task.start.size(), model->num_positions()));
  }
  return Search(model, task).Run();
}

}  // namespace oca::planning
