// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/methods/safety_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/sensing/link_colliders.h"
#include "oca/systems/sensing/model_links.h"
#include "tests/allocation_count.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace safety_filter_test {

constexpr double kDt = 0.01;

SafetyFilter::Params Hundred() { return {.period = Period(1, 100), .safe_distance = 0.05}; }

/// A filter whose arm is exactly where the filter sends it.
class Loop {
 public:
  Loop(const SafetyFilter::Params& params, const ModelSet& models, const Eigen::VectorXd& q)
      : bench_(params, models), model_(models.Get("")), q_(q) {
    NameLinks(*model_, poses_);
    bench_->measured_position.Fix(bench_.context(), q_);
  }

  /// One tick with `request`; `around` tells the proximities of the links' poses.
  template <class Around>
  const FilterActivity& Tick(const Eigen::VectorXd& request, const Around& around) {
    robot::ForwardKinematics(*model_, q_, poses_.poses);
    bench_->links.Fix(bench_.context(), poses_);
    bench_->position.Fix(bench_.context(), request);
    bench_->proximities.Fix(bench_.context(), around(poses_));
    bench_.AdvanceTo((ticks_++ + 0.5) * kDt);
    const Eigen::VectorXd next = request + bench_->delta.Eval(bench_.context());
    velocity_ = (next - q_) / kDt;
    q_ = next;
    return bench_->activity.Eval(bench_.context());
  }
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& velocity() const { return velocity_; }
  const robot::RobotModel& model() const { return *model_; }
  SystemBench<SafetyFilter>& bench() { return bench_; }

 private:
  SystemBench<SafetyFilter> bench_;
  const std::shared_ptr<const robot::RobotModel> model_;
  LinkPoses poses_;
  Eigen::VectorXd q_, velocity_;
  int ticks_{0};
};

/// The forearm of planar2, stretched along x, whose tip at (0.9, 0, 0) has an obstacle at
/// `distance` in the direction y that moves with `speed` towards it.
ProximitySet BesideTheTip(double distance, double speed) {
  Proximity proximity;
  proximity.link = models::Name("planar2_link_2");
  proximity.obstacle = models::Name("ball");
  proximity.distance = distance;
  proximity.point_on_link = Eigen::Vector3d(0.9, 0, 0);
  proximity.point_on_obstacle = Eigen::Vector3d(0.9, distance, 0);
  proximity.normal = -Eigen::Vector3d::UnitY();
  proximity.obstacle_velocity = -speed * Eigen::Vector3d::UnitY();
  return {{proximity}};
}

/// The velocity that a filter at rest in (0, 0) chooses for a request of `wish` rad/s.
Eigen::VectorXd Answer(const SafetyFilter::Params& params, const Eigen::Vector2d& wish,
                       const ProximitySet& set, FilterActivity* activity = nullptr) {
  Loop loop(params, TestModels("planar2"), Eigen::Vector2d::Zero());
  const auto& report =
      loop.Tick(wish / params.position_gain, [&](const LinkPoses&) { return set; });
  if (activity != nullptr) *activity = report;
  return loop.velocity();
}

TEST(SafetyFilterTest, GrantsARequestThatNothingStandsInTheWayOf) {
  FilterActivity activity;
  const Eigen::VectorXd u = Answer(Hundred(), {0.5, -0.25}, {}, &activity);
  EXPECT_NEAR((u - Eigen::Vector2d(0.5, -0.25)).norm(), 0.0, 1e-13);
  EXPECT_EQ(activity.num_bounds, 0);
  EXPECT_EQ(activity.status, qp::QpStatus::kOptimal);
}

