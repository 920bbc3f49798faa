// SPDX-License-Identifier: BSD-3-Clause
// Bands of BandPlanner that go on with the last one.
#include <optional>
#include <utility>

#include "oca/models/planning/band_planner.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

constexpr double kLeastLeft = 0.1;  // s; of a last band that is worth to be looked at

}  // namespace

std::optional<BandPlan> BandPlanner::KeepLast(const BandTask& task, const BandCurve* last) {
  if (Moves(task.bodies) || last == nullptr || last->empty()) return std::nullopt;
  if (last->end() < task.request_end || last->end() < task.start + kLeastLeft) return std::nullopt;
  VectorXd x(last->size());
  for (int d = 0; d < 3; ++d) {
    last->Evaluate(task.start, d, x);
    if ((x - task.deviation[d]).cwiseAbs().maxCoeff() > kSameState) return std::nullopt;
  }
  band_.Prepare(*last, task.request, task.bodies, true, task.start);
  LookAtGoal(task, last->end());
  x = last->controls().rightCols(1);
  if (task.end.size() > 0) x -= task.end;
  if (end_ == BandEnd::kFree || x.cwiseAbs().maxCoeff() >= kSameState) return std::nullopt;
  BandPlan plan{.curve = *last, .start = BandStart::kLast};
  plan.cost = band_.Cost(plan.curve);
  Judge(BandEnd::kGoal, plan);
  Certify(task, plan);
  if (!plan.check.clear()) return std::nullopt;
  return plan;
}

bool BandPlanner::MuchCheaper(const BandPlan& plan, const BandTask& task, const BandCurve* last) {
  if (!plan.check.clear() || !plan.reaches || plan.level > 0) return false;
  Start followed{BandStart::kLast, BandEnd::kGoal, Followed(task, last)};
  SetEnd(followed);
  return plan.cost < kMuchCheaper * band_.Cost(followed.curve);
}

BandCurve BandPlanner::Followed(const BandTask& task, const BandCurve* last) const {
  if (last == nullptr || last->empty()) return zero_;
  VectorXd x(zero_.size());
  return Shaped(task, [&](double time) -> VectorXd {
    last->Evaluate(time, 0, x);
    return x;
  });
}

bool BandPlanner::EndsElsewhere(const BandCurve* last) const {
  if (!moving_ || end_ == BandEnd::kFree || last == nullptr || last->empty()) return false;
  const VectorXd off = last->controls().rightCols(1) - zero_.controls().rightCols(1);
  return off.cwiseAbs().maxCoeff() > kSameState;
}

void BandPlanner::LookLessFarInNeed(const BandTask& task, const BandCurve* last) {
  if (!moving_ || last == nullptr || !(zero_.end() - task.start > HorizonOf(task, true))) return;
  Start followed{BandStart::kLast, EndsElsewhere(last) ? BandEnd::kFree : end_,
                 Followed(task, last)};
  SetEnd(followed);
  if (!band_.EvadesAll(followed.curve, task.start)) {
    Prepare(task, GridOf(task, nullptr, moving_));
  }
}

BandPlan BandPlanner::GoOnWith(const BandTask& task, const BandCurve* last) {
  const auto followed = [&](BandEnd end) {
    return Start{BandStart::kLast, end, Followed(task, last)};
  };
  const auto finish = [&](BandEnd end) { return Finish(followed(end), settings_.iterations); };
  // One that ends elsewhere goes on to do so first.
  const BandEnd first = EndsElsewhere(last) ? BandEnd::kFree : end_;
  BandPlan best = finish(first);
  Certify(task, best);
  if (first != end_ && best.check.wide()) Keep(task, finish(BandEnd::kGoal), best);
  if (!moving_ || best.check.wide()) return best;
  if (!best.check.clear()) {
    if (last != nullptr) Keep(task, Unrelaxed(followed(BandEnd::kFree)), best);
    if (!best.check.clear()) TryEscapes(task, best);
  }
  if (first == BandEnd::kGoal) Keep(task, finish(BandEnd::kFree), best);
  return best;
}

}  // namespace oca::planning
