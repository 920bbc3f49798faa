// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_optimizer.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "oca/models/geometry/obstacle.h"
#include "oca/models/planning/smooth_step.h"

namespace oca::planning {
namespace {

// Between samples of an interval, s: where intervals are short something is about to happen.
constexpr double kShortInterval = 0.15;
constexpr double kShortSpacing = 0.05;
constexpr double kLongSpacing = 0.125;

constexpr double kPositionInset = 0.02;  // rad, m; that bands stay away from position limits
constexpr double kPositionUnit = 0.1;    // rad, m
constexpr double kLeastUnit = 1e-6;      // rad/s, m/s and so on; of a limit that is nearly 0
constexpr double kReturnRamp = 0.2;      // s

/// How far `x` is above the range, or, negative, below it.
double Excess(double x, double lower, double upper) {
  return std::max(x - upper, 0.0) + std::min(x - lower, 0.0);
}

}  // namespace

bool Moves(std::span<const BandBody> bodies) {
  return std::any_of(bodies.begin(), bodies.end(),
                     [](const BandBody& body) { return !body.stands; });
}

BandOptimizer::BandOptimizer(const robot::Clearance& arm, const BandSettings& settings,
                             const robot::OwnRanges& own)
    : settings_(settings), clearance_(arm) {
  clearance_.KeepOwn(own, settings_.clear_distance);
  const Eigen::Index n = model().num_positions();
  ahead_.resize(n, BatchClearance::kLanes);
  q_.setZero(n);
  row_.setZero(n);
  H_.setZero(n, n);
  for (int d = 0; d < 3; ++d) {
    g_[d].setZero(n);
    d_[d].setZero(n);
  }
}

int BandOptimizer::Variable(int control) const {
  if (control < 3) return -1;
  if (control < num_controls_ - 3) return control - 3;
  return end_fixed_ ? -1 : num_controls_ - 6;
}

void BandOptimizer::Prepare(const BandCurve& curve, const BandRequest& request,
                            std::span<const BandBody> bodies, bool end_fixed, double from) {
  left_.clear();
  returns_ = false;
  bodies_.assign(bodies.begin(), bodies.end());
  something_near_ = !bodies_.empty() || clearance_.self_collision();
  std::vector<robot::PlacedBody> placed;
  from = std::max(from, curve.start());
  for (const BandBody& body : bodies_) placed.push_back(body.At(from));
  clearance_.SetBodies(std::move(placed));
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    for (const int link : bodies_[b].ignored) clearance_.Ignore(link, static_cast<int>(b));
  }
  moving_.clear();
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].stands) moving_.push_back(static_cast<int>(b));
  }
  batch_.reset();
  num_controls_ = static_cast<int>(curve.controls().cols());
  FixEnd(end_fixed);
  AddSamples(curve, request, from);
  start_.resize(curve.size());
  curve.Evaluate(from, 0, start_);
  start_ += checks_.front().request[0];
}

void BandOptimizer::FixEnd(bool fixed) {
  end_fixed_ = fixed;
  num_variables_ = num_controls_ - 6 + (fixed ? 0 : 1);
}

void BandOptimizer::AddSamples(const BandCurve& curve, const BandRequest& request, double from) {
  samples_.clear();
  checks_.clear();
  poses_.clear();
  balls_.clear();
  std::vector<double> times = curve.times();
  times.erase(times.begin(), std::prev(std::upper_bound(times.begin(), times.end() - 1, from)));
  times.front() = from;
  checks_.push_back(MakeSample(curve, request, times.front(), 0.0));
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double length = times[i + 1] - times[i];
    const double spacing = length < kShortInterval ? kShortSpacing : kLongSpacing;
    const int count = std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-6)));
    const double step = length / count;
    for (int k = 0; k < count; ++k) {
      const double start = times[i] + k * step;
      samples_.push_back(MakeSample(curve, request, start + 0.5 * step, step));
      checks_.push_back(MakeSample(curve, request, start + 0.5 * step, 0.5 * step));
      checks_.push_back(MakeSample(curve, request, start + step, 0.5 * step));
    }
  }
}

