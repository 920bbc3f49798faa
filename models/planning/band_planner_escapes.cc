// SPDX-License-Identifier: BSD-3-Clause
// Bands of BandPlanner that get out of the way at once.
#include <algorithm>
#include <utility>

#include "oca/models/planning/band_planner.h"
#include "oca/models/planning/path_timing.h"
#include "oca/models/planning/smooth_step.h"
#include "oca/models/random.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

// s; how long escapes take.
constexpr double kShortestEscape = 0.3;
constexpr double kLongestEscape = 2.0;
constexpr double kShareOfHorizon = 0.9;
constexpr double kTimeShare = 0.5;  // of what is left to plan
constexpr long kMostLooks = 1000;   // at configurations
constexpr int kEnough = 4;          // that evade all,
constexpr int kEnoughClear = 2;     // if one of them is clear

}  // namespace

void BandPlanner::TryEscapes(const BandTask& task, BandPlan& best) {
  const Eigen::Index n = zero_.size();
  const double share = settings_.band.limit_share;
  VectorXd from(n), rate(n), request(n);
  task.request(task.start, 0, from);
  task.request(task.start, 1, rate);
  from += task.deviation[0] + kStopWithin * (rate + task.deviation[1]);
  const double longest = std::min(kLongestEscape, kShareOfHorizon * (zero_.end() - task.start));
  const std::uint64_t seed = models::Random::Seed(task.seed, "escapes");
  models::Random random(models::Random::Seed(seed, task.plans_before));
  const double troubled = best.check.first;
  const long most = std::min(LooksLeft(settings_.prices.band / kTimeShare, kMostLooks), kMostLooks);
  const long begun = band_.evaluations();
  int found = 0;
  const auto enough = [&] {
    return found >= (best.check.clear() ? kEnoughClear : kEnough) ||
           band_.evaluations() - begun >= most;
  };
  Eigen::MatrixXd ends(n, BatchClearance::kLanes);
  while (!enough()) {
    for (auto end : ends.colwise()) {
      const VectorXd way = WayWithin(model(), random.Uniform(kShortestEscape, longest), share);
      for (Eigen::Index j = 0; j < n; ++j) end[j] = from[j] + random.Uniform(-1.0, 1.0) * way[j];
      end = end.cwiseMax(model().lower_limits()).cwiseMin(model().upper_limits());
    }
    const unsigned evading = band_.EvadesAtEnd(ends, static_cast<int>(ends.cols()));
    for (Eigen::Index k = 0; k < ends.cols() && !enough(); ++k) {
      if ((evading >> k & 1u) == 0) continue;
      const VectorXd way = ends.col(k) - from;
      const double duration = DurationAlong(model(), {from, ends.col(k)}, share);
      BandCurve curve = Shaped(task, [&](double time) -> VectorXd {
        task.request(time, 0, request);
        return from + SmoothStep((time - task.start) / duration) * way - request;
      });
      if (!band_.EvadesAll(curve, troubled)) continue;
      ++found;
      Keep(task, Unrelaxed({BandStart::kEscape, BandEnd::kFree, std::move(curve)}), best);
    }
  }
}

}  // namespace oca::planning
