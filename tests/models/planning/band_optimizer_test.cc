// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_optimizer.h"

#include <gtest/gtest.h>

#include <numbers>

#include "oca/models/planning/smooth_step.h"
#include "oca/models/random.h"
#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace band_optimizer_test {

using Eigen::VectorXd;

/// The report's static test: the LWR 4 turns joint 1 by 157.5 degrees in 10 s.
class Sweep {
 public:
  Sweep() {
    robot::LoadOptions options;
    options.X_WB.translation() = Eigen::Vector3d(0.0, 0.0, 0.85);
    model = std::make_shared<const robot::RobotModel>(
        robot::LoadUrdf(OCA_SOURCE_DIR "/models/robots/lwr4/lwr4.urdf", options));
    const robot::PlacedBody box = test::BoxAt({0.2, 0.2, 0.2}, {0.0, 0.6, 1.0});
    bodies.push_back(
        {models::Name("box"), box.collider, [X = box.X_WO](double) { return X; }, true});
    home.resize(7);
    home << 0.0, 1.48, 0.0, -0.61, 0.0, 0.52, 0.0;
  }
  BandRequest request() const {
    return [this](double time, int derivative, Eigen::Ref<VectorXd> out) {
      const double s = std::clamp(time / 10.0, 0.0, 1.0);
      const double shape[3] = {s * s * (3.0 - 2.0 * s), 0.6 * s * (1.0 - s),
                               0.06 * (1.0 - 2.0 * s)};
      out = derivative == 0 ? home : VectorXd::Zero(7);
      out[0] += (derivative > 0 && s == 1.0 ? 0.0 : shape[derivative]) * 2.75;
    };
  }
  BandCurve Curve() const {
    std::vector<double> times;
    for (int i = 0; i <= 26; ++i) times.push_back(0.4 * i);
    return {7, times};
  }
  std::shared_ptr<const robot::RobotModel> model;
  std::vector<BandBody> bodies;
  VectorXd home;
};

TEST(BandOptimizerTest, TheRequestItselfGoesThroughTheBox) {
  const Sweep sweep;
  BandOptimizer band(sweep.model, {});
  const BandCurve curve = sweep.Curve();
  band.Prepare(curve, sweep.request(), sweep.bodies, true);
  const BandCheck check = band.Check(curve);
  EXPECT_LT(check.min_distance, -0.1);
  EXPECT_FALSE(check.clear());
  EXPECT_EQ(check.body, models::Name("box"));
  EXPECT_LT(check.first, check.time);
  EXPECT_GT(check.last, check.time);
}

TEST(BandOptimizerTest, ItsGradientIsTheDerivativeOfItsCost) {
  const Sweep sweep;
  for (const bool end_fixed : {true, false}) {
    BandOptimizer band(sweep.model, {});
    BandCurve curve = sweep.Curve();
    models::Random random(5);
    for (Eigen::Index i = 0; i < curve.controls().size(); ++i) {
      curve.controls().data()[i] = random.Uniform(-0.3, 0.3);
    }
    curve.controls().rightCols(3).colwise() = curve.controls().col(20).eval();
    band.Prepare(curve, sweep.request(), sweep.bodies, end_fixed);
    const VectorXd half = band.HalfGradient(curve);
    const int last = static_cast<int>(curve.controls().cols()) - 3;
    EXPECT_EQ(half.size(), 7 * (last - 3 + (end_fixed ? 0 : 1)));
    constexpr double kStep = 1e-6;
    for (int control = 3; control <= (end_fixed ? last - 1 : last); control += 4) {
      for (int j = 0; j < 7; ++j) {
        const auto at = [&](double by) {
          BandCurve moved = curve;
          if (control == last) {
            moved.controls().row(j).tail(3).array() += by;
          } else {
            moved.controls()(j, control) += by;
          }
          return band.Cost(moved);
        };
        const double numeric = (at(kStep) - at(-kStep)) / (2.0 * kStep);
        EXPECT_NEAR(2.0 * half[7 * (control - 3) + j], numeric, 1e-3 * (1.0 + std::fabs(numeric)))
            << control << " " << j;
      }
    }
  }
}

