// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/loop_gain.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/basics/constant.h"
#include "oca/systems/fields/delta_limiter.h"
#include "oca/systems/fields/delta_overlay.h"
#include "oca/systems/fields/delta_relaxation.h"
#include "oca/systems/fields/repulsive_field.h"
#include "oca/systems/fields/wrench_transform.h"
#include "oca/systems/plants/integrator_plant.h"
#include "oca/systems/plants/joint_servo.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/sensing/obstacle_source.h"
#include "oca/systems/sensing/robot_kinematics.h"
#include "tests/allocation_count.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace loop_gain_test {

using Method = JacobianMapping::Method;
constexpr double kDt = 0.01;

Eigen::VectorXd Bent() {
  return (Eigen::VectorXd(7) << 0.3, 0.8, -0.4, -1.1, 0.5, 0.9, -0.2).finished();
}

ContactSlope Contact(const char* link, const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                     double slope) {
  ContactSlope contact;
  contact.link = models::Name(link);
  contact.point_on_link = point;
  contact.normal = normal.normalized();
  contact.slope = slope * contact.normal;
  return contact;
}

LinkPoses LinksAt(const robot::RobotModel& model, const Eigen::VectorXd& q) {
  LinkPoses links;
  NameLinks(model, links);
  links.poses = robot::LinkPoses(model, q);
  return links;
}

struct Answer {
  double gain;
  double time;
};

Answer Estimate(LoopGain::Params params, const ContactSlopes& slopes,
                const std::string& model = "lwr4") {
  params.period = Period(1, 100);
  SystemBench<LoopGain> bench(params, TestModels(model));
  const auto robot = LoadTestModel(model);
  const Eigen::VectorXd q = robot->num_positions() == 7 ? Bent() : Eigen::VectorXd::Zero(2);
  bench->links.Fix(bench.context(), LinksAt(*robot, q));
  bench->slopes.Fix(bench.context(), slopes);
  return {bench->gain.Eval(bench.context())[0], bench->relaxation_time.Eval(bench.context())[0]};
}

// The upper arm along x, a contact 0.5 m out that pushes along y: b = (0.5, 0), so g = 100 / 4.
TEST(LoopGainTest, IsSlopeTimesLeverSquaredForTheTransposeOfOneContact) {
  const ContactSlopes slopes{
      {Contact("planar2_link_1", {0.5, 0.0, 0.0}, Eigen::Vector3d::UnitY(), 100.0)}};
  const Answer answer = Estimate({.alpha = 2.0, .method = Method::kTranspose}, slopes, "planar2");
  EXPECT_NEAR(answer.gain, 50.0, 1e-12);
  EXPECT_NEAR(answer.time, 2.0 * kDt * 51.0 / 2.0, 1e-12);
}

TEST(LoopGainTest, TheParameterCountsWhereTheLoopIsStableAnyway) {
  EXPECT_EQ(Estimate({.relaxation_time = 0.1}, {}).time, 0.1);
  EXPECT_EQ(Estimate({.relaxation_time = 0.1}, {}).gain, 0.0);
  EXPECT_EQ(Estimate({.safety = 3.0}, {}).time, 0.015);
}

TEST(LoopGainTest, AForceThatAnswersToTheRateCountsTwicePerPeriod) {
  ContactSlopes slopes{{Contact("lwr4_link_5", {0.2, 0.1, 0.8}, {1, 2, 3}, 0.0)}};
  slopes.slopes[0].damping = slopes.slopes[0].normal;
  const double with_damping = Estimate({}, slopes).gain;
  slopes.slopes[0].slope = 2.0 / kDt * slopes.slopes[0].normal;
  slopes.slopes[0].damping.setZero();
  EXPECT_NEAR(with_damping, Estimate({}, slopes).gain, 1e-12);
}

