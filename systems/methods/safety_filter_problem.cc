// SPDX-License-Identifier: BSD-3-Clause
// How a SafetyFilter states its problem, and how it reads the answer.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "oca/framework/dataflow/error.h"
#include "oca/models/motion/following.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/methods/motion_limiter.h"
#include "oca/systems/methods/safety_filter.h"
#include "oca/systems/sensing/link_colliders.h"

namespace oca::systems {
namespace {

// A way that is as good as none (rad, m).
constexpr double kNoWay = 0.05;
// Bounds a velocity that nothing else does, so that the problem is finite (rad/s, m/s).
constexpr double kFastest = 1e3;
// Of a joint's velocity limit, at most kFastest: a wish beyond it is cut, for one without bound
// would pay any price for slack.
constexpr double kFastestWish = 10.0;

}  // namespace

FilterSolution::Workspace::Workspace(int num_positions, int most_rows)
    : qp(num_positions, most_rows),
      solver(num_positions, most_rows),
      solution(qp),
      box(static_cast<std::size_t>(num_positions)),
      command(Eigen::VectorXd::Zero(num_positions)),
      last_velocity(command),
      row(command) {
  rows.reserve(static_cast<std::size_t>(most_rows));
  unmovable.reserve(FilterActivity::kMostBounds);
}

double SafetyFilter::Approach(double headroom) const {
  if (headroom <= 0.0) return 0.0;
  if (params_.form == Form::kLinear) return params_.approach_gain * headroom;
  return motion::LargestStoppableVelocity(headroom, params_.deceleration, params_.period.seconds());
}

int SafetyFilter::FindLink(models::Name name) const {
  const auto& all = model_->links();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const robot::Link& link) { return link.name == name; });
  if (found != all.end()) return static_cast<int>(found - all.begin());
  throw ConfigError(fmt::format("proximities: got one of '{}'; expected a link of '{}'",
                                name.text(), model_->name().text()));
}

void SafetyFilter::FillBox(FilterSolution& result) const {
  FilterSolution::Workspace& work = *result.workspace;
  const double dt = params_.period.seconds();
  for (Eigen::Index j = 0; j < model_->num_positions(); ++j) {
    const motion::JointMotion motion{work.command[j], work.last_velocity[j], 0.0};
    motion::JointLimits limits = LimitsOf(*model_, j);
    limits.jerk = robot::kUnlimited;  // a MotionLimiter's task
    limits.velocity = std::min(limits.velocity, kFastest);
    motion::VelocityRange& range = work.box[static_cast<std::size_t>(j)];
    range = motion::StoppableVelocities(limits, motion, dt);
    work.qp.lower[j] = range.lower;
    work.qp.upper[j] = range.upper;
    if (range.yields != motion::MotionLimit::kNone) ++result.activity.yields;
  }
}

void SafetyFilter::FillWish(VectorView request, OptionalVector rate, OptionalVector rate_rate,
                            VectorView l, FilterSolution& result) const {
  FilterSolution::Workspace& work = *result.workspace;
  const double dt = params_.period.seconds();
  for (Eigen::Index j = 0; j < request.size(); ++j) {
    const motion::JointRequest joint{request[j], rate ? (*rate)[j] : 0.0,
                                     rate_rate ? (*rate_rate)[j] : 0.0};
    work.qp.wish[j] = motion::FollowingVelocity(joint, work.command[j], params_.position_gain,
                                                model_->acceleration_limits()[j], dt);
    const double fastest = std::min(kFastestWish * model_->velocity_limits()[j], kFastest);
    work.qp.wish[j] = std::clamp(work.qp.wish[j], -fastest, fastest);
  }
  const double most = l.maxCoeff() + kNoWay;
  for (Eigen::Index j = 0; j < request.size(); ++j) {
    const double share = l[j] / most;
    work.qp.weights[j] = params_.weights[j] * (1.0 + params_.progress_weight * share);
  }
}

bool SafetyFilter::Moves(const Eigen::VectorXd& row) const {
  return !(row.array().abs() < least_entries_.array()).all();  // what is no number moves too
}