TEST(BandOptimizerTest, RelaxesPastTheBoxWithinTheLimits) {
  const Sweep sweep;
  BandOptimizer band(sweep.model, {});
  BandCurve curve = sweep.Curve();
  band.Prepare(curve, sweep.request(), sweep.bodies, true);
  const double before = band.Cost(curve);
  const double after = band.Relax(curve, 60);
  EXPECT_LT(after, 0.1 * before);
  EXPECT_DOUBLE_EQ(after, band.Cost(curve));
  const BandCheck check = band.Check(curve);
  EXPECT_TRUE(check.clear()) << check.min_distance;
  EXPECT_TRUE(curve.controls().leftCols(3).isZero(0.0));
  EXPECT_TRUE(curve.controls().rightCols(3).isZero(0.0));
}

TEST(BandOptimizerTest, AnswersTheMirroredSceneWithTheMirroredBand) {
  const Sweep sweep;
  const auto relax = [&](double side) {
    std::vector<BandBody> bodies = sweep.bodies;
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translation() = Eigen::Vector3d(0.3, 0.4 * side, 1.1);
    bodies[0].pose = [X](double) { return X; };
    const BandRequest request = [&, side](double time, int derivative, Eigen::Ref<VectorXd> out) {
      sweep.request()(time, derivative, out);
      out[0] *= side;
    };
    BandOptimizer band(sweep.model, {});
    BandCurve curve = sweep.Curve();
    band.Prepare(curve, request, bodies, true);
    band.Relax(curve, 10);
    return curve.controls();
  };
  VectorXd mirror(7);
  mirror << -1, 1, -1, 1, -1, 1, -1;
  const Eigen::MatrixXd left = relax(1.0);
  EXPECT_GT(left.norm(), 0.1);
  EXPECT_LT((left - mirror.asDiagonal() * relax(-1.0)).norm(), 1e-3 * left.norm());
}

TEST(BandOptimizerTest, IsNotClearWhereItExceedsLimitsThatTheRequestKeeps) {
  const Sweep sweep;
  BandOptimizer band(sweep.model, {});
  BandCurve curve = sweep.Curve();
  const auto check = [&](double away) {
    const robot::PlacedBody far = test::BoxAt({0.2, 0.2, 0.2}, {0.0, 9.0, 1.0});
    const std::vector<BandBody> bodies{
        {models::Name("far"), far.collider, [X = far.X_WO](double) { return X; }, true}};
    curve.Follow([&](double) -> VectorXd {
      VectorXd x = VectorXd::Zero(7);
      x[1] = away;
      return x;
    });
    band.Prepare(curve, sweep.request(), bodies, false);
    return band.Check(curve);
  };
  const double room = sweep.model->upper_limits()[1] - sweep.home[1];
  EXPECT_TRUE(check(room - 0.01).clear());
  const BandCheck beyond = check(room + 0.01);
  EXPECT_FALSE(beyond.clear());
  EXPECT_LT(beyond.touch(), beyond.last);
  EXPECT_EQ(beyond.min_distance, band.settings().margin);
}

TEST(BandOptimizerTest, TouchesWhatStandsSoonerThanWhatMovesAndWhereItBeginsToo) {
  const Sweep sweep;
  const BandRequest hold = [&](double, int derivative, Eigen::Ref<VectorXd> out) {
    out = derivative == 0 ? sweep.home : VectorXd::Zero(7);
  };
  BandSettings settings;
  settings.margin = 2.0;
  const BandCurve curve = sweep.Curve();
  const auto touch = [&](double trust, double flying, bool stands) {
    settings.trust_distance = trust;
    settings.flying_distance = flying;
    BandOptimizer band(sweep.model, settings);
    std::vector<BandBody> bodies = sweep.bodies;
    bodies[0].stands = stands;
    band.Prepare(curve, hold, bodies, true);
    const BandCheck check = band.Check(curve);
    return std::min(check.touch_trust, check.touch_flying);
  };
  const double never = std::numeric_limits<double>::infinity();
  BandOptimizer band(sweep.model, {.margin = 2.0, .clear_distance = 2.0});
  band.Prepare(curve, hold, sweep.bodies, true);
  const BandOptimizer::Room room = band.RoomAt(sweep.home, 0.0);
  const double distance = std::min(room.standing, room.flying);
  ASSERT_GT(distance, 0.01);
  ASSERT_LT(distance, 1.9);
  EXPECT_EQ(touch(distance + 1e-3, 0.0, true), curve.start());
  EXPECT_EQ(touch(distance - 1e-3, 1.9, true), never);
  EXPECT_EQ(touch(1.9, distance - 1e-3, false), never);
  EXPECT_EQ(touch(0.0, distance + 1e-3, false), curve.start());
}

