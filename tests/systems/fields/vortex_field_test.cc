// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/vortex_field.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/sensing/model_links.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace vortex_field_test {

using Eigen::Vector3d;
constexpr const char* kLink = "lwr4_link_5";

Eigen::VectorXd Bent() {
  return (Eigen::VectorXd(7) << 0.3, 0.8, -0.4, -1.1, 0.5, 0.9, -0.2).finished();
}

/// An LWR 4 that stands at q and is asked to move on with `rate`, near one obstacle.
class Bench {
 public:
  explicit Bench(const VortexField::Params& params = {.period = Period(1, 100)},
                 const Eigen::Isometry3d& X_WB = Eigen::Isometry3d::Identity(),
                 const Eigen::VectorXd& q = Bent())
      : model_(LoadTestModel("lwr4", X_WB)), bench_(params, Models()) {
    LinkPoses links;
    NameLinks(*model_, links);
    links.poses = robot::LinkPoses(*model_, q);
    bench_->links.Fix(bench_.context(), links);
    bench_->position.Fix(bench_.context(), q);
    bench_->measured_position.Fix(bench_.context(), q);
    tip_ = links.poses[model_->FindLink(kLink)].translation();
    J_v_.resize(3, 7);
    robot::PointJacobian(*model_, links.poses, model_->FindLink(kLink), tip_, J_v_);
    q_ = q;
  }

  void Request(const Eigen::VectorXd& rate) {
    bench_->position.Fix(bench_.context(), Eigen::VectorXd(q_ + rate));
  }
  /// Asks for a motion of the link along `way`.
  void Head(const Vector3d& way) {
    Request(J_v_.transpose() * (J_v_ * J_v_.transpose()).ldlt().solve(way));
  }
  void Place(double distance, const Vector3d& normal, const Vector3d& velocity = Vector3d::Zero()) {
    ProximitySet set;
    Proximity proximity;
    proximity.link = models::Name(kLink);
    proximity.obstacle = models::Name("box");
    proximity.distance = distance;
    proximity.normal = normal.normalized();
    proximity.point_on_link = tip_;
    proximity.obstacle_velocity = velocity;
    set.proximities.push_back(proximity);
    bench_->proximities.Fix(bench_.context(), set);
  }
  void Tick() { bench_.AdvanceTo(0.01 * ++ticks_); }
  Vector3d Force() { return bench_->forces.Eval(bench_.context()).forces.at(0).force; }
  ContactSlope Slope() { return bench_->slopes.Eval(bench_.context()).slopes.at(0); }

 private:
  ModelSet Models() const {
    ModelSet set;
    set.Add("lwr4", model_);
    return set;
  }
  const std::shared_ptr<const robot::RobotModel> model_;
  SystemBench<VortexField> bench_;
  Eigen::VectorXd q_;
  Vector3d tip_;
  Eigen::Matrix3Xd J_v_;
  int ticks_{0};
};

VortexField::Params Turned(double turn) { return {.turn = turn, .period = Period(1, 100)}; }

// |F| of eq. (3.1) at 0.2 m is 41.667 N; a way straight sideways turns it by the angle that way.
TEST(VortexFieldTest, TurnsTheForceByItsAngleTowardsTheRequest) {
  Bench bench(Turned(0.5));
  bench.Place(0.2, Vector3d::UnitX());
  bench.Head({0.0, 0.2, -0.01});  // as much down as the share of `up` is up
  const Vector3d expected = 1000.0 / 24.0 * Vector3d(std::cos(0.5), std::sin(0.5), 0.0);
  EXPECT_NEAR((bench.Force() - expected).norm(), 0.0, 0.1);
  bench.Head({0.0, -0.2, -0.01});  // not taken yet by a tick
  EXPECT_LT(bench.Force().y(), 0.0);
}

TEST(VortexFieldTest, KeepsItsAxisUntilTheLinkIsOutOfTheField) {
  Bench bench;
  bench.Place(0.29, Vector3d::UnitX());
  bench.Head({0.0, 0.2, 0.0});
  bench.Tick();
  bench.Head({0.0, -0.2, 0.0});
  bench.Tick();
  EXPECT_GT(bench.Force().y(), 0.0);
  bench.Place(0.3001, Vector3d::UnitX());
  bench.Tick();
  bench.Place(0.29, Vector3d::UnitX());
  bench.Tick();
  EXPECT_LT(bench.Force().y(), 0.0);
}

TEST(VortexFieldTest, AnObstacleThatComesIsAWayTowardsIt) {
  Bench bench;
  bench.Place(0.2, Vector3d::UnitX(), {0.5, -0.3, 0.0});  // it passes towards -y: go to +y
  EXPECT_GT(bench.Force().y(), 0.0);
}

