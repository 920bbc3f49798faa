// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/plants/motion_limiter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/basics/constant.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace motion_limiter_test {

constexpr double kDt = 0.01;

/// The LWR 4 with acceleration limits, and jerk limits if there are any.
ModelSet Arm(double acceleration, double jerk = robot::kUnlimited) {
  const auto plain = LoadTestModel("lwr4");
  auto links = plain->links();
  auto joints = plain->joints();
  for (auto& joint : joints) {
    joint.acceleration_limit = acceleration;
    joint.jerk_limit = jerk;
  }
  ModelSet set;
  set.Add("lwr4", std::make_shared<const robot::RobotModel>(plain->name(), links, joints));
  return set;
}

class MotionLimiterTest : public testing::Test {
 protected:
  using Bench = SystemBench<MotionLimiter>;
  static MotionLimiter::Params Hundred() { return {.period = Period(1, 100)}; }
  static Eigen::VectorXd One(double x) { return Eigen::VectorXd::Constant(7, x); }

  /// What is sent within period number `tick` if `request` is asked for from its start.
  static Eigen::VectorXd Within(Bench& bench, int tick, const Eigen::VectorXd& request) {
    bench.AdvanceTo((tick + 0.5) * kDt);
    bench->request.Fix(bench.context(), request);
    return bench->position.Eval(bench.context());
  }
};

TEST_F(MotionLimiterTest, PassesWhatKeepsTheLimitsWithoutDelayAndToTheLastBit) {
  Bench bench(Hundred(), Arm(10));
  bench->request.Fix(bench.context(), One(0.0));
  const Eigen::VectorXd request = One(0.5 * 10 * kDt * kDt);
  EXPECT_EQ(Within(bench, 0, request), request);
  EXPECT_TRUE(bench->clips.Eval(bench.context()).clips.empty());
}

TEST_F(MotionLimiterTest, SpeedsUpByNoMoreThanTheAcceleration) {
  Bench bench(Hundred(), Arm(10));
  bench->request.Fix(bench.context(), One(0.0));
  // Velocities 0.1, 0.2, 0.3 rad/s.
  EXPECT_DOUBLE_EQ(Within(bench, 0, One(1))[0], 0.001);
  EXPECT_DOUBLE_EQ(Within(bench, 1, One(1))[0], 0.003);
  EXPECT_DOUBLE_EQ(Within(bench, 2, One(1))[0], 0.006);
  EXPECT_NEAR(bench->velocity.Eval(bench.context())[6], 0.3, 1e-12);
  const MotionClips& clips = bench->clips.Eval(bench.context());
  ASSERT_EQ(clips.clips.size(), 7u);
  EXPECT_EQ(clips.clips[3].joint, 3);
  EXPECT_EQ(clips.clips[3].limit, motion::MotionLimit::kAcceleration);
  EXPECT_EQ(clips.clips[3].yields, motion::MotionLimit::kNone);
  EXPECT_NEAR(clips.clips[3].amount, 0.006 - 1.0, 1e-12);
}

TEST_F(MotionLimiterTest, KeepsVelocityAndPositionOfAModelWithoutFurtherLimits) {
  Bench bench(Hundred(), TestModels("lwr4"));
  bench->request.Fix(bench.context(), One(0.0));
  const double fastest = 110 * M_PI / 180;
  EXPECT_NEAR(Within(bench, 0, One(9))[0], fastest * kDt, 1e-12);
  EXPECT_EQ(bench->clips.Eval(bench.context()).clips[0].limit, motion::MotionLimit::kVelocity);
  EXPECT_NEAR(Within(bench, 400, One(9))[0], 170 * M_PI / 180, 1e-9);
  EXPECT_EQ(bench->clips.Eval(bench.context()).clips[0].limit, motion::MotionLimit::kPosition);
}