void SafetyFilter::LeaveOut(const Proximity& proximity, double lack, FilterSolution& result) const {
  auto& unmovable = result.workspace->unmovable;
  if (!(lack > 0.0) || unmovable.size() == unmovable.capacity()) return;
  FilterBound bound;
  bound.kind = FilterBound::Kind::kUnmovable;
  bound.link = proximity.link;
  bound.obstacle = proximity.obstacle;
  bound.slack = lack;
  unmovable.push_back(bound);
}

/// To rest as fast as the box lets every joint.
void SafetyFilter::Brake(FilterSolution& result) const {
  const qp::ProjectionQp& qp = result.workspace->qp;
  result.velocity.setZero();
  result.velocity = result.velocity.cwiseMax(qp.lower).cwiseMin(qp.upper);
}

void SafetyFilter::AddRow(const FilterRow& source, double bound, FilterSolution& result) const {
  FilterSolution::Workspace& work = *result.workspace;
  const auto reach =
      work.row.cwiseProduct(work.qp.lower).cwiseMin(work.row.cwiseProduct(work.qp.upper));
  if (reach.sum() >= bound) return;  // every velocity of the box keeps it
  auto at = static_cast<std::size_t>(work.qp.num_rows);
  if (work.qp.num_rows < params_.most_rows) {
    work.rows.push_back(source);
    ++work.qp.num_rows;
  } else {
    ++result.activity.dropped;
    const auto farthest = std::max_element(
        work.rows.begin(), work.rows.end(),
        [](const FilterRow& a, const FilterRow& b) { return a.headroom < b.headroom; });
    if (farthest->headroom <= source.headroom) return;
    *farthest = source;
    at = static_cast<std::size_t>(farthest - work.rows.begin());
  }
  const auto row = static_cast<Eigen::Index>(at);
  work.qp.rows.row(row) = work.row.transpose();
  work.qp.bounds[row] = bound;
  work.qp.penalties[row] = source.recovery ? params_.recovery_penalty : params_.slack_penalty;
}

void SafetyFilter::FillRows(const ProximitySet& set, Poses X_WL, const ClearMotion* clear_motion,
                            FilterSolution& result) const {
  FilterSolution::Workspace& work = *result.workspace;
  work.rows.clear();
  work.unmovable.clear();
  work.qp.num_rows = 0;
  const bool trusted = clear_motion && clear_motion->clear_for > params_.trust_time;
  for (std::size_t i = 0; i < set.proximities.size(); ++i) {
    const Proximity& proximity = set.proximities[i];
    const int link = FindLink(proximity.link);
    const int other = proximity.own_link.empty() ? -1 : FindLink(proximity.own_link);
    robot::DistanceRow(*model_, X_WL, link, proximity.point_on_link, other,
                       proximity.point_on_obstacle, proximity.normal, work.row);
    const double headroom = proximity.distance - params_.safe_distance;
    const double rest = proximity.normal.dot(proximity.obstacle_velocity);
    double bound = rest - Approach(headroom);
    const bool known = trusted && clear_motion->Knows(proximity.obstacle, other >= 0);
    if (known) bound = std::min(bound, work.row.dot(work.qp.wish));
    const bool recovers = headroom < 0.0 && !known;
    const double growth = std::min(-params_.recovery_gain * headroom, params_.recovery_speed);
    if (!Moves(work.row)) {
      LeaveOut(proximity, recovers ? rest + growth : bound, result);
      continue;
    }
    AddRow({static_cast<int>(i), false, headroom}, bound, result);
    if (recovers) AddRow({static_cast<int>(i), true, headroom}, rest + growth, result);
  }
  result.activity.rows = work.qp.num_rows;
}

