// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/pseudo_inverse.h"

#include <gtest/gtest.h>

#include "tests/models/robot/random_robot.h"

namespace oca::robot::test {
namespace pseudo_inverse_test {

Eigen::MatrixXd RandomMatrix(Random& random, int rows, int columns) {
  Eigen::MatrixXd matrix(rows, columns);
  for (double& entry : matrix.reshaped()) entry = Uniform(random, -1.0, 1.0);
  return matrix;
}

// The four conditions of Penrose 1955, which define the inverse.
void ExpectPseudoInverse(const Eigen::MatrixXd& J, const Eigen::MatrixXd& inverse) {
  ASSERT_EQ(inverse.rows(), J.cols());
  ASSERT_EQ(inverse.cols(), J.rows());
  const Eigen::MatrixXd onto_rows = J * inverse, onto_columns = inverse * J;
  EXPECT_LT((onto_rows * J - J).norm(), 1e-10);
  EXPECT_LT((onto_columns * inverse - inverse).norm(), 1e-10 * (1.0 + inverse.norm()));
  EXPECT_LT((onto_rows - onto_rows.transpose()).norm(), 1e-10);
  EXPECT_LT((onto_columns - onto_columns.transpose()).norm(), 1e-10);
}

TEST(PseudoInverseTest, IndependentRows) {
  Random random(61);
  for (int i = 0; i < 20; ++i) {
    const Eigen::MatrixXd J = RandomMatrix(random, 3, 7);
    ExpectPseudoInverse(J, PseudoInverse(J));
    EXPECT_TRUE((J * PseudoInverse(J)).isIdentity(1e-10));
  }
}

TEST(PseudoInverseTest, IndependentColumns) {
  Random random(62);
  for (int i = 0; i < 20; ++i) {
    const Eigen::MatrixXd J = RandomMatrix(random, 42, 7);
    ExpectPseudoInverse(J, PseudoInverse(J));
    EXPECT_TRUE((PseudoInverse(J) * J).isIdentity(1e-10));
  }
}

TEST(PseudoInverseTest, NeitherRowsNorColumnsIndependent) {
  Random random(63);
  for (int i = 0; i < 20; ++i) {
    for (const auto& [rows, columns] : {std::pair(6, 7), std::pair(7, 6), std::pair(5, 5)}) {
      const Eigen::MatrixXd J = RandomMatrix(random, rows, 3) * RandomMatrix(random, 3, columns);
      ExpectPseudoInverse(J, PseudoInverse(J));
    }
  }
}

TEST(PseudoInverseTest, ByHand) {
  const Eigen::RowVector2d J(3.0, 4.0);
  EXPECT_LT((PseudoInverse(J) - Eigen::Vector2d(0.12, 0.16)).norm(), 1e-15);
  EXPECT_LT((PseudoInverse(J.transpose()) - Eigen::RowVector2d(0.12, 0.16)).norm(), 1e-15);
  EXPECT_EQ(PseudoInverse(Eigen::MatrixXd::Zero(2, 3)), Eigen::MatrixXd::Zero(3, 2));
  EXPECT_EQ(PseudoInverse(Eigen::MatrixXd(0, 3)).rows(), 3);
  // 3 / (25 + 75) and 4 / (25 + 75).
  EXPECT_LT((DampedPseudoInverse(J, std::sqrt(75.0)) - Eigen::Vector2d(0.03, 0.04)).norm(), 1e-15);
}

TEST(PseudoInverseTest, DampedTendsToItAsTheDampingVanishes) {
  Random random(64);
  for (const auto& [rows, columns] : {std::pair(3, 7), std::pair(42, 7), std::pair(6, 7)}) {
    const Eigen::MatrixXd J = RandomMatrix(random, rows, 3) * RandomMatrix(random, 3, columns);
    const Eigen::MatrixXd limit = PseudoInverse(J);
    const double coarse = (DampedPseudoInverse(J, 1e-2) - limit).norm();
    const double fine = (DampedPseudoInverse(J, 1e-3) - limit).norm();
    EXPECT_LT(fine, 1e-3 * (1.0 + limit.norm()));
    EXPECT_NEAR(coarse / fine, 100.0, 5.0);  // the error goes with the square of the damping
  }
}

}  // namespace pseudo_inverse_test
}  // namespace oca::robot::test
