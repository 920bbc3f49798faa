// SPDX-License-Identifier: BSD-3-Clause
// Starts of BandPlanner around what is in the way: pauses, retreats, detours.
#include <algorithm>
#include <cstdint>
#include <utility>

#include "oca/models/planning/band_planner.h"
#include "oca/models/planning/smooth_step.h"
#include "oca/models/random.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

/// 1 between first and last, falling to 0 within `ramp` on either side.
double Window(double time, double first, double last, double ramp) {
  return SmoothStep((time - first + ramp) / ramp) * SmoothStep((last + ramp - time) / ramp);
}

}  // namespace

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
  return curve;
}

void BandPlanner::Explore(const BandTask& task, const BandCheck& trouble, const BandCurve& troubled,
                          BandEnd end, BandPlan& best) {
  std::vector<Start> starts;
  AddPauses(task, trouble, starts);
  AddDetours(task, trouble, starts);
  // Within a bounded search half the work goes into finding what is worth to be relaxed.
  const auto all = static_cast<std::ptrdiff_t>(starts.size());
  const std::ptrdiff_t looks = settings_.most_evaluations == 0
                                   ? all
                                   : std::clamp<std::ptrdiff_t>(StepsLeft(1000) / 2, 4, all);
  const auto first = static_cast<std::ptrdiff_t>(task.plans_before * looks % all);
  std::rotate(starts.begin(), starts.begin() + first, starts.end());
  starts.resize(looks);
  AddRetreats(task, trouble, troubled, starts);
  for (Start& start : starts) {
    start.end = end;
    SetEnd(start);
    start.cost = band_.Cost(start.curve);
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.cost < b.cost; });
  const auto count = std::min(starts.size(), static_cast<std::size_t>(settings_.relaxed_starts));
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && StepsLeft(kFewestSteps) < kFewestSteps) break;
    Keep(task, Finish(std::move(starts[i]), settings_.start_iterations), best);
  }
  if (!best.check.clear() && task.path_search == nullptr) TryPaths(task, end, best);
}

void BandPlanner::Wait(const BandTask& task, BandPlan& best) {
  VectorXd stop(zero_.size()), v(zero_.size()), request(zero_.size());
  task.request(task.start, 0, stop);
  task.request(task.start, 1, v);
  stop += task.deviation[0] + kStopWithin * (v + task.deviation[1]);
  const BandCurve here = Shaped(task, [&](double time) -> VectorXd {
    task.request(time, 0, request);
    return stop - request;
  });
  const Start pause{BandStart::kPause, BandEnd::kFree, here};
  Keep(task, Unrelaxed(pause), best);
  Keep(task, Finish(pause, settings_.iterations), best);
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
    starts.push_back({BandStart::kPause, end_, Shaped(task, shape)});
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
    starts.push_back({BandStart::kDetour, end_, Shaped(task, shape)});
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
    starts.push_back({kind, end_, Shaped(task, shape)});
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

}  // namespace oca::planning
