// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/sensing/body_filter.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace oca::sensing {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kGate = 21.11;        // of chi-square (3), 99.99 %
constexpr double kRestDensity = 1e-7;  // m^2/s; what rests may creep
constexpr double kSurelyRests = 0.9;
constexpr double kFastestTurn = 8.0;        // rad/s
constexpr double kSlow = 0.05;              // m/s; below it nothing is known of a turn
constexpr double kFirstAcceleration = 2.0;  // m/s^2; standard deviation
const Vector3d kGravity(0.0, 0.0, -9.81);   // m/s^2; z is up
constexpr int kRests = 0, kStraight = 1, kTurns = 2, kErratic = 3, kFalls = 4;
constexpr std::array kFirstWeights{0.5, 0.3, 0.05, 0.1, 0.05};

/// The same 3 x 3 of each axis, as a matrix of position, velocity, acceleration.
BodyTrack::Covariance OfAxes(const Matrix3d& of_one) {
  BodyTrack::Covariance all = BodyTrack::Covariance::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) all.block<3, 3>(3 * i, 3 * j).diagonal().setConstant(of_one(i, j));
  }
  return all;
}

/// exp(F dt) of p''' = -w^2 p'.
Matrix3d TurnTransition(double dt, double w) {
  const double angle = w * dt;
  const bool little = angle < 1e-4;
  const double s = little ? dt : std::sin(angle) / w;
  const double c = little ? 0.5 * dt * dt : (1.0 - std::cos(angle)) / (w * w);
  Matrix3d F;
  F << 1.0, s, c, 0.0, std::cos(angle), s, 0.0, -w * w * s, std::cos(angle);
  return F;
}

Matrix3d Transition(int mode, double dt, double turn) {
  if (mode == kTurns || mode == kErratic) return TurnTransition(dt, turn);
  Matrix3d F = Matrix3d::Zero();
  F(0, 0) = 1.0;
  if (mode != kRests) {
    F(0, 1) = dt;
    F(1, 1) = 1.0;
  }
  return F;
}

/// Of white noise of the mode's highest derivative over dt.
Matrix3d Noise(int mode, double dt, const BodyFilterSettings& settings) {
  const double dt2 = dt * dt;
  const double dt3 = dt2 * dt;
  Matrix3d Q = Matrix3d::Zero();
  if (mode == kRests) {
    Q(0, 0) = kRestDensity * dt;
  } else if (mode == kStraight || mode == kFalls) {
    Q.topLeftCorner<2, 2>() << dt3 / 3.0, dt2 / 2.0, dt2 / 2.0, dt;
    Q *= settings.acceleration_density;
  } else {
    Q << dt2 * dt3 / 20.0, dt2 * dt2 / 8.0, dt3 / 6.0, dt2 * dt2 / 8.0, dt3 / 3.0, dt2 / 2.0,
        dt3 / 6.0, dt2 / 2.0, dt;
    Q *= mode == kTurns ? settings.turning_density : settings.erratic_density;
  }
  return Q;
}

/// Mean and covariance of a mixture.
BodyTrack::Mode Moments(const std::array<BodyTrack::Mode, BodyTrack::kModes>& modes,
                        const std::array<double, BodyTrack::kModes>& weights) {
  BodyTrack::Mode all;
  for (int i = 0; i < BodyTrack::kModes; ++i) all.mean += weights[i] * modes[i].mean;
  for (int i = 0; i < BodyTrack::kModes; ++i) {
    const BodyTrack::Mean off = modes[i].mean - all.mean;
    all.covariance += weights[i] * (modes[i].covariance + off * off.transpose());
  }
  return all;
}

BodyTrack::Mode Moments(const std::array<BodyTrack::Mode, BodyTrack::kModes>& modes) {
  std::array<double, BodyTrack::kModes> weights;
  for (int i = 0; i < BodyTrack::kModes; ++i) weights[i] = modes[i].weight;
  return Moments(modes, weights);
}

Vector3d RotationVector(const Quaterniond& rotation) {
  const Quaterniond near = rotation.w() < 0.0 ? Quaterniond(-rotation.coeffs()) : rotation;
  const double sine = near.vec().norm();
  if (sine < 1e-12) return 2.0 * near.vec();
  return near.vec() * (2.0 * std::atan2(sine, near.w()) / sine);
}

Quaterniond Turned(const Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (angle == 0.0) return Quaterniond::Identity();
  return Quaterniond(Eigen::AngleAxisd(angle, rotation_vector / angle));
}

/// |v x a| / |v|^2, at which a velocity turns.
double TurnOf(const Vector3d& v, const Vector3d& a) {
  const double speed = v.norm();
  return speed < kSlow ? 0.0 : std::min(v.cross(a).norm() / (speed * speed), kFastestTurn);
}