/// The rows that were active at the last tick, found again by what they are about.
void SafetyFilter::FillGuess(const ProximitySet& set, const FilterActivity& last,
                             FilterSolution& result) const {
  FilterSolution::Workspace& work = *result.workspace;
  using Kind = qp::QpActive::Kind;
  auto& guess = work.solution.active;
  guess.clear();
  for (int b = 0; b < last.num_bounds; ++b) {
    const FilterBound& bound = last.bounds[b];
    if (bound.kind == FilterBound::Kind::kUnmovable) continue;
    if (bound.kind == FilterBound::Kind::kLower || bound.kind == FilterBound::Kind::kUpper) {
      const auto& names = model_->position_names();
      const auto joint = std::find(names.begin(), names.end(), bound.link);
      const Kind kind = bound.kind == FilterBound::Kind::kLower ? Kind::kLower : Kind::kUpper;
      guess.push_back({kind, static_cast<int>(joint - names.begin()), 0.0, 0.0});
      continue;
    }
    const bool recovery = bound.kind == FilterBound::Kind::kRecovery;
    for (std::size_t i = 0; i < work.rows.size(); ++i) {
      const Proximity& proximity = set.proximities[work.rows[i].proximity];
      if (work.rows[i].recovery == recovery && proximity.link == bound.link &&
          proximity.obstacle == bound.obstacle) {
        guess.push_back({Kind::kRow, static_cast<int>(i), 0.0, 0.0});
        break;
      }
    }
  }
}

double SafetyFilter::TickMargin(double turn, double reach, double obstacle_speed) const {
  const double bend = turn * turn * reach + 2.0 * turn * obstacle_speed;
  const double gain = params_.form == Form::kLinear
                          ? std::min(params_.approach_gain, params_.recovery_gain)
                          : params_.recovery_gain;
  return 0.5 * params_.period.seconds() * bend / gain;
}

double SafetyFilter::Reach() const {
  // Along each link's chain of joints, to the far side of its solids.
  std::vector<double> from_base(model_->links().size(), 0.0);
  double reach = 0.0;
  for (int i = 1; i < model_->num_links(); ++i) {
    const robot::Joint& joint = model_->joints()[i - 1];
    const bool first = model_->body(joint.parent_link) < 0;
    from_base[i] = first ? 0.0 : from_base[joint.parent_link] + joint.X_PJ.translation().norm();
    reach = std::max(reach, from_base[i]);
  }
  for (const LinkCollider& link : MakeLinkColliders(*model_)) {
    reach = std::max(reach, from_base[link.number] + link.centre.norm() + link.radius);
  }
  return reach;
}

void SafetyFilter::Report(const ProximitySet& set, Poses X_WL, FilterSolution& result) const {
  const FilterSolution::Workspace& work = *result.workspace;
  FilterActivity& report = result.activity;
  report.status = work.solution.status;
  const bool valid = report.status != qp::QpStatus::kInvalid;
  report.kkt_residual = valid ? work.solution.kkt_residual : 0.0;
  report.gap = valid ? work.solution.gap : 0.0;
  for (const Proximity& proximity : set.proximities) {
    double reach = 0.0;
    for (const int body : model_->bodies()) {
      reach = std::max(reach, (proximity.point_on_link - X_WL[body].translation()).norm());
    }
    report.margin = std::max(report.margin, TickMargin(result.velocity.cwiseAbs().sum(), reach,
                                                       proximity.obstacle_velocity.norm()));
  }
  for (const qp::QpActive& active : work.solution.active) {
    FilterBound bound;
    bound.multiplier = active.multiplier;
    bound.slack = active.slack;
    if (active.kind == qp::QpActive::Kind::kRow) {
      const FilterRow& row = work.rows[static_cast<std::size_t>(active.index)];
      const Proximity& proximity = set.proximities[row.proximity];
      bound.kind = row.recovery ? FilterBound::Kind::kRecovery : FilterBound::Kind::kDistance;
      bound.link = proximity.link;
      bound.obstacle = proximity.obstacle;
      if (!row.recovery) report.slack = std::max(report.slack, active.slack);
    } else {
      const bool lower = active.kind == qp::QpActive::Kind::kLower;
      const motion::VelocityRange& range = work.box[static_cast<std::size_t>(active.index)];
      bound.kind = lower ? FilterBound::Kind::kLower : FilterBound::Kind::kUpper;
      bound.link = model_->position_names()[static_cast<std::size_t>(active.index)];
      bound.limit = lower ? range.lower_limit : range.upper_limit;
    }
    report.Add(bound);
  }
  for (const FilterBound& bound : work.unmovable) report.Add(bound);
}

}  // namespace oca::systems
