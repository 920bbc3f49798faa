// SPDX-License-Identifier: BSD-3-Clause
// Kinematics against Orocos KDL, an implementation of other people.
#include <gtest/gtest.h>

#include <filesystem>
#include <kdl/tree.hpp>
#include <kdl/treefksolverpos_recursive.hpp>
#include <kdl/treejnttojacsolver.hpp>

#include "oca/models/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "tests/kdl_convert.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace kdl_comparison_test {

using oca::test::ToKdl;

Eigen::Matrix4d ToEigen(const KDL::Frame& frame) {
  Eigen::Matrix4d X = Eigen::Matrix4d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) X(row, column) = frame.M(row, column);
    X(row, 3) = frame.p(row);
  }
  return X;
}

// The same robot for KDL, where every movable joint, a mimic too, has a position of its own.
class KdlRobot {
 public:
  explicit KdlRobot(const RobotModel& model) : model_(model), tree_("world") {
    const auto add = [this](const Link& link, const KDL::Joint& joint, const KDL::Frame& tip,
                            const std::string& parent) {
      ASSERT_TRUE(tree_.addSegment(KDL::Segment(link.name.text(), joint, tip), parent));
    };
    add(model.links()[0], KDL::Joint("base", KDL::Joint::None), ToKdl(model.X_WB()), "world");
    for (const Joint& joint : model.joints()) {
      const KDL::Frame tip = ToKdl(joint.X_PJ);
      const KDL::Joint::JointType type =
          joint.type == JointType::kPrismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
      add(model.links()[joint.child_link],
          joint.movable() ? KDL::Joint(joint.name.text(), tip.p, tip.M * ToKdl(joint.axis), type)
                          : KDL::Joint(joint.name.text(), KDL::Joint::None),
          tip, model.links()[joint.parent_link].name.text());
    }
  }

  // KDL's positions and how they change with q, by the rules as they were given.
  std::pair<KDL::JntArray, Eigen::MatrixXd> Positions(const Eigen::VectorXd& q) const {
    // A copy numbers its joints anew, depth first, and the solvers work on copies.
    const KDL::Tree copy(tree_);
    KDL::JntArray all(copy.getNrOfJoints());
    Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(all.rows(), q.size());
    for (const Joint& joint : model_.joints()) {
      if (!joint.movable()) continue;
      const auto row = copy.getSegment(model_.links()[joint.child_link].name.text())->second.q_nr;
      const Mimic rule = joint.mimic.value_or(Mimic{});
      const Joint& master = joint.mimic ? model_.joints()[rule.joint] : joint;
      all(row) = rule.multiplier * q[master.position_index] + rule.offset;
      rates(row, master.position_index) = rule.multiplier;
    }
    return {all, rates};
  }

  const KDL::Tree& tree() const { return tree_; }

 private:
  const RobotModel& model_;
  KDL::Tree tree_;
};

void ExpectSameKinematics(const RobotModel& model, const Eigen::VectorXd& q) {
  KdlRobot kdl(model);
  const auto [all, rates] = kdl.Positions(q);
  KDL::TreeFkSolverPos_recursive poses(kdl.tree());
  KDL::TreeJntToJacSolver jacobians(kdl.tree());
  const std::vector<Eigen::Isometry3d> X_WL = LinkPoses(model, q);
  Eigen::MatrixXd stacked(6 * model.num_bodies(), model.num_positions());
  StackedJacobian(model, X_WL, stacked);
  for (int link = 0; link < model.num_links(); ++link) {
    const std::string& name = model.links()[link].name.text();
    KDL::Frame frame;
    ASSERT_EQ(poses.JntToCart(all, frame, name), 0);
    EXPECT_LT((X_WL[link].matrix() - ToEigen(frame)).cwiseAbs().maxCoeff(), 1e-12) << name;

    KDL::Jacobian columns(kdl.tree().getNrOfJoints());
    ASSERT_EQ(jacobians.JntToJac(all, columns, name), 0);
    const Eigen::MatrixXd expected = columns.data * rates;
    Eigen::MatrixXd J(6, model.num_positions());
    LinkJacobian(model, X_WL, link, J);
    EXPECT_LT((J - expected).cwiseAbs().maxCoeff(), 1e-12) << name;
    if (model.body(link) == link) {
      const auto block = stacked.middleRows<6>(6 * model.body_index(link));
      EXPECT_LT((block - expected).cwiseAbs().maxCoeff(), 1e-12) << name;
    }
  }
}

TEST(KdlComparisonTest, RandomChainsOfAllJointTypesAgree) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const RobotModel model = RandomRobot(random, 1 + i % 10, true);
    ExpectSameKinematics(model, RandomPositions(model, random));
  }
}

TEST(KdlComparisonTest, RandomTreesOfAllJointTypesAgree) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const RobotModel model = RandomRobot(random, 1 + i % 15, false);
    ExpectSameKinematics(model, RandomPositions(model, random));
  }
}

TEST(KdlComparisonTest, Lwr4Agrees) {
  Random random(3);
  const RobotModel model = LoadUrdf(ProductFile("robots/lwr4/lwr4.urdf"));
  for (int i = 0; i < 20; ++i) ExpectSameKinematics(model, RandomPositions(model, random));
}

TEST(KdlComparisonTest, TwoArmsOnOneFrameAgree) {
  Random random(4);
  const RobotModel model = LoadUrdf(ProductFile("robots/lwr4_dual/lwr4_dual.urdf"));
  for (int i = 0; i < 20; ++i) ExpectSameKinematics(model, RandomPositions(model, random));
}

class PublicRobotTest : public testing::TestWithParam<const char*> {};

TEST_P(PublicRobotTest, AgreesWithKdl) {
  const std::string file = SharedRobot(GetParam());
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "shared test data absent: " << GetParam();
  Random random(5);
  const RobotModel model = LoadUrdf(file);
  EXPECT_EQ(model.num_positions(), 7);
  for (int i = 0; i < 20; ++i) ExpectSameKinematics(model, RandomPositions(model, random));
}

INSTANTIATE_TEST_SUITE_P(
    Kuka, PublicRobotTest, testing::Values("kuka_lwr/kuka.urdf", "kuka_iiwa/model.urdf"),
    [](const auto& test) {
      return std::string(test.param).substr(0, std::string(test.param).find('/'));
    });

TEST(PublicRobotsTest, EveryPublicDescriptionLoadsAsItIs) {
  const std::filesystem::path folder = SharedRobot("");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "shared test data absent: " << folder;
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    // One of them names coarse meshes that are not there.
    if (entry.path().extension() != ".urdf") continue;
    if (entry.path().filename() == "model_for_sdf.urdf") {
      EXPECT_THROW(LoadUrdf(entry.path()), models::ModelError);
      continue;
    }
    ++files;
    const RobotModel model = LoadUrdf(entry.path());
    EXPECT_EQ(model.num_positions(), 7) << entry.path();
    int solids = 0;
    for (const Link& link : model.links()) solids += static_cast<int>(link.collisions.size());
    EXPECT_GE(solids, 8) << entry.path();
  }
  EXPECT_EQ(files, 4);
}

}  // namespace kdl_comparison_test
}  // namespace oca::robot::test
