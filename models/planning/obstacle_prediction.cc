// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/obstacle_prediction.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace oca::planning {
namespace {

using Eigen::Vector3d;
using geometry::Obstacle;
using geometry::ObstacleEstimate;

constexpr double kSameSpeed = 1e-6;     // m/s, rad/s: stands
constexpr double kSamePlace = 1e-4;     // m, of an obstacle that stands
constexpr double kForeseen = 0.005;     // m; that what was foreseen may be wrong by,
constexpr double kForeseenSpan = 0.3;   // s; after so long too
constexpr double kForeseenLever = 0.5;  // m; at which a turn counts

constexpr double kFades = 0.5;      // s; an acceleration along the way
constexpr double kMostTurn = 2.0;   // rad
constexpr double kSlow = 0.1;       // m/s; below it no turn is foreseen
constexpr double kLike = 2.5;       // m/s^2; from gravity's acceleration, of what falls
constexpr double kMostRate = 20.0;  // m/s^2; more is a jump of the velocity
constexpr double kSameRate = 1.0;   // m/s^2; two looks agree,
constexpr double kSameShare = 0.2;  // to within this and this share
const Vector3d kGravity(0.0, 0.0, -9.81);

/// How far a body gets that has speed v and an acceleration a that fades, and how fast it is then;
/// one that brakes stops.
struct Run {
  double way;
  double speed;
};
Run RunAhead(double v, double a, double t) {
  if (a < 0.0 && v < -a * kFades) t = std::min(t, -kFades * std::log(1.0 + v / (a * kFades)));
  const double faded = 1.0 - std::exp(-t / kFades);
  return {v * t + a * kFades * (t - kFades * faded), v + a * kFades * faded};
}

/// The way and the velocity after t, on the arc that v and a begin.
void OnArc(const Vector3d& v, const Vector3d& a, double t, Vector3d& way, Vector3d& velocity) {
  const double speed = v.norm();
  const Vector3d along = v / speed;
  const Run run = RunAhead(speed, a.dot(along), t);
  const Vector3d across = a - a.dot(along) * along;
  const double rate = across.norm() / speed;
  const double angle = std::min(rate * t, kMostTurn);
  way = run.way * along;
  velocity = run.speed * along;
  if (angle < 1e-3) return;
  const Vector3d left = across.normalized();
  const Vector3d then = std::cos(angle) * along + std::sin(angle) * left;
  const double mean = run.way / t;
  way = mean / rate * (std::sin(angle) * along + (1.0 - std::cos(angle)) * left) +
        mean * (t - angle / rate) * then;
  velocity = run.speed * then;
}

/// The larger uncertainty of any direction, m.
double Slack(const Eigen::Matrix3d& covariance) {
  return geometry::kConfidence * std::sqrt(covariance.trace());
}

Eigen::Matrix3d Turned(const Obstacle& obstacle, double ahead) {
  const double angle = ahead * obstacle.angular.norm();
  if (!(angle > 0.0)) return obstacle.X_WO.linear();
  return Eigen::AngleAxisd(angle, obstacle.angular.normalized()) * obstacle.X_WO.linear();
}

}  // namespace

bool Stands(const Obstacle& obstacle) {
  return obstacle.velocity_known && obstacle.linear.norm() < kSameSpeed &&
         obstacle.angular.norm() < kSameSpeed;
}

Eigen::Isometry3d Foreseen(const Obstacle& obstacle, double ahead) {
  Eigen::Isometry3d X = obstacle.X_WO;
  X.translation() += ahead * obstacle.linear;
  X.linear() = Turned(obstacle, ahead);
  return X;
}

LikelyState LikelyAhead(const Obstacle& obstacle, const ObstacleEstimate& estimate, double ahead) {
  LikelyState state{Foreseen(obstacle, ahead), obstacle.linear};
  const Vector3d& v = obstacle.linear;
  const Vector3d& a = estimate.acceleration;
  if (!(ahead > 0.0) || a.isZero(0.0)) return state;
  const Vector3d here = obstacle.X_WO.translation();
  if ((a - kGravity).norm() < kLike) {
    state.X_WO.translation() = here + ahead * v + 0.5 * ahead * ahead * a;
    state.linear = v + ahead * a;
    return state;
  }
  Vector3d way;
  if (v.norm() < kSlow) {
    const double faded = 1.0 - std::exp(-ahead / kFades);
    way = ahead * v + kFades * (ahead - kFades * faded) * a;
    state.linear = v + kFades * faded * a;
  } else {
    OnArc(v, a, ahead, way, state.linear);
  }
  state.X_WO.translation() = here + way;
  return state;
}