TEST(VortexFieldTest, ARequestThatLeadsStraightAtTheObstacleIsLedUpwards) {
  Bench bench;
  bench.Place(0.2, Vector3d::UnitX());
  bench.Head({-0.3, 0.0, 0.0});
  EXPECT_GT(bench.Force().z(), 0.0);
  EXPECT_NEAR(bench.Force().y(), 0.0, 1e-9);
  for (const Vector3d& n : {Vector3d(0, 0, 1), Vector3d(1, 0, 0), Vector3d(0, 1, 0)}) {
    bench.Place(0.31, n);
    bench.Tick();
    bench.Place(0.2, n);
    bench.Request(Eigen::VectorXd::Zero(7));
    EXPECT_NEAR(bench.Force().norm(), 1000.0 / 24.0, 1e-9) << "some way is always found";
    EXPECT_NEAR(bench.Force().dot(n), 1000.0 / 24.0 * std::cos(1.0), 1e-9);
    bench.Tick();
  }
}

TEST(VortexFieldTest, MovingTheWorldMovesTheForce) {
  const Vector3d n = Vector3d(1.0, 0.5, -0.2).normalized();
  const Eigen::VectorXd rate = Eigen::VectorXd::LinSpaced(7, -0.2, 0.3);
  Bench here;
  here.Place(0.2, n, {0.1, 0.2, 0.0});
  here.Request(rate);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.rotate(Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5).normalized());
  X.translation() = Vector3d(1.0, -2.0, 0.5);
  Bench there({.period = Period(1, 100)}, X);
  there.Place(0.2, X.linear() * n, X.linear() * Vector3d(0.1, 0.2, 0.0));
  there.Request(rate);
  EXPECT_NEAR((there.Force() - X.linear() * here.Force()).norm(), 0.0, 1e-9);
}

// In the plane y = 0: joints about z turn the other way.
TEST(VortexFieldTest, AMirroredSceneMirrorsTheForce) {
  const Eigen::Matrix3d M = Vector3d(1.0, -1.0, 1.0).asDiagonal();
  const Eigen::VectorXd S = (Eigen::VectorXd(7) << -1, 1, -1, 1, -1, 1, -1).finished();
  const Eigen::VectorXd rate = Eigen::VectorXd::LinSpaced(7, -0.2, 0.3);
  const Vector3d n = Vector3d(1.0, 0.5, -0.2).normalized();
  Bench one;
  one.Place(0.2, n, {0.1, 0.2, 0.0});
  one.Request(rate);
  Bench other({.period = Period(1, 100)}, Eigen::Isometry3d::Identity(), S.cwiseProduct(Bent()));
  other.Place(0.2, M * n, M * Vector3d(0.1, 0.2, 0.0));
  other.Request(S.cwiseProduct(rate));
  EXPECT_NEAR((other.Force() - M * one.Force()).norm(), 0.0, 1e-9);
  EXPECT_GT(std::fabs(one.Force().y()), 1.0);
}

TEST(VortexFieldTest, SlopesAreTheDerivativesOfTheForce) {
  Bench bench;
  const Vector3d n = Vector3d(1.0, -0.3, 0.4).normalized();
  bench.Head({0.0, 0.2, 0.1});
  for (const double distance : {0.25, 0.1, 0.03}) {
    bench.Place(distance, n);
    const Vector3d slope = bench.Slope().slope;
    constexpr double kStep = 1e-7;
    bench.Place(distance - kStep, n);
    const Vector3d nearer = bench.Force();
    bench.Place(distance + kStep, n);
    const Vector3d numeric = (nearer - bench.Force()) / (2.0 * kStep);
    EXPECT_NEAR((slope - numeric).norm(), 0.0, 1e-5 * numeric.norm()) << distance;
  }
}

TEST(VortexFieldTest, RefusesTooWideATurnAndWhatARepulsiveFieldRefuses) {
  const ModelSet models = TestModels("lwr4");
  EXPECT_NO_THROW(VortexField(Turned(1.5), models));
  EXPECT_THROW(VortexField(Turned(1.5001), models), ConfigError);
  EXPECT_THROW(VortexField(Turned(-0.001), models), ConfigError);
  EXPECT_THROW(VortexField(Turned(std::numeric_limits<double>::quiet_NaN()), models), ConfigError);
  EXPECT_THROW(VortexField({.turn = 1.0}, models), ConfigError);
  EXPECT_THROW(VortexField({.max_distance = 0.0, .period = Period(1, 100)}, models), ConfigError);
}

}  // namespace vortex_field_test
}  // namespace oca::systems