TEST_F(MotionLimiterTest, StartsWhereTheArmIsMeasured) {
  DiagramBuilder builder;
  const auto& request = builder.Add<Constant>("request", Constant::Params{One(1.0), "rad"});
  const auto& measured = builder.Add<Constant>("measured", Constant::Params{One(0.5), "rad"});
  const auto& limiter = builder.Add<MotionLimiter>("limiter", Hundred(), Arm(10));
  builder.Connect(request.value, limiter.request);
  builder.Connect(measured.value, limiter.measured_position);
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  simulator.AdvanceTo(0.5 * kDt);
  EXPECT_EQ(limiter.position.Eval(simulator.context())[0], 0.501);
  simulator.AdvanceTo(1.5 * kDt);
  EXPECT_EQ(limiter.position.Eval(simulator.context())[0], 0.503);
}

TEST_F(MotionLimiterTest, LetsAJointOutsideItsRangeOnlyComeBack) {
  Bench bench(Hundred(), Arm(10));
  bench->request.Fix(bench.context(), One(3.1));  // beyond 170 degrees
  EXPECT_EQ(Within(bench, 0, One(3.2))[0], 3.1);
  EXPECT_EQ(bench->clips.Eval(bench.context()).clips.at(0).limit, motion::MotionLimit::kPosition);
  EXPECT_DOUBLE_EQ(Within(bench, 1, One(0.0))[0], 3.099);
}

TEST_F(MotionLimiterTest, LeadsAJointThatStandsAtOrBeyondALimitToItsGoal) {
  for (const double jerk : {robot::kUnlimited, 200.0}) {
    const ModelSet arm = Arm(10, jerk);
    const Eigen::VectorXd upper = arm.Get("")->upper_limits();
    for (const double off : {0.0, -1e-13, -1e-12, 1e-13, 1e-6, 0.01, 1.0}) {
      for (const double side : {1.0, -1.0}) {
        Bench bench(Hundred(), arm);
        const Eigen::VectorXd start = side * (upper.array() + off).matrix();
        bench->request.Fix(bench.context(), start);
        Eigen::VectorXd before = Within(bench, 0, start);
        EXPECT_EQ(before, start);
        for (int k = 1; k < 700; ++k) {
          const Eigen::VectorXd now = Within(bench, k, One(side * 0.3));
          ASSERT_LE((side * (now - before)).maxCoeff(), 1e-3) << off;  // a touch past the goal
          before = now;
        }
        EXPECT_NEAR(before[0], side * 0.3, 1e-3) << off << ' ' << jerk;
        EXPECT_NEAR(before[6], side * 0.3, 1e-3) << off << ' ' << jerk;
      }
    }
  }
}

// A request that sets off at 0.5 rad/s at once: the command lags behind, catches up and meets it.
TEST_F(MotionLimiterTest, CatchesUpWithoutShootingPast) {
  for (const double jerk : {robot::kUnlimited, 200.0}) {
    Bench bench(Hundred(), Arm(10, jerk));
    bench->request.Fix(bench.context(), One(0.0));
    double request = 0.0;
    double furthest = -1.0;
    for (int k = 0; k < 100; ++k) {
      request = 0.5 * kDt * (k + 1);
      const double out = Within(bench, k, One(request))[0];
      EXPECT_LT(bench->velocity.Eval(bench.context())[0], 1.0);
      furthest = std::max(furthest, out - request);
    }
    EXPECT_LT(furthest, 1e-9) << jerk;
    EXPECT_NEAR(Within(bench, 100, One(request + 0.5 * kDt))[0], request + 0.5 * kDt, 1e-4);
  }
}

TEST_F(MotionLimiterTest, AnswersARequestFromAnywhere) {
  for (const double jerk : {robot::kUnlimited, 200.0}) {
    Bench bench(Hundred(), Arm(10, jerk));
    bench->request.Fix(bench.context(), One(0.0));
    double position = 0.0;
    for (int k = 0; k < 800; ++k) {
      position = Within(bench, k, One(k / 200 % 2 == 0 ? 1e308 : -1e308))[0];
      ASSERT_LE(std::fabs(position), 170 * M_PI / 180) << k;
    }
    EXPECT_LT(position, 0.0) << jerk;
    for (const MotionClip& clip : bench->clips.Eval(bench.context()).clips) {
      EXPECT_TRUE(std::isfinite(clip.amount));
    }
  }
}

