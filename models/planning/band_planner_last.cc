// SPDX-License-Identifier: BSD-3-Clause
// Bands of BandPlanner that go on with the last one.
#include <optional>
#include <utility>

#include "oca/models/planning/band_planner.h"

namespace oca::planning {
namespace {

using Eigen::VectorXd;

constexpr double kSameState = 1e-9;  // of a last band and a task's start or end
constexpr double kLeastLeft = 0.1;   // s; of a last band that is worth to be looked at

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
  FixEnd(task, last->end());
  x = last->controls().rightCols(1);
  if (task.end.size() > 0) x -= task.end;
  end_fixed_ = end_fixed_ && x.cwiseAbs().maxCoeff() < kSameState;
  if (!end_fixed_) return std::nullopt;
  BandPlan plan{.curve = *last, .start = BandStart::kLast};
  plan.cost = band_.Cost(plan.curve);
  Judge(plan);
  Certify(task, plan);
  if (!plan.check.clear()) return std::nullopt;
  return plan;
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
  if (!moving_ || !end_fixed_ || last == nullptr || last->empty()) return false;
  const VectorXd off = last->controls().rightCols(1) - zero_.controls().rightCols(1);
  return off.cwiseAbs().maxCoeff() > kSameState;
}

void BandPlanner::LookLessFarInNeed(const BandTask& task, const BandCurve* last) {
  if (!moving_ || last == nullptr || !(zero_.end() - task.start > HorizonOf(task, true))) return;
  const bool fixed = end_fixed_;
  if (EndsElsewhere(last)) SetEndFixed(false);
  const bool meets = !band_.EvadesAll(Followed(task, last), task.start);
  SetEndFixed(fixed);
  if (meets) Prepare(task, GridOf(task, nullptr, moving_));
}

BandPlan BandPlanner::GoOnWith(const BandTask& task, const BandCurve* last) {
  const auto finish = [&] {
    return Finish(BandStart::kLast, Followed(task, last), settings_.iterations);
  };
  // One that ends elsewhere goes on to do so first.
  const bool elsewhere = EndsElsewhere(last);
  const bool may_reach = end_fixed_ && !elsewhere;
  if (elsewhere) SetEndFixed(false);
  BandPlan best = finish();
  Certify(task, best);
  if (elsewhere && best.check.wide()) {
    SetEndFixed(true);
    Keep(task, finish(), best);
    if (!best.reaches) SetEndFixed(false);
  }
  if (!moving_ || best.check.wide()) return best;
  // What flies may be between the arm and where it is to be at the end.
  SetEndFixed(false);
  if (!best.check.clear()) {
    if (last != nullptr) Keep(task, Unrelaxed(BandStart::kLast, Followed(task, last)), best);
    if (!best.check.clear()) TryEscapes(task, best);
  }
  if (may_reach) Keep(task, finish(), best);
  return best;
}

}  // namespace oca::planning