BandOptimizer::Sample BandOptimizer::MakeSample(const BandCurve& curve, const BandRequest& request,
                                                double time, double weight) {
  Sample sample{time,
                weight,
                curve.BasisAt(time),
                static_cast<int>(poses_.size()),
                static_cast<int>(balls_.size()),
                {}};
  for (int d = 0; d < 3; ++d) {
    sample.request[d].resize(curve.size());
    request(time, d, sample.request[d]);
  }
  for (const BandBody& body : bodies_) {
    poses_.push_back(body.pose(time));
    if (body.stands) continue;
    double radius = body.collider->bounding_radius();
    if (body.covariance) {
      radius += geometry::kConfidence * std::sqrt(std::max(body.covariance(time).trace(), 0.0));
    }
    balls_.push_back({poses_.back() * body.collider->centre(), radius});
  }
  return sample;
}

void BandOptimizer::AddClearance(bool rows) {
  for (const robot::NearPair& pair : pairs_) {
    const double wanted =
        Flies(pair) ? settings_.margin : std::min(settings_.margin, LeftByGoal(pair));
    const double lacking = wanted - pair.distance;
    if (!(lacking > 0.0)) continue;
    cost_ += settings_.clearance * lacking * lacking;
    if (!rows) continue;
    clearance_.Gradient(pair, row_);
    if (wanted < settings_.margin) {  // what is wanted falls towards the goal
      const double away = (q_ - yield_goal_).norm();
      if (away > 0.0) row_ -= kYieldSlope / away * (q_ - yield_goal_);
    }
    H_.noalias() += settings_.clearance * row_ * row_.transpose();
    g_[0].noalias() -= settings_.clearance * lacking * row_;
  }
}

BandOptimizer::Range BandOptimizer::RangeOf(Eigen::Index joint, int derivative,
                                            double share) const {
  if (derivative > 0) {
    const double limit =
        derivative == 1 ? model().velocity_limits()[joint] : model().acceleration_limits()[joint];
    return {-share * limit, share * limit, std::max(limit, kLeastUnit)};
  }
  const double lower = model().lower_limits()[joint];
  const double upper = model().upper_limits()[joint];
  if (share == 1.0) return {lower, upper, kPositionUnit};
  // Halves, for the width of a range that nobody measured overflows.
  const double inset = std::min(kPositionInset, 0.5 * upper - 0.5 * lower);
  return {lower + inset, upper - inset, kPositionUnit};
}

double BandOptimizer::AddedExcess(const Sample& sample, const BandCurve& curve) const {
  double largest = 0.0;
  Eigen::VectorXd x(q_.size());
  for (int d = 0; d < 3; ++d) {
    curve.Evaluate(sample.time, d, x);
    for (Eigen::Index j = 0; j < x.size(); ++j) {
      Range range = RangeOf(j, d, 1.0);
      if (d == 0) {  // an arm that is beyond a limit may come back
        range.lower = std::min(range.lower, start_[j]);
        range.upper = std::max(range.upper, start_[j]);
      }
      const double requested = sample.request[d][j];
      const double own = std::fabs(Excess(requested, range.lower, range.upper));
      const double all = std::fabs(Excess(requested + x[j], range.lower, range.upper));
      if (all > own) largest = std::max(largest, (all - own) / range.unit);
    }
  }
  return largest;
}

double BandOptimizer::NearnessAt(double time) const {
  if (!returns_) return settings_.nearness;
  double share = 1.0;
  for (const auto& [first, last] : near_) {
    const double begun = SmoothStep((time - first + before_ + kReturnRamp) / kReturnRamp);
    share = std::min(share, 1.0 - begun * SmoothStep((last - time) / kReturnRamp));
  }
  return settings_.nearness + share * (settings_.return_nearness - settings_.nearness);
}

void BandOptimizer::AddDiagonal(const Sample& sample, const Eigen::VectorXd x[3]) {
  const double price = settings_.limits;
  const double nearness = NearnessAt(sample.time);
  for (Eigen::Index j = 0; j < q_.size(); ++j) {
    cost_ += nearness * x[0][j] * x[0][j] + settings_.smoothness * x[2][j] * x[2][j];
    d_[0][j] += nearness;
    g_[0][j] += nearness * x[0][j];
    cost_ += settings_.calm * x[1][j] * x[1][j];
    d_[1][j] += settings_.calm;
    g_[1][j] += settings_.calm * x[1][j];
    d_[2][j] += settings_.smoothness;
    g_[2][j] += settings_.smoothness * x[2][j];
    for (int d = 0; d < 3; ++d) {
      const Range range = RangeOf(j, d, settings_.limit_share);
      const double excess = Excess(sample.request[d][j] + x[d][j], range.lower, range.upper);
      if (excess == 0.0) continue;
      cost_ += price * excess * excess / (range.unit * range.unit);
      d_[d][j] += price / (range.unit * range.unit);
      g_[d][j] += price * excess / (range.unit * range.unit);
    }
  }
}

