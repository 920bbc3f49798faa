// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/motion_judge.h"

#include <algorithm>
#include <cmath>

namespace oca::planning {
namespace {

using Eigen::VectorXd;

constexpr double kShareRounding = 1.0 + 1e-9;  // of a share
constexpr double kKept = 2e-3;                 // m; what is nearer lacks something
constexpr double kUnit = 0.01;                 // m that lack count as much as a whole limit

std::vector<robot::PlacedBody> Placed(std::span<const BandBody> bodies) {
  std::vector<robot::PlacedBody> placed;
  for (const BandBody& body : bodies) placed.push_back({body.collider, body.pose(0.0)});
  return placed;
}

double Share(double x, double limit) {
  return std::isfinite(limit) && limit > 0.0 ? std::fabs(x) / limit : 0.0;
}

/// How far a position is from the middle of its range, 1 at a limit. A range without width is a
/// limit too, and beyond a range of one end or none the share is 2.
double PositionShare(double q, double lower, double upper) {
  if (!std::isfinite(upper - lower)) {
    const auto rounding = [](double limit) { return (kShareRounding - 1.0) * std::fabs(limit); };
    return q > upper + rounding(upper) || q < lower - rounding(lower) ? 2.0 : 0.0;
  }
  constexpr double kPoint = 1e-12;
  return std::fabs(q - 0.5 * (lower + upper)) / std::max(0.5 * (upper - lower), kPoint);
}

}  // namespace

bool MotionVerdict::within_limits() const {
  return position <= kShareRounding && speed <= kShareRounding && acceleration <= kShareRounding;
}

MotionJudge::MotionJudge(std::shared_ptr<const robot::RobotModel> model, BandRequest request,
                         std::span<const BandBody> bodies, bool self_collision,
                         std::span<const std::pair<int, int>> ignored, double reach)
    : model_(std::move(model)),
      request_(std::move(request)),
      bodies_(bodies.begin(), bodies.end()),
      reach_(reach),
      clearance_(model_, self_collision, Placed(bodies)) {
  for (const auto& [link, body] : ignored) clearance_.Ignore(link, body);
}

robot::NearPair MotionJudge::Nearest(const VectorXd& q, double time) {
  clearance_.MoveTo(q);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (!bodies_[b].stands) clearance_.MoveBody(static_cast<int>(b), bodies_[b].pose(time));
  }
  robot::NearPair nearest = clearance_.Nearest(reach_);
  nearest.distance = std::min(nearest.distance, reach_);
  return nearest;
}

double MotionJudge::Excess(const VectorXd motion[3], const VectorXd& start,
                           MotionVerdict& verdict) const {
  for (int d = 0; d < 3; ++d) {
    if (!motion[d].allFinite()) return verdict.position = robot::kUnlimited;
  }
  double excess = 0.0;
  const auto count = [&](double share, double& largest) {
    excess += std::max(share - kShareRounding, 0.0);
    largest = std::max(largest, share);
  };
  for (Eigen::Index j = 0; j < motion[0].size(); ++j) {
    // A limit that is broken at the start counts for what leads farther out.
    count(PositionShare(motion[0][j], std::min(model_->lower_limits()[j], start[j]),
                        std::max(model_->upper_limits()[j], start[j])),
          verdict.position);
    count(Share(motion[1][j], model_->velocity_limits()[j]), verdict.speed);
    count(Share(motion[2][j], model_->acceleration_limits()[j]), verdict.acceleration);
  }
  return excess;
}

MotionVerdict MotionJudge::Judge(const BandCurve& deviation, double duration, double step) {
  MotionVerdict verdict{.min_distance = reach_};
  VectorXd motion[3], start, request(model_->num_positions());
  const auto last = static_cast<long>(std::ceil(duration / step - 1e-9));
  for (long k = 0; k <= last; ++k) {
    const double time = std::min(static_cast<double>(k) * step, duration);
    for (int d = 0; d < 3; ++d) {
      motion[d].resize(model_->num_positions());
      deviation.Evaluate(time, d, motion[d]);
      if (k == last && d == 0) verdict.final_error = motion[0].cwiseAbs().maxCoeff();
      request_(time, d, request);
      motion[d] += request;
    }
    if (k == 0) start = motion[0];
    const robot::NearPair near = Nearest(motion[0], time);
    if (near.distance < verdict.min_distance) {
      verdict.min_distance = near.distance;
      verdict.time = time;
      verdict.link = model_->links()[near.link].name;
      verdict.body =
          near.body >= 0 ? bodies_[near.body].name : model_->links()[near.other_link].name;
    }
    const double lacking = Excess(motion, start, verdict) +
                           std::max(std::min(kKept, reach_) - near.distance, 0.0) / kUnit;
    if (!(lacking > 0.0)) continue;
    verdict.shortfall += step * lacking;
    if (verdict.troubles.empty() || time - verdict.troubles.back().second > kMotionPause) {
      verdict.troubles.emplace_back(time, time);
    }
    verdict.troubles.back().second = time;
  }
  return verdict;
}

}  // namespace oca::planning