TEST_F(MotionLimiterTest, PassesAnythingWhenDisabled) {
  auto params = Hundred();
  params.enabled = false;
  Bench bench(params, Arm(10));
  bench->request.Fix(bench.context(), One(0.0));
  EXPECT_EQ(Within(bench, 3, One(1e5)), One(1e5));
  EXPECT_TRUE(bench->clips.Eval(bench.context()).clips.empty());
}

TEST_F(MotionLimiterTest, RefusesPeriodZeroAndAModelThatCannotMove) {
  EXPECT_THROW(MotionLimiter({}, Arm(10)), ConfigError);
  EXPECT_THROW(MotionLimiter(Hundred(), TestModels("table_frame")), ConfigError);
}

/// Requests that jump, burst, vibrate and freeze, on all joints at once, judged by the differences
/// of the positions that come out.
void Harass(const ModelSet& set, int ticks, unsigned seed) {
  const auto model = set.Get("");
  SystemBench<MotionLimiter> bench(MotionLimiter::Params{.period = Period(1, 100)}, set);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Eigen::VectorXd request = Eigen::VectorXd::Zero(7);
  bench->request.Fix(bench.context(), request);
  Eigen::VectorXd before = request;
  Eigen::VectorXd speed = request;
  Eigen::VectorXd acceleration = request;
  for (int k = 0; k < ticks; ++k) {
    for (int j = 0; j < 7; ++j) {
      if (random() % 40 == 0) request[j] = 4.0 * unit(random);
      if (random() % 20 == 0) request[j] += unit(random);
      if (random() % 500 == 0) request[j] = 1e9 * unit(random);
    }
    bench.AdvanceTo((k + 0.5) * kDt);
    bench->request.Fix(bench.context(), request);
    const Eigen::VectorXd now = bench->position.Eval(bench.context());
    const Eigen::VectorXd u = (now - before) / kDt;
    const Eigen::VectorXd a = (u - speed) / kDt;
    const auto within = [](const Eigen::VectorXd& x, const Eigen::VectorXd& limit) {
      return (x.cwiseAbs().array() <= limit.array() * (1 + 1e-9) + 1e-8).all();
    };
    ASSERT_TRUE((now.array() <= model->upper_limits().array()).all()) << k;
    ASSERT_TRUE((now.array() >= model->lower_limits().array()).all()) << k;
    ASSERT_TRUE(within(u, model->velocity_limits())) << k;
    ASSERT_TRUE(within(a, model->acceleration_limits())) << k;
    ASSERT_TRUE(within((a - acceleration) / kDt, model->jerk_limits())) << k;
    for (const MotionClip& clip : bench->clips.Eval(bench.context()).clips) {
      ASSERT_EQ(clip.yields, motion::MotionLimit::kNone) << k;
    }
    before = now;
    speed = u;
    acceleration = a;
  }
}

TEST_F(MotionLimiterTest, KeepsEveryLimitOverAMillionHostileTicksOfAJoint) {
  Harass(Arm(10), 150000, 31);
}

TEST_F(MotionLimiterTest, KeepsTheJerkToo) { Harass(Arm(10, 500), 10000, 32); }

TEST_F(MotionLimiterTest, KeepsThemWithoutAccelerationLimits) {
  Harass(TestModels("lwr4"), 20000, 33);
}

TEST_F(MotionLimiterTest, WritesItsClips) {
  MotionClips clips;
  clips.clips.push_back({2, motion::MotionLimit::kJerk, motion::MotionLimit::kPosition, -0.5});
  std::string text;
  Signal<MotionClips>::WriteJson(clips, text);
  EXPECT_EQ(text, R"([{"joint":2,"limit":"jerk","yields":"position","amount":-0.5}])");
  clips.clips[0].amount = std::nan("");
  EXPECT_FALSE(Signal<MotionClips>::Check(clips, Look::kFinite).ok());
}

}  // namespace motion_limiter_test
}  // namespace oca::systems
