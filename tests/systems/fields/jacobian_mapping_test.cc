// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/fields/jacobian_mapping.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <cstdlib>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/fields/repulsive_field.h"
#include "oca/systems/fields/wrench_transform.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/sensing/model_links.h"
#include "oca/systems/sensing/obstacle_source.h"
#include "oca/systems/sensing/robot_kinematics.h"
#include "tests/allocation_count.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace jacobian_mapping_test {

using Method = JacobianMapping::Method;

LinkPoses LinksAt(const robot::RobotModel& model, const Eigen::VectorXd& q) {
  LinkPoses links;
  NameLinks(model, links);
  links.poses = robot::LinkPoses(model, q);
  return links;
}

Eigen::VectorXd Bent() {
  return (Eigen::VectorXd(7) << 0.3, 0.8, -0.4, -1.1, 0.5, 0.9, -0.2).finished();
}

Eigen::VectorXd DeltaOf(const JacobianMapping::Params& params, const LinkPoses& links,
                        const WrenchSet& wrenches) {
  SystemBench<JacobianMapping> bench(params, TestModels("lwr4"));
  bench->links.Fix(bench.context(), links);
  bench->wrenches.Fix(bench.context(), wrenches);
  return bench->delta.Eval(bench.context());
}

LinkWrench On(const char* link, const LinkPoses& links) {
  LinkWrench wrench{models::Name(link), {1.0, -2.0, 0.5}, {0.3, 0.1, -0.7}, {}};
  wrench.origin = links.poses[links.Find(wrench.link)].translation();
  return wrench;
}

// The upper arm of 0.5 m along x: a force of 1 N along y at its tip gives 0.5 Nm on joint 1.
TEST(JacobianMappingTest, TransposeGivesTheJointTorqueByHand) {
  SystemBench<JacobianMapping> bench(
      JacobianMapping::Params{.alpha = 2.0, .method = Method::kTranspose}, TestModels("planar2"));
  const LinkPoses links = LinksAt(*LoadTestModel("planar2"), Eigen::Vector2d::Zero());
  bench->links.Fix(bench.context(), links);
  bench->wrenches.Fix(bench.context(),
                      WrenchSet{{{models::Name("planar2_link_1"), {0, 1, 0}, {0, 0, 0.5}, {}}}});
  EXPECT_NEAR((bench->delta.Eval(bench.context()) - Eigen::Vector2d(1.0, 0.0)).norm(), 0.0, 1e-15);
}

TEST(JacobianMappingTest, TransposeOfTheMovedWrenchIsThatOfTheForceAtItsPoint) {
  const auto model = LoadTestModel("lwr4");
  const LinkPoses links = LinksAt(*model, Bent());
  for (const char* link : {"lwr4_link_1", "lwr4_link_4", "lwr4_link_7", "lwr4_flange"}) {
    const Eigen::Vector3d force(3.0, -1.0, 2.0), point(0.2, 0.4, 0.9);
    SystemBench<WrenchTransform> transform(WrenchTransform::Params{});
    transform->links.Fix(transform.context(), links);
    transform->forces.Fix(transform.context(),
                          LinkForceSet{{{models::Name(link), models::Name("box"), force, point}}});
    const Eigen::VectorXd delta = DeltaOf({.method = Method::kTranspose}, links,
                                          transform->wrenches.Eval(transform.context()));
    Eigen::Matrix3Xd J_v(3, 7);
    robot::PointJacobian(*model, links.poses, model->FindLink(link), point, J_v);
    EXPECT_NEAR((delta - J_v.transpose() * force).norm(), 0.0, 1e-13) << link;
  }
}