// Against the eigenvalues of the explicit matrix.
TEST(LoopGainTest, NeverUnderestimatesAndIsExactForOneContact) {
  const auto model = LoadTestModel("lwr4");
  const auto X_WL = robot::LinkPoses(*model, Bent());
  Eigen::MatrixXd J(6 * model->num_bodies(), 7);
  robot::StackedJacobian(*model, X_WL, J);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const char* const links[] = {"lwr4_link_2", "lwr4_link_4", "lwr4_link_5", "lwr4_link_7"};
  for (int sample = 0; sample < 40; ++sample) {
    const int contacts = 1 + sample % 4;
    ContactSlopes slopes;
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(7, 7);
    for (int i = 0; i < contacts; ++i) {
      const auto any = [&] {
        return Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
      };
      slopes.slopes.push_back(Contact(links[i], any(), any(), 1000.0 * (1.1 + uniform(random))));
      Eigen::Matrix3Xd J_v(3, 7);
      const ContactSlope& made = slopes.slopes.back();
      robot::PointJacobian(*model, X_WL, model->FindLink(links[i]), made.point_on_link, J_v);
      S += J_v.transpose() * made.slope * made.normal.transpose() * J_v;
    }
    const auto radius = [](const Eigen::MatrixXd& A) {
      return Eigen::EigenSolver<Eigen::MatrixXd>(A, false).eigenvalues().cwiseAbs().maxCoeff();
    };
    const double slack = contacts == 1 ? 1.0 + 1e-9 : 1.07;
    const double transpose = Estimate({.method = Method::kTranspose}, slopes).gain;
    EXPECT_GE(transpose, radius(S) * (1.0 - 1e-9));
    EXPECT_LE(transpose, radius(S) * slack);
    const double inverse = radius((J.transpose() * J).llt().solve(S));
    const double pinv = Estimate({}, slopes).gain;
    EXPECT_GE(pinv, inverse * (1.0 - 1e-9));
    EXPECT_LE(pinv, inverse * slack);
  }
}

// A pair of own links is told of from either side; both entries together are the one contact.
TEST(LoopGainTest, APairOfOwnLinksCountsOnce) {
  const auto model = LoadTestModel("lwr4");
  ContactSlope one = Contact("lwr4_link_6", {0.3, 0.2, 0.5}, {1, 1, 0}, 50.0);
  one.own_link = models::Name("lwr4_link_2");
  one.point_on_obstacle = {0.2, 0.1, 0.5};
  ContactSlope other = one;
  std::swap(other.link, other.own_link);
  std::swap(other.point_on_link, other.point_on_obstacle);
  other.normal = -one.normal;
  other.slope = -one.slope;
  Eigen::VectorXd row(7);
  robot::DistanceRow(*model, robot::LinkPoses(*model, Bent()), model->FindLink("lwr4_link_6"),
                     one.point_on_link, model->FindLink("lwr4_link_2"), one.point_on_obstacle,
                     one.normal, row);
  EXPECT_NEAR(Estimate({.method = Method::kTranspose}, {{one, other}}).gain,
              50.0 * row.squaredNorm(), 1e-9);
}

/// The loop of the report about an arm that should hold still near a ball, with a relaxation time.
/// Returns how much the delta changes from tick to tick after 40 s, and the gain and the least
/// relaxation time there.
struct Loop {
  double change;
  double gain;
  double least;
};

ObstacleSource::Params OneBall() {
  ObstacleSource::Params sources;
  sources.obstacles.push_back({.id = "ball"});
  sources.obstacles[0].shape.type = ShapeType::kSphere;
  sources.obstacles[0].shape.radius = 0.05;
  sources.obstacles[0].pose.emplace();
  sources.obstacles[0].pose->xyz = {0.55, 0.3, 0.3};
  return sources;
}

/// After 40 s.
Loop Watch(Simulator& simulator, const DeltaLimiter& limiter, const LoopGain& gain) {
  simulator.AdvanceTo(40.0);
  Loop loop{};
  for (int k = 1; k <= 20; ++k) {
    const Eigen::VectorXd before = limiter.limited_delta.Eval(simulator.context());
    simulator.AdvanceTo(40.0 + k * kDt);
    const Eigen::VectorXd after = limiter.limited_delta.Eval(simulator.context());
    loop.change = std::max(loop.change, (after - before).cwiseAbs().maxCoeff());
  }
  loop.gain = gain.gain.Eval(simulator.context())[0];
  loop.least = robot::LeastRelaxationTime(loop.gain, kDt);
  return loop;
}