TEST(SafetyFilterTest, ProjectsTheRequestOntoTheRowByHand) {
  // At h = 0.03 the tip may approach with 5 * 0.03 m/s: (0.9, 0.4) . u <= 0.15. The request (1, 0)
  // asks for 0.9, so u = (1, 0) - 0.75 / 0.97 (0.9, 0.4).
  FilterActivity activity;
  const Eigen::VectorXd u = Answer(Hundred(), {1, 0}, BesideTheTip(0.08, 0.0), &activity);
  EXPECT_NEAR((u - Eigen::Vector2d(1 - 0.675 / 0.97, -0.3 / 0.97)).norm(), 0.0, 1e-12);
  ASSERT_EQ(activity.num_bounds, 1);
  EXPECT_EQ(activity.bounds[0].kind, FilterBound::Kind::kDistance);
  EXPECT_EQ(activity.bounds[0].link.text(), "planar2_link_2");
  EXPECT_EQ(activity.bounds[0].obstacle.text(), "ball");
  EXPECT_NEAR(activity.bounds[0].multiplier, 0.75 / 0.97, 1e-12);
  EXPECT_EQ(activity.slack, 0.0);
}

/// A filter of planar2 at (0, 0) whose inputs `names` are wired from outside, so that optional ones
/// can be fixed; nothing is near and no motion requested.
class Wired {
 public:
  Wired(const SafetyFilter::Params& params, std::initializer_list<const char*> names) {
    DiagramBuilder builder;
    filter_ = &builder.Add<SafetyFilter>("filter", params, TestModels("planar2"));
    for (const char* name : names) builder.ExportInput(name, filter_->FindInput(name));
    for (const char* name : {"proximities", "links", "position", "measured_position"}) {
      builder.ExportInput(name, filter_->FindInput(name));
    }
    diagram_ = builder.Build();
    simulator_ = std::make_unique<Simulator>(*diagram_);
    const auto model = TestModels("planar2").Get("");
    LinkPoses poses;
    NameLinks(*model, poses);
    robot::ForwardKinematics(*model, Eigen::Vector2d::Zero(), poses.poses);
    filter().links.Fix(context(), poses);
    filter().proximities.Fix(context(), ProximitySet{});
    filter().measured_position.Fix(context(), Eigen::Vector2d::Zero());
    filter().position.Fix(context(), Eigen::Vector2d::Zero());
  }
  const SafetyFilter& filter() const { return *filter_; }
  const Diagram& diagram() const { return *diagram_; }
  Simulator& simulator() { return *simulator_; }
  Context& context() { return simulator_->context(); }
  /// The velocity of the next tick: the arm stands in (0, 0), so it leads to velocity * period.
  Eigen::VectorXd Answer() {
    simulator().AdvanceTo(context().time() + 0.75 * kDt);
    filter().position.Fix(context(), Eigen::Vector2d::Zero());
    return filter().delta.Eval(context()) / kDt;
  }

 private:
  const SafetyFilter* filter_;
  std::unique_ptr<Diagram> diagram_;
  std::unique_ptr<Simulator> simulator_;
};

TEST(SafetyFilterTest, EvadesWithTheJointThatHasNowhereToGo) {
  // The request has led joint 1 only, for half a second.
  const auto speed_of_joint_1 = [](double progress_weight) {
    SafetyFilter::Params params = Hundred();
    params.progress_weight = progress_weight;
    Wired wired(params, {"command", "velocity"});
    Context& context = wired.context();
    wired.diagram().GetInput<Vector>("command").Fix(context, Eigen::Vector2d::Zero());
    wired.diagram().GetInput<Vector>("velocity").Fix(context, Eigen::Vector2d(1, 0));
    wired.simulator().AdvanceTo(50.5 * kDt);
    wired.filter().proximities.Fix(context, BesideTheTip(0.05, 0.0));
    return wired.Answer()[0];
  };
  // (1, 0) onto (0.9, 0.4) . u = 0, with equal weights and with 11 : 1 or nearly so.
  EXPECT_NEAR(speed_of_joint_1(0.0), 1 - 0.81 / 0.97, 1e-12);
  EXPECT_NEAR(speed_of_joint_1(10.0), 1 - 0.81 / 11 / (0.81 / 11 + 0.16), 0.03);
}