TEST(JacobianMappingTest, PseudoInverseAndDampedAgreeWithTheExplicitStack) {
  const auto model = LoadTestModel("lwr4");
  const LinkPoses links = LinksAt(*model, Bent());
  const WrenchSet wrenches{{On("lwr4_link_3", links), On("lwr4_link_6", links)}};
  Eigen::MatrixXd J(42, 7);
  robot::StackedJacobian(*model, links.poses, J);
  Eigen::VectorXd w = Eigen::VectorXd::Zero(42);
  for (const auto& [row, wrench] :
       {std::pair(12, wrenches.wrenches[0]), std::pair(30, wrenches.wrenches[1])}) {
    w.segment<3>(row) = wrench.force;
    w.segment<3>(row + 3) = wrench.torque;
  }
  const Eigen::VectorXd pinv = J.completeOrthogonalDecomposition().solve(w);
  EXPECT_NEAR((DeltaOf({}, links, wrenches) - pinv).norm(), 0.0, 1e-12);
  EXPECT_NEAR((DeltaOf({.alpha = -3.0}, links, wrenches) + 3.0 * pinv).norm(), 0.0, 1e-12);
  const Eigen::MatrixXd damped = J.transpose() * J + 0.25 * Eigen::MatrixXd::Identity(7, 7);
  EXPECT_NEAR((DeltaOf({.method = Method::kDamped, .damping = 0.5}, links, wrenches) -
               damped.ldlt().solve(J.transpose() * w))
                  .norm(),
              0.0, 1e-12);
}

TEST(JacobianMappingTest, AddsUpWrenchesWhereverTheirOriginIs) {
  const LinkPoses links = LinksAt(*LoadTestModel("lwr4"), Bent());
  const LinkWrench wrench = On("lwr4_link_5", links);
  LinkWrench moved = wrench;  // the same wrench, told about another point
  moved.origin += Eigen::Vector3d(0.3, -0.2, 0.5);
  moved.torque += Eigen::Vector3d(-0.3, 0.2, -0.5).cross(wrench.force);
  const Eigen::VectorXd twice = DeltaOf({}, links, WrenchSet{{wrench, moved}});
  EXPECT_NEAR((twice - 2.0 * DeltaOf({}, links, WrenchSet{{wrench}})).norm(), 0.0, 1e-13);
}

TEST(JacobianMappingTest, TakesLinksInAnyOrderAndThoseOnFixedJointsForGranted) {
  const LinkPoses links = LinksAt(*LoadTestModel("lwr4"), Bent());
  const WrenchSet wrenches{{On("lwr4_link_5", links)}};
  LinkPoses movable;
  for (int i = static_cast<int>(links.size()) - 1; i >= 0; --i) {
    if (links.bodies[i] != i) continue;
    movable.links.push_back(links.links[i]);
    movable.poses.push_back(links.poses[i]);
    movable.bodies.push_back(static_cast<int>(movable.bodies.size()));
  }
  ASSERT_EQ(movable.size(), 7u);
  EXPECT_EQ(DeltaOf({}, movable, wrenches), DeltaOf({}, links, wrenches));
}

TEST(JacobianMappingTest, IsZeroWithoutWrenchesAndForLinksThatCannotMove) {
  const LinkPoses links = LinksAt(*LoadTestModel("lwr4"), Bent());
  EXPECT_EQ(DeltaOf({}, links, {}), Eigen::VectorXd::Zero(7));
  EXPECT_EQ(DeltaOf({}, links, WrenchSet{{On("lwr4_base_link", links)}}), Eigen::VectorXd::Zero(7));
}

/// Three joints about z: two that are `gap` m apart, and one `reach` m from them; in the middle of
/// the world.
std::shared_ptr<const robot::RobotModel> LongArm(double gap, double reach) {
  std::vector<robot::Link> links(4);
  std::vector<robot::Joint> joints(3);
  for (int i = 0; i < 4; ++i) links[i].name = models::Name("link_" + std::to_string(i));
  for (int j = 0; j < 3; ++j) {
    joints[j].type = robot::JointType::kRevolute;
    joints[j].name = models::Name("joint_" + std::to_string(j));
    joints[j].parent_link = j;
    joints[j].child_link = j + 1;
    joints[j].axis = Eigen::Vector3d::UnitZ();
  }
  joints[0].X_PJ.translation().x() = -0.5 * reach;
  joints[1].X_PJ.translation().x() = gap;
  joints[2].X_PJ.translation().x() = reach;
  return std::make_shared<const robot::RobotModel>(models::Name("long"), std::move(links),
                                                   std::move(joints));
}