/// By so much more the velocity may have changed `dt` before, m/s.
void Widen(double speed, double dt, BodyTrack::Covariance& P) {
  Matrix3d more = Matrix3d::Zero();
  more.topLeftCorner<2, 2>() << dt * dt, dt, dt, 1.0;
  P += OfAxes(speed * speed * more);
}

}  // namespace

void BodyFilter::Start(double time, const Eigen::Isometry3d& X_WO, BodyTrack& track) const {
  track = {};
  track.time = time;
  Matrix3d P = Matrix3d::Zero();
  P(0, 0) = settings_.position_noise * settings_.position_noise;
  for (int i = 0; i < BodyTrack::kModes; ++i) {
    BodyTrack::Mode& mode = track.modes[i];
    if (i != kRests) P(1, 1) = settings_.prior_speed * settings_.prior_speed;
    const bool any = i == kTurns || i == kErratic;
    P(2, 2) = any ? kFirstAcceleration * kFirstAcceleration : 0.0;
    mode.mean.head<3>() = X_WO.translation();
    mode.covariance = OfAxes(P);
    mode.weight = kFirstWeights[i];
  }
  track.rotation = Quaterniond(X_WO.linear());
  track.angle_covariance.diagonal() << settings_.angle_noise * settings_.angle_noise, 1.0;
}

BodyFilter::Modes BodyFilter::Mixed(const BodyTrack& track, double dt) const {
  constexpr int kOthers = BodyTrack::kModes - 1;
  const double steady = (1.0 - std::exp(-settings_.switching * dt)) / kOthers;
  const double brief = (1.0 - std::exp(-settings_.turning_end * dt)) / kOthers;
  Modes mixed;
  for (int to = 0; to < BodyTrack::kModes; ++to) {
    std::array<double, BodyTrack::kModes> shares;
    double total = 0.0;
    for (int from = 0; from < BodyTrack::kModes; ++from) {
      const double change = from >= kTurns ? brief : steady;
      shares[from] = track.modes[from].weight * (from == to ? 1.0 - kOthers * change : change);
      total += shares[from];
    }
    for (double& share : shares) share /= total;
    mixed[to] = Moments(track.modes, shares);
    mixed[to].weight = total;
  }
  return mixed;
}

void BodyFilter::Advance(double dt, double turn, Modes& modes) const {
  for (int i = 0; i < BodyTrack::kModes; ++i) {
    const BodyTrack::Covariance F = OfAxes(Transition(i, dt, turn));
    modes[i].mean = (F * modes[i].mean).eval();
    if (i == kFalls) {
      modes[i].mean.head<3>() += 0.5 * dt * dt * kGravity;
      modes[i].mean.segment<3>(3) += dt * kGravity;
      modes[i].mean.tail<3>() = kGravity;
    }
    modes[i].covariance =
        (F * modes[i].covariance * F.transpose()).eval() + OfAxes(Noise(i, dt, settings_));
  }
}

PoseUse BodyFilter::Update(double time, const Eigen::Isometry3d& X_WO, BodyTrack& track) const {
  const double dt = time - track.time;
  if (dt == 0.0) return PoseUse::kNotNew;
  if (!(dt > 0.0)) return PoseUse::kLate;
  Modes modes = Mixed(track, dt);
  Advance(dt, track.turn, modes);
  const BodyTrack::Mode all = Moments(modes);
  const double variance = settings_.position_noise * settings_.position_noise;
  const Vector3d innovation = X_WO.translation() - all.mean.head<3>();
  const Matrix3d S = all.covariance.topLeftCorner<3, 3>() + variance * Matrix3d::Identity();
  track.nis = innovation.dot(S.llt().solve(innovation));
  const bool turns = !(track.nis <= kGate);
  if (turns && innovation.norm() > settings_.fastest * dt) {
    const double since = time - track.doubted_at;
    const bool agrees = track.refused > 0 &&
                        (X_WO.translation() - track.doubted).norm() <= settings_.fastest * since;
    const double nis = track.nis;
    track.doubted = X_WO.translation();
    track.doubted_at = time;
    ++track.refused;
    if (!agrees) return PoseUse::kRefused;
    Start(time, X_WO, track);
    track.nis = nis;
    return PoseUse::kFirst;
  }
  if (turns) {
    for (int i = kStraight; i < BodyTrack::kModes; ++i)
      Widen(innovation.norm() / dt, dt, modes[i].covariance);
  }
  UpdatePosition(X_WO.translation(), track, modes);
  UpdateRotation(dt, Quaterniond(X_WO.linear()), track);
  track.time = time;
  track.refused = 0;
  return turns ? PoseUse::kTurn : PoseUse::kUsed;
}

