// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/barrier_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "oca/models/motion/following.h"
#include "oca/models/robot/link_colliders.h"
#include "oca/models/robot/motion_limits.h"
#include "oca/models/robot/robot_model.h"

namespace oca::robot {
namespace {

// A way that is as good as none (rad, m).
constexpr double kNoWay = 0.05;
// Bounds a velocity that nothing else does, so that the problem is finite (rad/s, m/s).
constexpr double kFastest = 1e3;
// Of a joint's velocity limit, at most kFastest: a wish beyond it is cut, for one without bound
// would pay any price for slack.
constexpr double kFastestWish = 10.0;
// Of a row, times the reach; a slider's: times 1.
constexpr double kLeastLever = 1e-12;

/// How far a slide carries what is beyond it; one without end has no such length, and counts none.
double SlideOf(const Joint& joint) {
  if (joint.type != JointType::kPrismatic) return 0.0;
  const double slide = std::max(std::abs(joint.lower_limit), std::abs(joint.upper_limit));
  return std::isfinite(slide) ? slide : 0.0;
}

/// No point of the arm is farther than this from a joint before it that turns.
double ReachOf(const RobotModel& model) {
  // Along each link's chain of joints, to the far side of its solids.
  std::vector<double> from_base(model.links().size(), 0.0);
  double reach = 0.0;
  for (int i = 1; i < model.num_links(); ++i) {
    const Joint& joint = model.joints()[i - 1];
    const bool first = model.body(joint.parent_link) < 0;
    if (!first) {
      from_base[i] =
          from_base[joint.parent_link] + joint.X_PJ.translation().norm() + SlideOf(joint);
    }
    reach = std::max(reach, from_base[i]);
  }
  for (const LinkCollider& link : LinkCollidersOf(model)) {
    reach = std::max(reach, from_base[link.number] + link.centre.norm() + link.radius);
  }
  return reach;
}

Eigen::VectorXd LeastEntries(const RobotModel& model, double reach) {
  Eigen::VectorXd least = Eigen::VectorXd::Zero(model.num_positions());
  for (const KinematicStep& step : model.steps()) {
    if (step.column < 0) continue;
    const double lever = step.type == JointType::kPrismatic ? 1.0 : reach;
    least[step.column] =
        std::max(least[step.column], kLeastLever * std::abs(step.multiplier) * lever);
  }
  return least;
}

}  // namespace

BarrierFilter::Solution::Workspace::Workspace(int num_positions, int most_rows)
    : qp(num_positions, most_rows),
      solver(num_positions, most_rows),
      solution(qp),
      box(static_cast<std::size_t>(num_positions)),
      row(Eigen::VectorXd::Zero(num_positions)) {
  rows.reserve(static_cast<std::size_t>(most_rows));
  unmovable.reserve(FilterActivity::kMostBounds);
}

BarrierFilter::BarrierFilter(std::shared_ptr<const RobotModel> model, BarrierSettings settings)
    : model_(std::move(model)),
      settings_(std::move(settings)),
      reach_(ReachOf(*model_)),
      least_entries_(LeastEntries(*model_, reach_)) {}

void BarrierFilter::Solve(const Tick& tick, Solution& result) const {
  if (!result.workspace_) {
    result.workspace_.emplace(model_->num_positions(), settings_.most_rows);
    result.velocity.resize(model_->num_positions());
  }
  Solution::Workspace& work = *result.workspace_;
  result.activity = {};
  FillBox(result);
  FillWish(tick, result);
  FillRows(tick, result);
  FillGuess(tick, result);
  work.solver.Solve(work.qp, work.solution);
  result.velocity = work.solution.u;
  if (work.solution.status != qp::QpStatus::kOptimal) Brake(result);
  Report(tick, result);
}

double BarrierFilter::Approach(double headroom) const {
  if (headroom <= 0.0) return 0.0;
  if (settings_.form == BarrierSettings::Form::kLinear) return settings_.approach_gain * headroom;
  return motion::LargestStoppableVelocity(headroom, settings_.deceleration, settings_.period);
}

void BarrierFilter::FillBox(Solution& result) const {
  Solution::Workspace& work = *result.workspace_;
  const double dt = settings_.period;
  for (Eigen::Index j = 0; j < model_->num_positions(); ++j) {
    const motion::JointMotion motion{result.command[j], result.last_velocity[j], 0.0};
    motion::JointLimits limits = LimitsOf(*model_, j);
    limits.jerk = kUnlimited;  // a MotionLimiter's task
    limits.velocity = std::min(limits.velocity, kFastest);
    motion::VelocityRange& range = work.box[static_cast<std::size_t>(j)];
    range = motion::StoppableVelocities(limits, motion, dt);
    work.qp.lower[j] = range.lower;
    work.qp.upper[j] = range.upper;
    if (range.yields != motion::MotionLimit::kNone) ++result.activity.yields;
  }
}

void BarrierFilter::FillWish(const Tick& tick, Solution& result) const {
  Solution::Workspace& work = *result.workspace_;
  const double dt = settings_.period;
  for (Eigen::Index j = 0; j < tick.position.size(); ++j) {
    const motion::JointRequest joint{tick.position[j], tick.velocity ? (*tick.velocity)[j] : 0.0,
                                     tick.acceleration ? (*tick.acceleration)[j] : 0.0};
    work.qp.wish[j] = motion::FollowingVelocity(joint, result.command[j], settings_.position_gain,
                                                model_->acceleration_limits()[j], dt);
    const double fastest = std::min(kFastestWish * model_->velocity_limits()[j], kFastest);
    work.qp.wish[j] = std::clamp(work.qp.wish[j], -fastest, fastest);
  }
  const double most = tick.way.maxCoeff() + kNoWay;
  for (Eigen::Index j = 0; j < tick.way.size(); ++j) {
    const double share = tick.way[j] / most;
    work.qp.weights[j] = settings_.weights[j] * (1.0 + settings_.progress_weight * share);
  }
}

bool BarrierFilter::Moves(const Eigen::VectorXd& row) const {
  return !(row.array().abs() < least_entries_.array()).all();  // what is no number moves too
}

void BarrierFilter::LeaveOut(const Proximity& proximity, double lack, Solution& result) const {
  auto& unmovable = result.workspace_->unmovable;
  if (!(lack > 0.0) || unmovable.size() == unmovable.capacity()) return;
  FilterBound bound;
  bound.kind = FilterBound::Kind::kUnmovable;
  bound.link = proximity.link;
  bound.obstacle = proximity.obstacle;
  bound.slack = lack;
  unmovable.push_back(bound);
}

/// To rest as fast as the box lets every joint.
void BarrierFilter::Brake(Solution& result) const {
  const qp::ProjectionQp& qp = result.workspace_->qp;
  result.velocity.setZero();
  result.velocity = result.velocity.cwiseMax(qp.lower).cwiseMin(qp.upper);
}

void BarrierFilter::AddRow(const Solution::Row& source, double bound, Solution& result) const {
  Solution::Workspace& work = *result.workspace_;
  const auto reach =
      work.row.cwiseProduct(work.qp.lower).cwiseMin(work.row.cwiseProduct(work.qp.upper));
  if (reach.sum() >= bound) return;  // every velocity of the box keeps it
  auto at = static_cast<std::size_t>(work.qp.num_rows);
  if (work.qp.num_rows < settings_.most_rows) {
    work.rows.push_back(source);
    ++work.qp.num_rows;
  } else {
    ++result.activity.dropped;
    const auto farthest = std::max_element(
        work.rows.begin(), work.rows.end(),
        [](const Solution::Row& a, const Solution::Row& b) { return a.headroom < b.headroom; });
    if (farthest->headroom <= source.headroom) return;
    *farthest = source;
    at = static_cast<std::size_t>(farthest - work.rows.begin());
  }
  const auto row = static_cast<Eigen::Index>(at);
  work.qp.rows.row(row) = work.row.transpose();
  work.qp.bounds[row] = bound;
  work.qp.penalties[row] = source.recovery ? settings_.recovery_penalty : settings_.slack_penalty;
}

void BarrierFilter::FillRows(const Tick& tick, Solution& result) const {
  const ProximitySet& set = tick.proximities;
  Solution::Workspace& work = *result.workspace_;
  work.rows.clear();
  work.unmovable.clear();
  work.qp.num_rows = 0;
  result.witnesses = tick.witnesses;
  result.witnesses.Move(settings_.period, set);
  for (std::size_t i = 0; i < set.proximities.size(); ++i) {
    FillRowsOf(static_cast<int>(i), set.proximities[i], true, tick, result);
  }
  const std::size_t of_nearest = work.rows.size();
  for (const WitnessPair& pair : result.witnesses.pairs()) {
    const auto at = std::find_if(set.proximities.begin(), set.proximities.end(),
                                 [&](const Proximity& each) { return pair.IsOf(each); });
    const Proximity between = Between(*model_, tick.X_WL, pair, *at);
    if (!(between.normal.dot(at->normal) > 0.0)) continue;  // one went through the other
    if (work.qp.num_rows + 2 > settings_.most_rows) break;
    FillRowsOf(static_cast<int>(at - set.proximities.begin()), between, false, tick, result);
  }
  for (std::size_t r = 0; r < of_nearest; ++r) {
    const Proximity& proximity = set.proximities[work.rows[r].proximity];
    if (!work.rows[r].recovery && proximity.distance > 0.0) {
      result.witnesses.Keep(*model_, tick.X_WL, proximity);
    }
  }
  result.activity.rows = work.qp.num_rows;
}

/// The rows of the distance between two points of the bodies of proximity `number`. Only the
/// nearest ones recover: bodies that many points stand for would outweigh others.
void BarrierFilter::FillRowsOf(int number, const Proximity& proximity, bool nearest,
                               const Tick& tick, Solution& result) const {
  Eigen::VectorXd& row = result.workspace_->row;
  DistanceRow(*model_, tick.X_WL, proximity, row);
  const double headroom = proximity.distance - std::min(settings_.safe_distance, proximity.range);
  const double rest = proximity.normal.dot(proximity.obstacle_velocity);
  double bound = rest - Approach(headroom);
  const bool known =
      tick.clear != nullptr &&
      tick.clear->ClearFor(proximity.obstacle, !proximity.own_link.empty()) > settings_.trust_time;
  if (known) bound = std::min(bound, row.dot(result.workspace_->qp.wish));
  const bool recovers = headroom < 0.0 && !known && nearest;
  const double growth = std::min(-settings_.recovery_gain * headroom, settings_.recovery_speed);
  if (!Moves(row)) {
    if (nearest) LeaveOut(proximity, recovers ? rest + growth : bound, result);
    return;
  }
  AddRow({number, false, headroom}, bound, result);
  if (recovers) AddRow({number, true, headroom}, rest + growth, result);
}

/// The rows that were active at the last tick, found again by what they are about.
void BarrierFilter::FillGuess(const Tick& tick, Solution& result) const {
  const FilterActivity& last = tick.last;
  Solution::Workspace& work = *result.workspace_;
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
      const Proximity& proximity = tick.proximities.proximities[work.rows[i].proximity];
      if (work.rows[i].recovery == recovery && proximity.link == bound.link &&
          proximity.obstacle == bound.obstacle) {
        guess.push_back({Kind::kRow, static_cast<int>(i), 0.0, 0.0});
        break;
      }
    }
  }
}