TEST(SafetyFilterTest, LetsARequestThroughThatIsClearOfWhatItWasPlannedWith) {
  const Eigen::Vector2d wish(0.5, 0.0);
  const auto answer = [&](const ClearMotion& clear, double distance) {
    Wired wired(Hundred(), {"clear"});
    wired.filter().proximities.Fix(wired.context(), BesideTheTip(distance, 1.0));
    wired.filter().position.Fix(wired.context(), wish / Hundred().position_gain);
    wired.diagram().GetInput<ClearMotion>("clear").Fix(wired.context(), clear);
    return wired.Answer();
  };
  const ClearMotion known{.clear_for = 0.1, .bodies = {models::Name("ball")}};
  EXPECT_TRUE(answer(known, 0.06).isApprox(wish, 1e-9));
  EXPECT_TRUE(answer(known, 0.01).isApprox(wish, 1e-9));  // nor is there a wish to recover
  const Eigen::VectorXd guarded = answer({}, 0.06);
  EXPECT_LT(guarded[0], -0.5);
  EXPECT_EQ(answer({.clear_for = 0.0, .bodies = known.bodies}, 0.06), guarded);
  EXPECT_EQ(answer({.clear_for = 0.1, .bodies = {models::Name("wall")}}, 0.06), guarded);
  EXPECT_EQ(answer({.clear_for = 0.1, .bodies = {}, .own_links = true}, 0.06), guarded);
}

TEST(SafetyFilterTest, LetsTheArmMoveAwayAsFastAsItLikes) {
  const Eigen::VectorXd u = Answer(Hundred(), {-1, 0}, BesideTheTip(0.0501, 0.0));
  EXPECT_NEAR((u - Eigen::Vector2d(-1, 0)).norm(), 0.0, 1e-12);
}

TEST(SafetyFilterTest, GivesWayToAnObstacleThatComes) {
  // h = 0: the tip has to leave with the 0.3 m/s that the obstacle comes with.
  const Eigen::VectorXd u = Answer(Hundred(), {0, 0}, BesideTheTip(0.05, 0.3));
  EXPECT_NEAR(0.9 * u[0] + 0.4 * u[1], -0.3, 1e-12);
  EXPECT_NEAR(u[0] / u[1], 0.9 / 0.4, 1e-9);
}

TEST(SafetyFilterTest, BrakesAsHardAsItCanInTheBrakingForm) {
  SafetyFilter::Params params = Hundred();
  params.form = SafetyFilter::Form::kBraking;
  params.deceleration = 2.0;
  // Within 0.03 m a body that brakes with 2 m/s^2 stops from about sqrt(2 * 2 * 0.03) m/s.
  const Eigen::VectorXd u = Answer(params, {1, 0}, BesideTheTip(0.08, 0.0));
  const double speed = 0.9 * u[0] + 0.4 * u[1];
  EXPECT_NEAR(speed, motion::LargestStoppableVelocity(0.03, 2.0, kDt), 1e-12);
  EXPECT_NEAR(speed, -0.01 + std::sqrt(1e-4 + 0.12), 2e-4);
}

TEST(SafetyFilterTest, BelowTheSafeDistanceItRetreatsButNeverForbidsASlowRetreat) {
  // 0.02 m too near: 5 * 0.02 m/s of retreat are wished for.
  const Eigen::VectorXd rest = Answer(Hundred(), {0, 0}, BesideTheTip(0.03, 0.0));
  EXPECT_NEAR(0.9 * rest[0] + 0.4 * rest[1], -0.1, 1e-12);
  SafetyFilter::Params params = Hundred();
  params.recovery_penalty = 0.0;
  FilterActivity activity;
  const Eigen::VectorXd slow = Answer(params, {-0.01, 0}, BesideTheTip(0.03, 0.0), &activity);
  EXPECT_NEAR((slow - Eigen::Vector2d(-0.01, 0)).norm(), 0.0, 1e-12);
  EXPECT_EQ(activity.slack, 0.0);
  // But it does not let the arm approach.
  const Eigen::VectorXd stay = Answer(params, {0.5, 0}, BesideTheTip(0.03, 0.0));
  EXPECT_NEAR(0.9 * stay[0] + 0.4 * stay[1], 0.0, 1e-12);
}