void BodyFilter::UpdatePosition(const Vector3d& position, BodyTrack& track, Modes& modes) const {
  const double variance = settings_.position_noise * settings_.position_noise;
  std::array<double, BodyTrack::kModes> logs;
  for (int i = 0; i < BodyTrack::kModes; ++i) {
    BodyTrack::Mode& mode = modes[i];
    const Vector3d innovation = position - mode.mean.head<3>();
    const Matrix3d S = mode.covariance.topLeftCorner<3, 3>() + variance * Matrix3d::Identity();
    const Eigen::LLT<Matrix3d> factor(S);
    const Matrix3d L = factor.matrixL();
    logs[i] = -0.5 * innovation.dot(factor.solve(innovation)) - L.diagonal().array().log().sum();
    const Eigen::Matrix<double, 9, 3> PH = mode.covariance.leftCols<3>();
    const Eigen::Matrix<double, 9, 3> K = factor.solve(PH.transpose()).transpose();
    mode.mean += K * innovation;
    // (I - K H) P (I - K H)^T + K R K^T stays symmetric and positive.
    BodyTrack::Covariance A = BodyTrack::Covariance::Identity();
    A.leftCols<3>() -= K;
    mode.covariance =
        (A * mode.covariance * A.transpose()).eval() + variance * (K * K.transpose()).eval();
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double total = 0.0;
  for (int i = 0; i < BodyTrack::kModes; ++i) {
    modes[i].weight *= std::exp(logs[i] - most);
    total += modes[i].weight;
  }
  constexpr double kLeast = 1e-6;  // that none is ruled out for ever
  for (BodyTrack::Mode& mode : modes) mode.weight = std::max(mode.weight / total, kLeast);
  track.modes = modes;
  const BodyTrack::Mean& mean = track.modes[kTurns].mean;
  track.turn = TurnOf(mean.segment<3>(3), mean.tail<3>());
}

void BodyFilter::UpdateRotation(double dt, const Quaterniond& rotation, BodyTrack& track) const {
  Eigen::Matrix2d F, Q;
  F << 1.0, dt, 0.0, 1.0;
  Q << dt * dt * dt / 3.0, dt * dt / 2.0, dt * dt / 2.0, dt;
  track.rotation = Turned(dt * track.angular) * track.rotation;
  Eigen::Matrix2d P = F * track.angle_covariance * F.transpose() + settings_.spin_density * Q;
  const Vector3d innovation = RotationVector(rotation * track.rotation.conjugate());
  const double variance = settings_.angle_noise * settings_.angle_noise;
  if (innovation.squaredNorm() > kGate * (P(0, 0) + variance)) {
    const double jump = innovation.squaredNorm() / (dt * dt);
    P += jump * (Eigen::Matrix2d() << dt * dt, dt, dt, 1.0).finished();
  }
  const Eigen::Vector2d K = P.col(0) / (P(0, 0) + variance);
  track.rotation = (Turned(K[0] * innovation) * track.rotation).normalized();
  track.angular += K[1] * innovation;
  Eigen::Matrix2d A = Eigen::Matrix2d::Identity();
  A.col(0) -= K;
  track.angle_covariance = A * P * A.transpose() + variance * K * K.transpose();
}

void BodyFilter::Tell(const BodyTrack& track, double time, geometry::Obstacle& obstacle,
                      geometry::ObstacleEstimate& estimate) const {
  const double dt = std::max(time - track.time, 0.0);
  Modes modes = track.modes;
  Advance(dt, track.turn, modes);
  const BodyTrack::Mode all = Moments(modes);
  const bool rests = track.modes[kRests].weight > kSurelyRests;
  const bool spins = track.angular.squaredNorm() > 9.0 * track.angle_covariance(1, 1);
  obstacle.angular = spins ? track.angular : Vector3d::Zero();
  obstacle.X_WO.linear() = (Turned(dt * obstacle.angular) * track.rotation).toRotationMatrix();
  obstacle.X_WO.translation() = all.mean.head<3>();
  obstacle.linear = rests ? Vector3d::Zero() : Vector3d(all.mean.segment<3>(3));
  obstacle.velocity_known = true;
  estimate.acceleration = rests ? Vector3d::Zero() : Vector3d(all.mean.tail<3>());
  estimate.covariance = all.covariance.topLeftCorner<6, 6>();
  estimate.covariance = (0.5 * (estimate.covariance + estimate.covariance.transpose())).eval();
  estimate.age = dt;
}

}  // namespace oca::sensing