double BarrierFilter::TickMargin(double turn, double reach, double obstacle_speed) const {
  const double bend = turn * turn * reach + 2.0 * turn * obstacle_speed;
  const double gain = settings_.form == BarrierSettings::Form::kLinear
                          ? std::min(settings_.approach_gain, settings_.recovery_gain)
                          : settings_.recovery_gain;
  return 0.5 * settings_.period * bend / gain;
}

void BarrierFilter::Report(const Tick& tick, Solution& result) const {
  const ProximitySet& set = tick.proximities;
  const Solution::Workspace& work = *result.workspace_;
  FilterActivity& report = result.activity;
  report.status = work.solution.status;
  const bool valid = report.status != qp::QpStatus::kInvalid;
  report.kkt_residual = valid ? work.solution.kkt_residual : 0.0;
  report.gap = valid ? work.solution.gap : 0.0;
  for (const Proximity& proximity : set.proximities) {
    double reach = 0.0;
    for (const int body : model_->bodies()) {
      reach = std::max(reach, (proximity.point_on_link - tick.X_WL[body].translation()).norm());
    }
    report.margin = std::max(report.margin, TickMargin(result.velocity.cwiseAbs().sum(), reach,
                                                       proximity.obstacle_velocity.norm()));
  }
  for (const qp::QpActive& active : work.solution.active) {
    FilterBound bound;
    bound.multiplier = active.multiplier;
    bound.slack = active.slack;
    if (active.kind == qp::QpActive::Kind::kRow) {
      const Solution::Row& row = work.rows[static_cast<std::size_t>(active.index)];
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

}  // namespace oca::robot
