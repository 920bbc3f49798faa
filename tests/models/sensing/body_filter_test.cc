// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/sensing/body_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "oca/models/random.h"

namespace oca::sensing {
namespace body_filter_test {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kPeriod = 1.0 / 30.0;  // s
constexpr double kNoise = 0.005;        // m

double Normal(models::Random& random) {
  const double r = std::sqrt(-2.0 * std::log(1.0 - random.Unit()));
  return r * std::cos(2.0 * std::numbers::pi * random.Unit());
}
Vector3d Normal3(models::Random& random) {
  return {Normal(random), Normal(random), Normal(random)};
}

Isometry3d At(const Vector3d& p) {
  Isometry3d X = Isometry3d::Identity();
  X.translation() = p;
  return X;
}

using Path = std::function<Vector3d(double)>;

/// The innovations of bodies that each follow a path of their own, from their tenth pose on.
struct Innovations {
  int count{0};
  double sum{0.0};
  int outside{0};  ///< beyond 99 %
  double mean() const { return sum / count; }
  double share() const { return static_cast<double>(outside) / count; }
};
Innovations Follow(std::uint64_t seed, int bodies, int poses,
                   const std::function<Path(models::Random&)>& draw) {
  const BodyFilter filter{BodyFilterSettings{}};
  Innovations all;
  for (int body = 0; body < bodies; ++body) {
    models::Random random(models::Random::Seed(seed, static_cast<std::uint64_t>(body)));
    const Path path = draw(random);
    BodyTrack track;
    for (int k = 0; k < poses; ++k) {
      const double time = kPeriod * k;
      const Isometry3d X = At(path(time) + kNoise * Normal3(random));
      if (k == 0) filter.Start(time, X, track);
      if (k == 0) continue;
      filter.Update(time, X, track);
      if (k < 10) continue;
      ++all.count;
      all.sum += track.nis;
      all.outside += track.nis > 11.345;
    }
  }
  return all;
}

Path DrawStraight(models::Random& random) {
  const Vector3d v = random.Uniform(0.1, 1.6) * Normal3(random).normalized();
  return [v](double t) -> Vector3d { return t * v; };
}

// The sum of n normalised innovations squared is of chi-square (3 n): its mean lies within 3 +-
// 2.576 sqrt(6 / n) with 99 %.
TEST(BodyFilterTest, IsAsSureAsItMayBeOfWhatGoesStraight) {
  const Innovations all = Follow(4242, 12, 110, DrawStraight);
  ASSERT_EQ(all.count, 1200);
  EXPECT_NEAR(all.mean(), 3.0, 2.576 * std::sqrt(6.0 / 1200.0));
}

TEST(BodyFilterTest, IsAsSureAsItMayBeOfWhatRests) {
  const Innovations all = Follow(4243, 12, 110, [](models::Random& random) -> Path {
    return [p = Normal3(random)](double) -> Vector3d { return p; };
  });
  EXPECT_NEAR(all.mean(), 3.0, 2.576 * std::sqrt(6.0 / 1200.0));
}

// A filter that is ten times as sure, or a tenth, is found out by the same interval.
TEST(BodyFilterTest, TheIntervalFindsOutWhoIsTooSure) {
  const BodyFilter sure{BodyFilterSettings{.position_noise = 0.5 * kNoise}};
  models::Random random(7);
  const Path path = DrawStraight(random);
  BodyTrack track;
  sure.Start(0.0, At(path(0.0)), track);
  double sum = 0.0;
  for (int k = 1; k <= 1200; ++k) {
    const double time = kPeriod * k;
    sure.Update(time, At(path(time) + kNoise * Normal3(random)), track);
    sum += track.nis;
  }
  EXPECT_GT(sum / 1200.0, 3.0 + 2.576 * std::sqrt(6.0 / 1200.0));
}

// Of what manoeuvres more than 1 % lies outside; how much is printed.
TEST(BodyFilterTest, TellsTheShareOutsideForManoeuvres) {
  const auto print = [](const char* what, const Innovations& all) {
    std::printf("%-12s mean %.3f, outside 99 %%: %.2f %% of %d\n", what, all.mean(),
                100.0 * all.share(), all.count);
    EXPECT_LT(all.share(), 0.1) << what;
  };
  print("straight", Follow(1, 20, 110, DrawStraight));
  print("circling", Follow(2, 20, 110, [](models::Random& random) -> Path {
          const double r = random.Uniform(0.3, 0.8), w = random.Uniform(0.3, 2.0);
          return [=](double t) { return Vector3d(r * std::cos(w * t), r * std::sin(w * t), 0.0); };
        }));
  print("oscillating", Follow(3, 20, 110, [](models::Random& random) -> Path {
          const double a = random.Uniform(0.2, 0.6), w = random.Uniform(0.6, 3.0);
          return [=](double t) { return Vector3d(a * std::sin(w * t), 0.0, 0.0); };
        }));
  print("accelerating", Follow(4, 20, 60, [](models::Random& random) -> Path {
          const double a = random.Uniform(0.5, 3.0);
          return [=](double t) { return Vector3d(0.0, 0.0, -0.5 * a * t * t); };
        }));
  print("starting", Follow(5, 20, 60, [](models::Random& random) -> Path {
          const double start = random.Uniform(0.5, 1.5), v = random.Uniform(0.1, 1.6);
          return [=](double t) { return Vector3d(v * std::max(t - start, 0.0), 0.0, 0.0); };
        }));
}

/// Poses of a path without noise, up to a time.
BodyTrack Tracked(const BodyFilter& filter, const Path& path, double until) {
  BodyTrack track;
  filter.Start(0.0, At(path(0.0)), track);
  for (int k = 1; kPeriod * k <= until; ++k)
    filter.Update(kPeriod * k, At(path(kPeriod * k)), track);
  return track;
}

struct Told {
  geometry::Obstacle obstacle;
  geometry::ObstacleEstimate estimate;
};
Told Tell(const BodyFilter& filter, const BodyTrack& track, double time) {
  Told told;
  filter.Tell(track, time, told.obstacle, told.estimate);
  return told;
}

TEST(BodyFilterTest, ForeseesWhereSomethingIsByNow) {
  const BodyFilter filter{BodyFilterSettings{}};
  const Path path = [](double t) -> Vector3d { return {1.0 + 0.8 * t, -0.4 * t, 0.2}; };
  const BodyTrack track = Tracked(filter, path, 2.0);
  const Told told = Tell(filter, track, track.time + 0.08);
  EXPECT_NEAR((told.obstacle.X_WO.translation() - path(track.time + 0.08)).norm(), 0.0, 1e-3);
  EXPECT_NEAR((told.obstacle.linear - Vector3d(0.8, -0.4, 0.0)).norm(), 0.0, 5e-3);
  EXPECT_NEAR(told.estimate.age, 0.08, 1e-12);
  // Of poses that are right to 5 mm a mean of several is better than that.
  const double sigma = std::sqrt(told.estimate.covariance(0, 0));
  EXPECT_GT(sigma, 0.0005);
  EXPECT_LT(sigma, kNoise);
}

TEST(BodyFilterTest, TurnsWithWhatTurns) {
  const BodyFilter filter{BodyFilterSettings{}};
  const Path path = [](double t) -> Vector3d {
    return {0.5 * std::cos(1.5 * t), 0.5 * std::sin(1.5 * t), 0.0};
  };
  const BodyTrack track = Tracked(filter, path, 3.0);
  EXPECT_GT(track.modes[2].weight, 0.5);
  EXPECT_NEAR(track.turn, 1.5, 0.15);
  const Told told = Tell(filter, track, track.time + 0.2);
  const Vector3d straight =
      path(track.time) + 0.2 * (path(track.time + 1e-6) - path(track.time)) / 1e-6;
  const double missed = (told.obstacle.X_WO.translation() - path(track.time + 0.2)).norm();
  EXPECT_LT(missed, 0.3 * (straight - path(track.time + 0.2)).norm());
}

TEST(BodyFilterTest, WhatRestsHasNoVelocityAtAll) {
  const BodyFilter filter{BodyFilterSettings{}};
  models::Random random(3);
  BodyTrack track;
  filter.Start(0.0, At(Vector3d::Zero()), track);
  for (int k = 1; k < 30; ++k) filter.Update(kPeriod * k, At(kNoise * Normal3(random)), track);
  EXPECT_EQ(Tell(filter, track, 1.0).obstacle.linear, Vector3d::Zero());
  EXPECT_EQ(Tell(filter, track, 1.0).obstacle.angular, Vector3d::Zero());
  for (int k = 30; k < 36; ++k) {
    filter.Update(kPeriod * k, At(Vector3d(0.03 * (k - 29), 0.0, 0.0)), track);
  }
  EXPECT_NEAR(Tell(filter, track, 1.2).obstacle.linear.x(), 0.9, 0.15);
}

TEST(BodyFilterTest, KnowsAFallByItsFirstTenthOfASecond) {
  const BodyFilter filter{BodyFilterSettings{}};
  models::Random random(5);
  const auto fall = [](double t) -> Vector3d {
    const double s = std::max(t - 1.0, 0.0);
    return {0.0, 0.0, 2.0 - 0.5 * 9.81 * s * s};
  };
  BodyTrack track;
  filter.Start(0.0, At(fall(0.0) + kNoise * Normal3(random)), track);
  for (int k = 1; k <= 33; ++k) {
    filter.Update(kPeriod * k, At(fall(kPeriod * k) + kNoise * Normal3(random)), track);
  }
  EXPECT_GT(track.modes[4].weight, 0.8);
  const Told told = Tell(filter, track, track.time);
  EXPECT_NEAR(told.estimate.acceleration.z(), -9.81, 2.0);
  EXPECT_NEAR(told.obstacle.linear.z(), -0.98, 0.2);
}

TEST(BodyFilterTest, FollowsARotation) {
  const BodyFilter filter{BodyFilterSettings{}};
  BodyTrack track;
  const Vector3d w(0.0, 0.6, 0.8);
  const auto pose = [&](double t) {
    Isometry3d X = Isometry3d::Identity();
    X.linear() = Eigen::AngleAxisd(1.2 * t, w).toRotationMatrix();
    return X;
  };
  filter.Start(0.0, pose(0.0), track);
  for (int k = 1; k < 60; ++k) filter.Update(kPeriod * k, pose(kPeriod * k), track);
  const Told told = Tell(filter, track, 2.1);
  EXPECT_NEAR((told.obstacle.angular - 1.2 * w).norm(), 0.0, 0.01);
  const Eigen::AngleAxisd off(
      Eigen::Matrix3d(told.obstacle.X_WO.linear() * pose(2.1).linear().transpose()));
  EXPECT_NEAR(off.angle(), 0.0, 0.01);
}

TEST(BodyFilterTest, AJumpOfVelocityIsTakenOverAtOnce) {
  const BodyFilter filter{BodyFilterSettings{}};
  const Path path = [](double t) -> Vector3d { return {1.5 * std::max(t - 1.0, 0.0), 0.0, 0.0}; };
  BodyTrack track = Tracked(filter, path, 1.0 + 1e-9);
  EXPECT_EQ(filter.Update(31.0 / 30.0, At(path(31.0 / 30.0)), track), PoseUse::kTurn);
  EXPECT_NEAR(Tell(filter, track, 31.0 / 30.0).obstacle.linear.x(), 1.5, 0.2);
}

TEST(BodyFilterTest, RefusesWhatNothingCanReachUntilASecondPoseAgrees) {
  const BodyFilter filter{BodyFilterSettings{}};
  const Path path = [](double) -> Vector3d { return Vector3d::Zero(); };
  BodyTrack track = Tracked(filter, path, 0.5);
  const double t = track.time;
  const double reach = 10.0 * kPeriod;  // m; with `fastest`
  BodyTrack near = track;
  EXPECT_EQ(filter.Update(t + kPeriod, At({0.99 * reach, 0.0, 0.0}), near), PoseUse::kTurn);
  BodyTrack far = track;
  EXPECT_EQ(filter.Update(t + kPeriod, At({1.01 * reach, 0.0, 0.0}), far), PoseUse::kRefused);
  EXPECT_EQ(filter.Update(t + kPeriod, At({2.0, 0.0, 0.0}), track), PoseUse::kRefused);
  EXPECT_NEAR(Tell(filter, track, t + kPeriod).obstacle.X_WO.translation().norm(), 0.0, 1e-4);
  BodyTrack glitch = track;
  EXPECT_EQ(filter.Update(t + 2 * kPeriod, At(Vector3d::Zero()), glitch), PoseUse::kUsed);
  EXPECT_EQ(filter.Update(t + 2 * kPeriod, At({2.2, 0.0, 0.0}), track), PoseUse::kFirst);
  EXPECT_NEAR(Tell(filter, track, t + 2 * kPeriod).obstacle.X_WO.translation().x(), 2.2, 1e-9);
}

TEST(BodyFilterTest, LeavesOutWhatIsNotNew) {
  const BodyFilter filter{BodyFilterSettings{}};
  BodyTrack track = Tracked(
      filter, [](double t) { return Vector3d(t, 0.0, 0.0); }, 0.5);
  const double t = track.time;
  const auto before = track.modes[1].mean;
  EXPECT_EQ(filter.Update(t, At({5.0, 0.0, 0.0}), track), PoseUse::kNotNew);
  EXPECT_EQ(filter.Update(t - kPeriod, At({5.0, 0.0, 0.0}), track), PoseUse::kLate);
  EXPECT_EQ(track.modes[1].mean, before);
  EXPECT_EQ(track.time, t);
}

TEST(BodyFilterTest, IsLessSureTheOlderItsPosesAre) {
  const BodyFilter filter{BodyFilterSettings{}};
  const BodyTrack track = Tracked(
      filter, [](double t) { return Vector3d(t, 0.0, 0.0); }, 1.0);
  double before = 0.0;
  for (const double ahead : {0.0, 0.05, 0.1, 0.5}) {
    const double now = Tell(filter, track, track.time + ahead).estimate.covariance(1, 1);
    EXPECT_GT(now, before);
    before = now;
  }
}

}  // namespace body_filter_test
}  // namespace oca::sensing
