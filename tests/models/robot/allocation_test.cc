// SPDX-License-Identifier: BSD-3-Clause
// What runs each tick takes no memory from the heap: every malloc is counted,
// which is where operator new and Eigen take theirs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "oca/models/robot/jacobian_mapping.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"
#include "tests/allocation_count.h"
#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace allocation_test {

TEST(AllocationTest, TheCounterSeesWhatEigenAndTheStandardLibraryTake) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  const std::int64_t before = AllocationCount();
  const Eigen::VectorXd vector = Eigen::VectorXd::Zero(100);
  EXPECT_EQ(AllocationCount(), before + 1);
  const std::vector<double> other(vector.data(), vector.data() + 100);
  EXPECT_EQ(AllocationCount(), before + 2) << other.size();
}

void ExpectNoAllocation(const char* file) {
  Random random(31);
  const RobotModel model = LoadUrdf(ProductFile(file));
  const Eigen::VectorXd q = RandomPositions(model, random);
  std::vector<Eigen::Isometry3d> X_WL(model.num_links());
  std::vector<BodyWrench> wrenches(model.num_bodies());
  for (BodyWrench& wrench : wrenches) wrench.force.x() = 1.0;
  Matrix6X J(6, model.num_positions());
  Eigen::Matrix3Xd J_v(3, model.num_positions());
  Eigen::MatrixXd stacked(6 * model.num_bodies(), model.num_positions());
  Eigen::VectorXd delta(model.num_positions());
  MappingWorkspace workspace(model);

  const std::int64_t before = AllocationCount();
  ForwardKinematics(model, q, X_WL);
  LinkJacobian(model, X_WL, model.num_links() - 1, J);
  PointJacobian(model, X_WL, model.num_links() - 1, Eigen::Vector3d::Ones(), J_v);
  StackedJacobian(model, X_WL, stacked);
  for (const auto method :
       {MappingMethod::kTranspose, MappingMethod::kPseudoInverse, MappingMethod::kDamped}) {
    MapWrenches(model, X_WL, wrenches, {method, 1.0, 0.1}, workspace, delta);
  }
  EXPECT_EQ(AllocationCount(), before) << file;
}

TEST(AllocationTest, KinematicsAndMappingTakeNoMemory) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  ExpectNoAllocation("robots/planar2/planar2.urdf");
  ExpectNoAllocation("robots/lwr4/lwr4.urdf");
  ExpectNoAllocation("robots/lwr4_dual/lwr4_dual.urdf");
}

}  // namespace allocation_test
}  // namespace oca::robot::test