TEST(BandOptimizerTest, AsksForNoMoreThanGoalAndStartLeave) {
  // The arm rests near the box, at a distance that is known.
  const Sweep sweep;
  const BandRequest hold = [&](double, int derivative, Eigen::Ref<VectorXd> out) {
    out = derivative == 0 ? sweep.home : VectorXd::Zero(7);
  };
  BandOptimizer far(sweep.model, {.margin = 2.0, .clear_distance = 2.0});
  BandCurve curve = sweep.Curve();
  far.Prepare(curve, hold, sweep.bodies, true);
  const BandOptimizer::Room room = far.RoomAt(sweep.home, 0.0);
  const double distance = std::min(room.standing, room.flying);
  ASSERT_LT(distance, 2.0);
  BandOptimizer band(sweep.model, {.margin = distance + 0.1,
                                   .clear_distance = distance + 0.05,
                                   .hard_distance = 0.5 * distance});
  band.Prepare(curve, hold, sweep.bodies, true);
  const BandCheck without = band.Check(curve);
  EXPECT_FALSE(without.wide());
  EXPECT_TRUE(without.clear()) << "what stands is kept at the hard distance";
  EXPECT_NEAR(without.kept, distance, 1e-9);
  EXPECT_GT(band.Cost(curve), 0.0);
  const VectorXd goal = sweep.home;
  band.YieldAt(goal, &goal);
  EXPECT_TRUE(band.Check(curve).wide());
  EXPECT_EQ(band.Check(curve).kept, BandCheck::kNever);
  EXPECT_NEAR(band.Cost(curve), 0.0, 1e-6) << "the goal itself costs nothing";
  // What moves is asked for all, whatever the goal leaves.
  std::vector<BandBody> flying = sweep.bodies;
  flying[0].stands = false;
  band.Prepare(curve, hold, flying, true);
  band.YieldAt(goal, &goal);
  EXPECT_FALSE(band.Check(curve).clear());
}

TEST(BandOptimizerTest, ItsGradientKnowsThatLessIsAskedForNearTheGoal) {
  const Sweep sweep;
  BandOptimizer band(sweep.model, {.margin = 0.6});
  BandCurve curve = sweep.Curve();
  models::Random random(5);
  curve.Follow([&](double) -> VectorXd {
    VectorXd x(7);
    for (int j = 0; j < 7; ++j) x[j] = random.Uniform(-0.3, 0.3);
    return x;
  });
  curve.controls().rightCols(3).setZero();
  band.Prepare(curve, sweep.request(), sweep.bodies, true);
  VectorXd goal(7);
  sweep.request()(curve.end(), 0, goal);
  band.YieldAt(sweep.home, &goal);
  const VectorXd gradient = 2.0 * band.HalfGradient(curve);
  for (const int i : {3, 8, 14, 20}) {
    for (const int j : {0, 1, 3}) {
      BandCurve more = curve, less = curve;
      more.controls()(j, i) += 1e-6;
      less.controls()(j, i) -= 1e-6;
      const double numeric = (band.Cost(more) - band.Cost(less)) / 2e-6;
      EXPECT_NEAR(gradient[(i - 3) * 7 + j], numeric, 1e-4 * std::max(1.0, std::fabs(numeric)));
    }
  }
}