std::vector<ObstacleEstimate> Accelerations(const std::vector<Obstacle>& before,
                                            const std::vector<Obstacle>& now, double dt,
                                            VelocityChanges& changes) {
  std::vector<ObstacleEstimate> estimates(now.size());
  VelocityChanges next;
  bool any = false;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const geometry::ObstacleBody* const body = now[i].body.get();
    const auto seen = std::find_if(before.begin(), before.end(),
                                   [&](const Obstacle& o) { return o.body.get() == body; });
    Vector3d rate = Vector3d::Zero();
    if (seen != before.end() && now[i].velocity_known && seen->velocity_known && dt > 0.0) {
      rate = (now[i].linear - seen->linear) / dt;
    }
    if (!(rate.norm() <= kMostRate)) rate.setZero();
    next.bodies.push_back(body);
    next.rates.push_back(rate);
    const bool falls = (rate - kGravity).norm() <= kSameRate;  // what else would change so?
    const auto last = std::find(changes.bodies.begin(), changes.bodies.end(), body);
    if (rate.isZero(0.0) || (!falls && last == changes.bodies.end())) continue;
    if (!falls) {
      const auto at = static_cast<std::size_t>(last - changes.bodies.begin());
      const Vector3d& earlier = changes.rates[at];
      const double same = kSameRate + kSameShare * rate.norm();
      if (earlier.isZero(0.0) || (rate - earlier).norm() > same) continue;
    }
    estimates[i].acceleration = rate;
    any = true;
  }
  changes = std::move(next);
  if (!any) estimates.clear();
  return estimates;
}

Eigen::Matrix3d CovarianceAhead(const ObstacleEstimate& estimate, double ahead) {
  return estimate.PositionCovariance(std::clamp(ahead, 0.0, kForeseenSpan));
}

bool SameStanding(const std::vector<Obstacle>& seen, const std::vector<Obstacle>& now,
                  std::span<const ObstacleEstimate> estimates) {
  if (seen.size() != now.size()) return false;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Obstacle& a = seen[i];
    const Obstacle& b = now[i];
    const double slack = estimates.empty() ? 0.0 : Slack(estimates[i].PositionCovariance());
    if (a.body != b.body || !Stands(b) || !Stands(a) ||
        !((a.X_WO.matrix() - b.X_WO.matrix()).cwiseAbs().maxCoeff() < kSamePlace + slack)) {
      return false;
    }
  }
  return true;
}

bool AsForeseen(const SeenObstacles& seen, const SeenObstacles& now, double since) {
  if (seen.obstacles.size() != now.obstacles.size()) return false;
  for (std::size_t i = 0; i < now.obstacles.size(); ++i) {
    const Obstacle& then = seen.obstacles[i];
    const Obstacle& here = now.obstacles[i];
    if (then.body != here.body || !then.velocity_known || !here.velocity_known) return false;
    const LikelyState likely = seen.estimates.empty()
                                   ? LikelyState{Foreseen(then, since), then.linear}
                                   : LikelyAhead(then, seen.estimates[i], since);
    const double slack =
        now.estimates.empty() ? 0.0 : Slack(CovarianceAhead(now.estimates[i], kForeseenSpan));
    const double away = (likely.X_WO.translation() - here.X_WO.translation()).norm() +
                        (likely.X_WO.linear() - here.X_WO.linear()).norm() * kForeseenLever;
    const double faster = (likely.linear - here.linear).norm() +
                          (then.angular - here.angular).norm() * kForeseenLever;
    if (!(away + kForeseenSpan * faster < kForeseen + slack)) return false;
  }
  return true;
}

}  // namespace oca::planning