TEST(SafetyFilterTest, RetreatIsPossibleFromDeepPenetration) {
  SafetyFilter::Params params = Hundred();
  const Eigen::VectorXd u = Answer(params, {0.5, 0}, BesideTheTip(-0.4, 0.0));
  EXPECT_NEAR(0.9 * u[0] + 0.4 * u[1], -params.recovery_speed, 1e-9);
}

TEST(SafetyFilterTest, SaysHowMuchOfARowItCouldNotKeep) {
  // Both joints at their 2 rad/s retreat with 2.6 m/s; the obstacle comes with 4.
  FilterActivity activity;
  const Eigen::VectorXd u = Answer(Hundred(), {0, 0}, BesideTheTip(0.05, 4.0), &activity);
  EXPECT_NEAR((u - Eigen::Vector2d(-2, -2)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(activity.slack, 4.0 - 2.6, 1e-9);
  ASSERT_EQ(activity.num_bounds, 3);
  EXPECT_EQ(activity.bounds[1].kind, FilterBound::Kind::kLower);
  EXPECT_EQ(activity.bounds[1].link.text(), "planar2_joint_1");
  EXPECT_EQ(activity.bounds[1].limit, motion::MotionLimit::kVelocity);
}

TEST(SafetyFilterTest, LeavesOutByNameWhatNoJointMoves) {
  // Something 0.03 m before the tip of the stretched arm, where joints move the tip sideways only:
  // it should grow by 5 * 0.02 m/s. By rounding its point lies beside the axis of the arm.
  for (const double off : {0.0, 1e-17, 1e-14, -1e-13}) {
    ProximitySet set = BesideTheTip(0.08, 0.0);
    set.proximities.push_back(set.proximities[0]);
    Proximity& before = set.proximities[1];
    before.obstacle = models::Name("post");
    before.distance = 0.03;
    before.normal = -Eigen::Vector3d::UnitX();
    before.point_on_link.y() += off;
    FilterActivity activity;
    const Eigen::VectorXd u = Answer(Hundred(), {1, 0}, set, &activity);
    EXPECT_NEAR((u - Eigen::Vector2d(1 - 0.675 / 0.97, -0.3 / 0.97)).norm(), 0.0, 1e-12) << off;
    EXPECT_EQ(activity.status, qp::QpStatus::kOptimal);
    EXPECT_EQ(activity.rows, 1);
    EXPECT_EQ(activity.slack, 0.0);
    ASSERT_EQ(activity.num_bounds, 2) << off;
    EXPECT_EQ(activity.bounds[1].kind, FilterBound::Kind::kUnmovable);
    EXPECT_EQ(activity.bounds[1].obstacle.text(), "post");
    EXPECT_NEAR(activity.bounds[1].slack, 0.1, 1e-15);
    EXPECT_EQ(activity.bounds[1].multiplier, 0.0);
  }
}

TEST(SafetyFilterTest, NamesNothingThatNoJointMovesAndThatNeedsNoMove) {
  ProximitySet set = BesideTheTip(0.06, 0.0);
  set.proximities[0].normal = -Eigen::Vector3d::UnitX();
  FilterActivity activity;
  Answer(Hundred(), {1, 0}, set, &activity);
  EXPECT_EQ(activity.num_bounds, 0);
}

TEST(SafetyFilterTest, NoWishIsFastEnoughToPayForADistance) {
  // Without the box the arm would pay slack for a wish of 1e4 rad/s and more towards the ball.
  for (const double wish : {10.0, 1e4, 1e8}) {
    Wired wired(Hundred(), {"velocity"});
    wired.filter().proximities.Fix(wired.context(), BesideTheTip(0.08, 0.0));
    wired.filter().position.Fix(wired.context(), Eigen::Vector2d(0.0, 0.0));
    wired.diagram().GetInput<Vector>("velocity").Fix(wired.context(), Eigen::Vector2d(wish, 0.0));
    const Eigen::VectorXd u = wired.Answer();
    EXPECT_LE(0.9 * u[0] + 0.4 * u[1], 0.15 + 1e-9) << wish << ": " << u.transpose();
  }
}

TEST(SafetyFilterTest, BrakesIfItHasNoProofOfItsAnswer) {
  const auto answer = [](double weight) {
    SafetyFilter::Params params = Hundred();
    params.weights = weight;
    return Answer(params, {0.5, 0.5}, BesideTheTip(0.08, 0.0));
  };
  EXPECT_GT(answer(1.0).norm(), 0.1);
  // A price so small that rows in units of it overflow.
  EXPECT_EQ(answer(1e-310), Eigen::VectorXd(Eigen::Vector2d::Zero()));
}

TEST(SafetyFilterTest, KeepsTheNearestRowsIfThereIsNoRoomForAll) {
  SafetyFilter::Params params = Hundred();
  params.most_rows = 1;
  ProximitySet set = BesideTheTip(0.2, 1.0);
  set.proximities.push_back(BesideTheTip(0.08, 0.0).proximities[0]);
  set.proximities.push_back(BesideTheTip(0.3, 1.4).proximities[0]);
  FilterActivity activity;
  Answer(params, {1, 0}, set, &activity);
  EXPECT_EQ(activity.rows, 1);
  EXPECT_EQ(activity.dropped, 2);
  EXPECT_NEAR(activity.bounds[0].multiplier, 0.75 / 0.97, 1e-12);
}

TEST(SafetyFilterTest, TurnsWithTheWorld) {
  // Everything turned about the arm's first axis: the same velocity.
  const Eigen::Isometry3d X(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  Loop loop(Hundred(), TestModels("planar2"), Eigen::Vector2d(0.7, 0));
  ProximitySet set = BesideTheTip(0.08, 0.2);
  Proximity& proximity = set.proximities[0];
  for (Eigen::Vector3d* v : {&proximity.point_on_link, &proximity.point_on_obstacle,
                             &proximity.normal, &proximity.obstacle_velocity}) {
    *v = X * *v;
  }
  loop.Tick(Eigen::Vector2d(0.9, 0), [&](const LinkPoses&) { return set; });
  const Eigen::VectorXd u = Answer(Hundred(), {1, 0}, BesideTheTip(0.08, 0.2));
  EXPECT_NEAR((loop.velocity() - u).norm(), 0.0, 1e-12);
}

TEST(SafetyFilterTest, ChangesByABoundedAmountAsAnObstacleComesNear) {
  for (const auto form : {SafetyFilter::Form::kLinear, SafetyFilter::Form::kBraking}) {
    SafetyFilter::Params params = Hundred();
    params.form = form;
    // The steepest of what a distance allows, over the lever of the row; braking ends within a
    // tick.
    const double slope = form == SafetyFilter::Form::kLinear ? params.approach_gain : 1.0 / kDt;
    constexpr double kStep = 2e-4;
    Eigen::VectorXd last = Answer(params, {1, 0}, BesideTheTip(0.15, 0.3));
    for (double distance = 0.15 - kStep; distance > -0.02; distance -= kStep) {
      const Eigen::VectorXd u = Answer(params, {1, 0}, BesideTheTip(distance, 0.3));
      ASSERT_LE((u - last).norm(), 1.01 * slope / std::hypot(0.9, 0.4) * kStep) << distance;
      last = u;
    }
    EXPECT_LT(last[0], 0.0);
  }
}

TEST(SafetyFilterTest, DoesNotChangeAsTheListOfObstaclesDoesWithoutNeed) {
  ProximitySet set = BesideTheTip(0.08, 0.0);
  const Eigen::VectorXd alone = Answer(Hundred(), {1, 0}, set);
  for (const double distance : {1.0, 0.5}) {  // whatever enters at the end of the sensors' reach
    set.proximities.push_back(BesideTheTip(distance, 0.0).proximities[0]);
    EXPECT_NEAR((Answer(Hundred(), {1, 0}, set) - alone).norm(), 0.0, 1e-12);
  }
  set.proximities.push_back(BesideTheTip(0.06, 0.1).proximities[0]);
  const Eigen::VectorXd u = Answer(Hundred(), {1, 0}, set);
  EXPECT_GT((u - alone).norm(), 1e-2);
  std::reverse(set.proximities.begin(), set.proximities.end());
  EXPECT_NEAR((Answer(Hundred(), {1, 0}, set) - u).norm(), 0.0, 1e-12);
}

TEST(SafetyFilterTest, RefusesGainsThatAPeriodCannotCarry) {
  const auto make = [](auto&& change) {
    SafetyFilter::Params params = Hundred();
    change(params);
    SafetyFilter{params, TestModels("planar2")};
  };
  EXPECT_NO_THROW(make([](auto& p) { p.approach_gain = 100.0; }));
  EXPECT_THROW(make([](auto& p) { p.approach_gain = 100.1; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.recovery_gain = 101.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.position_gain = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.safe_distance = -0.01; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.deceleration = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.slack_penalty = 0.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.recovery_penalty = -1.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.progress_weight = -1.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.recovery_speed = -1.0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.most_rows = 0; }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.period = Period(); }), ConfigError);
  EXPECT_THROW(make([](auto& p) { p.weights = Eigen::VectorXd(Eigen::Vector3d::Ones()); }),
               ConfigError);
  EXPECT_THROW(make([](auto& p) { p.weights = 0.0; }), ConfigError);
}

TEST(SafetyFilterTest, RefusesAProximityOfAStrangersLink) {
  ProximitySet set = BesideTheTip(0.08, 0.0);
  set.proximities[0].link = models::Name("lwr4_link_3");
  EXPECT_THROW(Answer(Hundred(), {0, 0}, set), SimulationError);
}

TEST(SafetyFilterTest, TicksWithoutTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  Loop loop(Hundred(), TestModels("planar2"), Eigen::Vector2d::Zero());
  const auto around = [](const LinkPoses&) { return BesideTheTip(0.08, 0.1); };
  loop.Tick(Eigen::Vector2d(1, 0), around);
  const std::int64_t before = AllocationCount();
  loop.bench().AdvanceTo(0.5);
  EXPECT_EQ(AllocationCount(), before);
}

/// Balls that drift in straight lines, and their exact distances to the links of an arm.
class Balls {
 public:
  Balls(const robot::RobotModel& model, int count, double speed, std::mt19937& random)
      : model_(model), links_(MakeLinkColliders(model)) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    while (std::ssize(balls_) < count) {
      const Eigen::Vector3d p(unit(random), unit(random), 0.5 + 0.6 * unit(random));
      if (p.norm() < 0.45 || p.head<2>().norm() < 0.3) continue;
      balls_.push_back({p, speed * Eigen::Vector3d(unit(random), unit(random), unit(random))});
    }
  }
  ProximitySet operator()(const LinkPoses& poses) const {
    ProximitySet set;
    for (const LinkCollider& link : links_) {
      if (model_.body(link.number) < 0) continue;
      for (std::size_t b = 0; b < balls_.size(); ++b) {
        const auto found =
            DistanceToBody(link, poses.poses[link.number], ball_,
                           Eigen::Isometry3d(Eigen::Translation3d(balls_[b].position)), 10.0);
        set.proximities.push_back({link.link,
                                   names_[b],
                                   found.distance,
                                   found.point_a,
                                   found.point_b,
                                   found.normal,
                                   balls_[b].velocity,
                                   {}});
      }
    }
    return set;
  }
  double Nearest(const Eigen::VectorXd& q) const {
    LinkPoses poses;
    NameLinks(model_, poses);
    robot::ForwardKinematics(model_, q, poses.poses);
    double nearest = 10.0;
    for (const Proximity& p : (*this)(poses).proximities) nearest = std::min(nearest, p.distance);
    return nearest;
  }
  void Drift(double time) {
    for (Ball& ball : balls_) ball.position += time * ball.velocity;
  }

 private:
  struct Ball {
    Eigen::Vector3d position;
    Eigen::Vector3d velocity;
  };
  const robot::RobotModel& model_;
  const std::vector<LinkCollider> links_;
  const geometry::Collider ball_{geometry::Shape(geometry::Sphere{0.08}), "ball"};
  const std::vector<models::Name> names_{models::Name("a"), models::Name("b"), models::Name("c"),
                                         models::Name("d")};
  std::vector<Ball> balls_;
};

struct Campaign {
  int ticks{0};         ///< that the bound speaks of: up to the first slack
  int endangered{0};    ///< runs whose request comes below safe_distance
  double lowest{1.0};   ///< least of h over bound; the bound holds above -1
  double nearest{1.0};  ///< least h, m
  double margin{0.0};   ///< largest, m
};

/// Arms that cross a room of balls from one random configuration to the next; between the ticks
/// they are looked at too.
Campaign Cross(SafetyFilter::Form form, double speed, int runs) {
  Campaign campaign;
  std::mt19937 random(41);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const ModelSet models = TestModels("lwr4");
  const auto model = models.Get("");
  for (int run = 0; run < runs; ++run) {
    SafetyFilter::Params params = Hundred();
    params.form = form;
    params.position_gain = 2.0;
    Balls balls(*model, 4, speed, random);
    const auto configuration = [&] {
      Eigen::VectorXd q(7);
      for (int j = 0; j < 7; ++j) q[j] = 1.2 * unit(random);
      return q;
    };
    const Eigen::VectorXd start = configuration();
    const Eigen::VectorXd goal = configuration();
    if (balls.Nearest(start) < params.safe_distance) continue;
    Loop loop(params, models, start);
    double margin = 0.0;
    double least = 1.0;
    bool endangered = false;
    for (int k = 0; k < 200; ++k) {
      const Eigen::VectorXd request = start + std::min(k / 150.0, 1.0) * (goal - start);
      const Eigen::VectorXd before = loop.q();
      const FilterActivity& activity = loop.Tick(request, balls);
      margin = std::max(margin, activity.margin);
      if (activity.slack > 1e-9) break;
      bool recovers = true;
      for (int b = 0; b < activity.num_bounds; ++b) recovers &= activity.bounds[b].slack <= 1e-9;
      if (!recovers) break;
      ++campaign.ticks;
      endangered |= balls.Nearest(request) < params.safe_distance;
      for (int part = 1; part <= 4; ++part) {
        balls.Drift(kDt / 4);
        const double h = balls.Nearest(before + 0.25 * part * (loop.q() - before)) - 0.05;
        least = std::min(least, h);
        if (h < 0.0) campaign.lowest = std::min(campaign.lowest, h / std::max(margin, 1e-9));
      }
    }
    campaign.endangered += endangered ? 1 : 0;
    campaign.nearest = std::min(campaign.nearest, least);
    campaign.margin = std::max(campaign.margin, margin);
  }
  return campaign;
}

void ExpectTheBound(SafetyFilter::Form form, double speed) {
  const Campaign campaign = Cross(form, speed, 120);
  EXPECT_GT(campaign.ticks, 5000);
  EXPECT_GT(campaign.endangered, 10);
  EXPECT_GT(campaign.lowest, -1.0);
  EXPECT_LT(campaign.nearest, 0.005);  // it goes as near as it may
  testing::Test::RecordProperty("nearest_h_mm", std::to_string(1e3 * campaign.nearest));
  testing::Test::RecordProperty("margin_mm", std::to_string(1e3 * campaign.margin));
  testing::Test::RecordProperty("share_of_margin", std::to_string(-campaign.lowest));
}

TEST(SafetyFilterTest, KeepsItsMarginAmongBallsAtRest) {
  ExpectTheBound(SafetyFilter::Form::kLinear, 0.0);
}

TEST(SafetyFilterTest, KeepsItsMarginAmongBallsThatMove) {
  ExpectTheBound(SafetyFilter::Form::kLinear, 0.3);
}

TEST(SafetyFilterTest, KeepsItsMarginInTheBrakingFormToo) {
  ExpectTheBound(SafetyFilter::Form::kBraking, 0.3);
}

}  // namespace safety_filter_test
}  // namespace oca::systems