TEST(BandOptimizerTest, ReturnsWithinASecondOnceNothingIsInTheWay) {
  const Sweep sweep;
  BandOptimizer band(sweep.model, {});
  const auto away = [&](double from) {
    BandCurve curve = sweep.Curve();
    VectorXd zero = VectorXd::Zero(7), off = zero;
    off[3] = 0.3;
    curve.StartWith(off, zero, zero);
    band.Prepare(curve, sweep.request(), {}, true);
    band.ReturnBetween({{-1.0, from}}, 1.0);
    band.Relax(curve, 30);
    VectorXd x(7);
    curve.Evaluate(1.2, 0, x);
    return x.cwiseAbs().maxCoeff();
  };
  EXPECT_LT(away(0.0), 0.02);
  EXPECT_GT(away(5.0), 0.05);
}

TEST(BandOptimizerTest, LooksAtItsOwnLinksWithoutAnyBody) {
  const Sweep sweep;
  VectorXd folded = VectorXd::Zero(7);
  folded << 0.0, 0.0, 0.0, 2.0, 0.0, 2.0, 0.0;
  const BandRequest request = [&](double, int derivative, Eigen::Ref<VectorXd> out) {
    out = derivative == 0 ? folded : VectorXd::Zero(7);
  };
  BandSettings wide;
  wide.margin = 1.0;
  for (const bool own : {false, true}) {
    BandOptimizer band(sweep.model, wide, own);
    const BandCurve curve = sweep.Curve();
    band.Prepare(curve, request, {}, true);
    EXPECT_EQ(band.Check(curve).min_distance < wide.margin, own);
  }
}

TEST(BandOptimizerTest, WithoutBodiesTheRequestIsBest) {
  const Sweep sweep;
  BandOptimizer band(sweep.model, {});
  BandCurve curve = sweep.Curve();
  curve.Follow([](double) -> VectorXd { return VectorXd::Constant(7, 0.1); });
  curve.controls().rightCols(3).setZero();
  curve.controls().leftCols(3).setZero();
  band.Prepare(curve, sweep.request(), {}, true);
  band.Relax(curve, 20);
  EXPECT_LT(curve.controls().cwiseAbs().maxCoeff(), 1e-6);
}

TEST(BandOptimizerTest, WhatEvadesAllIsFoundAsCheckFindsIt) {
  Sweep sweep;
  const robot::PlacedBody ball = test::BoxAt({0.15, 0.15, 0.15}, {0.5, -1.0, 1.0});
  sweep.bodies.push_back({models::Name("flying"), ball.collider,
                          [X = ball.X_WO](double time) {
                            Eigen::Isometry3d moved = X;
                            moved.translation().y() += 0.25 * time;
                            return moved;
                          },
                          false});
  BandOptimizer band(sweep.model, {});
  BandCurve curve = sweep.Curve();
  const BandRequest rest = [&](double, int derivative, Eigen::Ref<VectorXd> out) {
    out = derivative == 0 ? sweep.home : VectorXd::Zero(7);
  };
  band.Prepare(curve, rest, sweep.bodies, false);
  models::Random random(11);
  int evading = 0, near = 0;
  for (int i = 0; i < 200; ++i) {
    VectorXd out(7);
    for (double& x : out) x = random.Uniform(-1.0, 1.0);
    curve.Follow([&](double time) -> VectorXd { return SmoothStep(time / 4.0) * out; });
    const BandCheck check = band.Check(curve);
    EXPECT_EQ(band.EvadesAll(curve, random.Uniform(-1.0, 11.0)), check.evades()) << i;
    evading += check.evades();
    near += check.evades() && !check.clear();
    // Where it ends, nothing is evaded that the band does not evade.
    VectorXd end(7), x(7);
    rest(curve.end(), 0, end);
    curve.Evaluate(curve.end(), 0, x);
    if (check.evades()) {
      EXPECT_EQ(band.EvadesAtEnd(end + x, 1), 1u) << i;
    }
  }
  EXPECT_GT(evading, 10);
  EXPECT_LT(evading, 190);
  EXPECT_GT(near, 0);
}

}  // namespace band_optimizer_test
}  // namespace oca::planning