/// `regularised` of the arm, a moment on whose last link is to turn it.
double RegularisedOf(double gap, double reach, const JacobianMapping::Params& params = {}) {
  const auto arm = LongArm(gap, reach);
  ModelSet models;
  models.Add("long", arm);
  SystemBench<JacobianMapping> bench(params, models);
  const LinkPoses links = LinksAt(*arm, Eigen::Vector3d::Zero());
  LinkWrench wrench = On("link_3", links);
  wrench.torque.z() = 1.0;
  bench->links.Fix(bench.context(), links);
  bench->wrenches.Fix(bench.context(), WrenchSet{{wrench}});
  EXPECT_TRUE(bench->delta.Eval(bench.context()).allFinite());
  return bench->regularised.Eval(bench.context())[0];
}

TEST(JacobianMappingTest, SaysWhereNothingHadToBeDamped) {
  for (const double gap : {1.0, 0.1, 0.0}) EXPECT_EQ(RegularisedOf(gap, 3e5), 0.0) << gap;
}

// From the last link the first two joints look the same: their columns are 1 / reach rad apart.
TEST(JacobianMappingTest, SaysWhereJointsCannotBeToldApart) {
  EXPECT_EQ(RegularisedOf(0.1, 1.8e6), 1.0);
  EXPECT_EQ(RegularisedOf(0.1, 1.8e6, {.method = Method::kDamped, .damping = 0.1}), 1.0);
  EXPECT_EQ(RegularisedOf(0.1, 1.8e6, {.method = Method::kDamped, .damping = 10.0}), 0.0);
  EXPECT_EQ(RegularisedOf(0.1, 1.8e6, {.method = Method::kTranspose}), 0.0);
}

TEST(JacobianMappingTest, RefusesLinksThatAreMissingOrForeign) {
  LinkPoses links = LinksAt(*LoadTestModel("lwr4"), Bent());
  EXPECT_THROW(DeltaOf({}, links, WrenchSet{{{models::Name("leg"), {}, {}, {}}}}), SimulationError);
  links.links[4] = models::Name("leg");
  EXPECT_THROW(DeltaOf({}, links, {}), SimulationError);
  links = LinksAt(*LoadTestModel("lwr4"), Bent());
  links.links.push_back(models::Name("leg"));
  links.poses.push_back(Eigen::Isometry3d::Identity());
  links.bodies.push_back(-1);
  EXPECT_THROW(DeltaOf({}, links, {}), SimulationError);
}

TEST(JacobianMappingTest, RefusesParametersThatMakeNoMapping) {
  const ModelSet models = TestModels("planar2");
  using Params = JacobianMapping::Params;
  EXPECT_THROW(JacobianMapping(Params{.model = "lwr5"}, models), ConfigError);
  EXPECT_THROW(JacobianMapping(Params{.alpha = std::nan("")}, models), ConfigError);
  EXPECT_THROW(JacobianMapping(Params{.damping = -0.1}, models), ConfigError);
  EXPECT_THROW(JacobianMapping(Params{.method = Method::kDamped, .damping = 0.0}, models),
               ConfigError);
  EXPECT_NO_THROW(JacobianMapping(Params{.damping = 0.0}, models));
}