Loop Settle(Method method, double relaxation_time, bool adaptive) {
  const Period period(1, 100);
  const ModelSet models = TestModels("lwr4");
  const Eigen::VectorXd home =
      (Eigen::VectorXd(7) << 0.0, 1.48, 0.0, -0.6, 0.0, 0.5, 0.0).finished();
  DiagramBuilder builder;
  const auto& request =
      builder.Add<Constant>("request", Constant::Params{.value = home, .unit = "rad"});
  const auto& overlay =
      builder.Add<DeltaOverlay>("overlay", DeltaOverlay::Params{.period = period});
  const auto& servo = builder.Add<JointServo>("servo", JointServo::Params{.period = period});
  const auto& plant =
      builder.Add<IntegratorPlant>("plant", IntegratorPlant::Params{.initial_position = home});
  const auto& kinematics =
      builder.Add<RobotKinematics>("kinematics", RobotKinematics::Params{}, models);
  const auto& obstacles = builder.Add<ObstacleSource>("obstacles", OneBall());
  const auto& distance = builder.Add<BulletDistance>("distance", BulletDistance::Params{}, models);
  const auto& field = builder.Add<RepulsiveField>("field", RepulsiveField::Params{});
  const auto& wrenches = builder.Add<WrenchTransform>("wrenches", WrenchTransform::Params{});
  const auto& mapping =
      builder.Add<JacobianMapping>("mapping", JacobianMapping::Params{.method = method}, models);
  const auto& gain =
      builder.Add<LoopGain>("gain", LoopGain::Params{.method = method, .period = period}, models);
  const auto& relaxation = builder.Add<DeltaRelaxation>(
      "relaxation", DeltaRelaxation::Params{.relaxation_time = relaxation_time, .period = period});
  const auto& limiter = builder.Add<DeltaLimiter>(
      "limiter", DeltaLimiter::Params{.max_joint_velocity = 0.6, .period = period});
  builder.Connect(request.value, overlay.request);
  builder.Connect(overlay.position, servo.position);
  builder.Connect(plant.position, servo.measured_position);
  builder.Connect(servo.command, plant.command);
  builder.Connect(plant.position, kinematics.position);
  builder.Connect(kinematics.links, distance.links);
  builder.Connect(obstacles.obstacles, distance.obstacles);
  builder.Connect(distance.proximities, field.proximities);
  builder.Connect(field.forces, wrenches.forces);
  builder.Connect(kinematics.links, wrenches.links);
  builder.Connect(wrenches.wrenches, mapping.wrenches);
  builder.Connect(kinematics.links, mapping.links);
  builder.Connect(field.slopes, gain.slopes);
  builder.Connect(kinematics.links, gain.links);
  builder.Connect(mapping.delta, relaxation.delta);
  builder.Connect(relaxation.relaxed_delta, limiter.delta);
  builder.Connect(limiter.limited_delta, overlay.delta);
  if (adaptive) {
    builder.Connect(gain.relaxation_time, relaxation.relaxation_time);
    builder.Connect(limiter.limited_delta, relaxation.held);
  }
  const auto diagram = builder.Build();
  Simulator simulator(*diagram);
  return Watch(simulator, limiter, gain);
}

// The bound from both sides, at the equilibrium that a calm loop finds. Curvature of the contact,
// which the estimate leaves out, is worth less than the margin of 10 %.
TEST(LoopGainTest, ALoopSettlesAboveTheLeastTimeAndChattersBelowIt) {
  for (const Method method : {Method::kTranspose, Method::kPseudoInverse}) {
    const Loop calm = Settle(method, 1.0, false);
    ASSERT_LT(calm.change, 1e-9);
    ASSERT_GT(calm.gain, 3.0);
    EXPECT_LT(Settle(method, 1.1 * calm.least, false).change, 1e-6);
    EXPECT_GT(Settle(method, 0.9 * calm.least, false).change, 1e-3);
  }
}

TEST(LoopGainTest, ALoopThatTakesTheTimeItIsToldSettles) {
  for (const Method method : {Method::kTranspose, Method::kPseudoInverse}) {
    EXPECT_LT(Settle(method, 0.0, true).change, 1e-9);
    EXPECT_GT(Settle(method, 0.0, false).change, 1e-3);  // else there is nothing to calm
  }
}

TEST(LoopGainTest, TakesNothingFromTheHeapOnceItsListsAreLongEnough) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const auto model = LoadTestModel("lwr4");
  robot::LoopGainWorkspace workspace(*model);
  const auto X_WL = robot::LinkPoses(*model, Bent());
  const std::vector<robot::GainContact> contacts{
      {5, {0.2, 0.1, 0.9}, -1, {}, Eigen::Vector3d::UnitX(), {10.0, 1.0, 0.0}},
      {7, {0.3, 0.1, 0.9}, 2, {0.1, 0.1, 0.4}, Eigen::Vector3d::UnitY(), {0.0, 20.0, 0.0}}};
  const std::int64_t before = AllocationCount();
  const double gain = robot::LoopGainOf(*model, X_WL, contacts, {}, workspace);
  EXPECT_EQ(AllocationCount(), before);
  EXPECT_GT(gain, 0.0);
}

TEST(LoopGainTest, RefusesSafetyBelowOneAndPeriodZeroAndForeignLinks) {
  const ModelSet models = TestModels("lwr4");
  EXPECT_THROW(LoopGain({.safety = 0.999, .period = Period(1, 100)}, models), ConfigError);
  EXPECT_NO_THROW(LoopGain({.safety = 1.0, .period = Period(1, 100)}, models));
  EXPECT_THROW(LoopGain({}, models), ConfigError);
  EXPECT_THROW(
      Estimate({}, {{Contact("nobody", Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(), 1.0)}}),
      std::runtime_error);
}

}  // namespace loop_gain_test
}  // namespace oca::systems