void BandOptimizer::Assemble(const Sample& sample, Normal& normal) const {
  const Eigen::Index n = q_.size();
  for (int a = 0; a < 4; ++a) {
    const int row = Variable(sample.basis.first + a);
    if (row < 0) continue;
    double wa[3];
    for (int d = 0; d < 3; ++d) {
      wa[d] = sample.weight * sample.basis.weights[d][a];
      normal.right.segment(row * n, n).noalias() -= wa[d] * g_[d];
    }
    for (int b = 0; b < 4; ++b) {
      const int column = Variable(sample.basis.first + b);
      if (column < 0 || column > row) continue;
      Eigen::MatrixXd& block = normal.blocks[4 * row + row - column];
      block.noalias() += (wa[0] * sample.basis.weights[0][b]) * H_;
      for (int d = 0; d < 3; ++d) {
        block.diagonal() += (wa[d] * sample.basis.weights[d][b]) * d_[d];
      }
    }
  }
}

void BandOptimizer::Linearize(const Eigen::MatrixXd& controls, bool rows, Normal& normal) {
  const Eigen::Index n = q_.size();
  normal.cost = 0.0;
  if (rows) {
    normal.blocks.resize(4 * static_cast<std::size_t>(num_variables_));
    for (Eigen::MatrixXd& block : normal.blocks) block.setZero(n, n);
    normal.right.setZero(n * num_variables_);
  }
  Eigen::VectorXd x[3] = {Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n)};
  const auto deviation = [&](const Sample& sample, int derivative, Eigen::VectorXd& into) {
    into.setZero();
    for (int j = 0; j < 4; ++j) {
      into += sample.basis.weights[derivative][j] * controls.col(sample.basis.first + j);
    }
  };
  const auto all = static_cast<int>(samples_.size());
  for (int i = 0; i < all; ++i) {
    const int lane = i % BatchClearance::kLanes;
    if (lane == 0) {
      LookAhead(std::span(samples_).subspan(static_cast<std::size_t>(i)), settings_.margin,
                [&](const Sample& sample, Eigen::VectorXd& into) { deviation(sample, 0, into); });
    }
    const Sample& sample = samples_[static_cast<std::size_t>(i)];
    for (int d = 0; d < 3; ++d) {
      deviation(sample, d, x[d]);
      g_[d].setZero();
      d_[d].setZero();
    }
    H_.setZero();
    cost_ = 0.0;
    if (something_near_) {
      Visit(sample, lane, settings_.margin);
      AddClearance(rows);
    }
    AddDiagonal(sample, x);
    normal.cost += sample.weight * cost_;
    if (rows) Assemble(sample, normal);
  }
  if (end_fixed_) return;
  // A free end is pulled back as if the band stayed there for a second more.
  const auto end = controls.col(controls.cols() - 1);
  normal.cost += settings_.nearness * end.squaredNorm();
  if (!rows) return;
  normal.blocks[4 * (num_variables_ - 1)].diagonal().array() += settings_.nearness;
  normal.right.tail(n) -= settings_.nearness * end;
}

double BandOptimizer::Cost(const BandCurve& curve) {
  Normal normal;
  Linearize(curve.controls(), false, normal);
  return normal.cost;
}

Eigen::VectorXd BandOptimizer::HalfGradient(const BandCurve& curve) {
  Normal normal;
  Linearize(curve.controls(), true, normal);
  return -normal.right;
}

void BandOptimizer::PlaceAt(const Eigen::VectorXd& q, double time) {
  ++evaluations_;
  q_ = q;
  clearance_.MoveTo(q);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (bodies_[b].stands) continue;
    clearance_.MoveBody(static_cast<int>(b), bodies_[b].pose(time));
    if (bodies_[b].covariance) {
      clearance_.SetCovariance(static_cast<int>(b), bodies_[b].covariance(time));
    }
  }
}

bool BandOptimizer::DistanceGradient(const Eigen::VectorXd& q, double time, Eigen::VectorXd& row) {
  PlaceAt(q, time);
  const robot::NearPair pair = clearance_.Nearest(settings_.margin);
  if (!(pair.distance < settings_.margin)) return false;
  row.resize(q.size());
  clearance_.Gradient(pair, row);
  return true;
}

}  // namespace oca::planning