/// The report's chain from the position to the delta, with a ball that comes near and one that
/// appears later.
class ChainTest : public ::testing::Test {
 protected:
  ChainTest() {
    const ModelSet models = TestModels("lwr4");
    DiagramBuilder builder;
    ObstacleSource::Params source = ObstacleSource::Example();
    for (const char* id : {"ball", "guest"}) {
      ObstacleSource::ObstacleParams ball;
      ball.id = id;
      ball.shape.radius = 0.1;
      ball.pose = PoseParams{Eigen::Vector3d(1.5, 0.1, 0.8), {}, {}};
      ball.motion.emplace();
      ball.motion->type = MotionType::kLinear;
      ball.motion->velocity = Eigen::Vector3d(-0.5, 0.0, 0.0);
      source.obstacles.push_back(ball);
    }
    source.obstacles.back().appear = 1.0;
    const auto& obstacles = builder.Add<ObstacleSource>("obstacles", source);
    kinematics_ = &builder.Add<RobotKinematics>("kinematics", RobotKinematics::Params{}, models);
    const auto& distance = builder.Add<BulletDistance>(
        "distance", BulletDistance::Params{.max_distance = 0.3, .self_collision = true}, models);
    field_ = &builder.Add<RepulsiveField>("field", RepulsiveField::Params{});
    const auto& wrenches = builder.Add<WrenchTransform>("wrenches", WrenchTransform::Params{});
    mapping_ = &builder.Add<JacobianMapping>("mapping", JacobianMapping::Params{}, models);
    builder.ExportInput("position", kinematics_->position);
    builder.Connect(kinematics_->links, distance.links);
    builder.Connect(obstacles.obstacles, distance.obstacles);
    builder.Connect(distance.proximities, field_->proximities);
    builder.Connect(field_->forces, wrenches.forces);
    builder.Connect(kinematics_->links, wrenches.links);
    builder.Connect(wrenches.wrenches, mapping_->wrenches);
    builder.Connect(kinematics_->links, mapping_->links);
    diagram_ = builder.Build();
  }
  VectorView DeltaAt(Context& context, double time) const {
    Eigen::Matrix<double, 7, 1> q;
    q << 0.3 * std::sin(time), 1.2, 0.0, -0.9, 0.1 * time, 0.5, 0.0;
    diagram_->GetInput<Vector>("position").Fix(context, q);
    context.SetTime(time);
    return mapping_->delta.Eval(context);
  }
  const RobotKinematics* kinematics_;
  const RepulsiveField* field_;
  const JacobianMapping* mapping_;
  std::unique_ptr<Diagram> diagram_;
};

TEST_F(ChainTest, TakesNoMemoryAfterTheFirstTick) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  Context context = diagram_->MakeContext();
  DeltaAt(context, 0.0);
  const std::size_t forces_at_first = field_->forces.Eval(context).forces.size();
  double largest = 0.0;
  std::size_t most_forces = 0;
  // The names of ports are looked up before counting starts.
  const auto position = diagram_->GetInput<Vector>("position");
  Eigen::Matrix<double, 7, 1> q;
  const std::int64_t before = AllocationCount();
  for (int tick = 1; tick <= 300; ++tick) {
    const double time = 0.01 * tick;
    q << 0.3 * std::sin(time), 1.2, 0.0, -0.9, 0.1 * time, 0.5, 0.0;
    position.Fix(context, q);
    context.SetTime(time);
    largest = std::max(largest, mapping_->delta.Eval(context).norm());
    most_forces = std::max(most_forces, field_->forces.Eval(context).forces.size());
  }
  EXPECT_EQ(AllocationCount(), before);
  EXPECT_GT(largest, 1.0);
  EXPECT_GE(most_forces, forces_at_first + 2);
}

TEST_F(ChainTest, AClonedContextGoesOnWithTheSameBits) {
  Context context = diagram_->MakeContext();
  DeltaAt(context, 1.7);
  Context clone = context;
  for (const double time : {1.8, 2.2}) {
    const Eigen::VectorXd expected = DeltaAt(context, time);
    EXPECT_EQ(DeltaAt(clone, time), expected);
    Context fresh = diagram_->MakeContext();
    EXPECT_EQ(DeltaAt(fresh, time), expected);
    EXPECT_GT(expected.norm(), 0.0);
  }
}

}  // namespace jacobian_mapping_test
}  // namespace oca::systems
