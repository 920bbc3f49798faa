// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/qp/projection_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tests/allocation_count.h"
#include "tests/models/qp/kkt_judge.h"
#include "tests/models/qp/random_qp.h"
#include "tests/sanitized.h"

namespace oca::qp::test {
namespace projection_solver_test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

QpSolution SolutionOf(const ProjectionQp& qp) {
  QpSolution solution(qp);
  ProjectionSolver(qp.num_variables(), qp.most_rows()).Solve(qp, solution);
  return solution;
}

/// min |u - (1, 1)|^2 / 2 with row . u >= bound - s at a price of `penalty`.
ProjectionQp OneRow(const Eigen::Vector2d& row, double bound, double penalty) {
  ProjectionQp qp(2, 1);
  qp.wish.setOnes();
  qp.num_rows = 1;
  qp.rows.row(0) = row.transpose();
  qp.bounds[0] = bound;
  qp.penalties[0] = penalty;
  return qp;
}

TEST(ProjectionSolverTest, GrantsTheWishIfNothingIsInItsWay) {
  const QpSolution solution = SolutionOf(OneRow({-1, 0}, -2, 100));
  EXPECT_EQ(solution.status, QpStatus::kOptimal);
  EXPECT_EQ(solution.u, Eigen::VectorXd(Eigen::Vector2d(1, 1)));
  EXPECT_TRUE(solution.active.empty());
  EXPECT_EQ(solution.gap, 0.0);
}

TEST(ProjectionSolverTest, ProjectsOntoARow) {
  // u1 + u2 <= 1 from (1, 1): (1/2, 1/2), multiplier 1/2.
  const QpSolution solution = SolutionOf(OneRow({-1, -1}, -1, 100));
  EXPECT_NEAR((solution.u - Eigen::Vector2d(0.5, 0.5)).norm(), 0.0, 1e-15);
  ASSERT_EQ(solution.active.size(), 1u);
  EXPECT_EQ(solution.active[0].kind, QpActive::Kind::kRow);
  EXPECT_NEAR(solution.active[0].multiplier, 0.5, 1e-15);
  EXPECT_EQ(solution.active[0].slack, 0.0);
}

TEST(ProjectionSolverTest, MeasuresTheWayByTheWeights) {
  // With weights (1, 3) the cheap variable yields three times as far: 1 = 3/4 + 1/4.
  ProjectionQp qp = OneRow({-1, -1}, -1, 100);
  qp.weights = Eigen::Vector2d(1, 3);
  EXPECT_NEAR((SolutionOf(qp).u - Eigen::Vector2d(0.25, 0.75)).norm(), 0.0, 1e-15);
}

TEST(ProjectionSolverTest, TakesSlackOnlyBeyondThePriceOfTheRow) {
  // To keep u1 <= 0 from (1, 1) takes a multiplier of 1.
  for (const double penalty : {1.001, 1.0, 0.999, 0.25}) {
    const QpSolution solution = SolutionOf(OneRow({-1, 0}, 0, penalty));
    const double slack = std::max(1.0 - penalty, 0.0);
    EXPECT_NEAR(solution.u[0], slack, 1e-15) << penalty;
    ASSERT_EQ(solution.active.size(), 1u);
    EXPECT_NEAR(solution.active[0].slack, slack, 1e-15) << penalty;
    EXPECT_NEAR(solution.active[0].multiplier, std::min(penalty, 1.0), 1e-15);
    EXPECT_LT(solution.gap, 1e-15);
  }
}

TEST(ProjectionSolverTest, NeverLeavesTheBoxForARow) {
  ProjectionQp qp = OneRow({1, 0}, 5, 1e6);
  qp.upper[0] = 2.0;
  const QpSolution solution = SolutionOf(qp);
  EXPECT_EQ(solution.u[0], 2.0);
  ASSERT_EQ(solution.active.size(), 2u);
  EXPECT_DOUBLE_EQ(solution.active[0].slack, 3.0);
  EXPECT_EQ(solution.active[1].kind, QpActive::Kind::kUpper);
  EXPECT_EQ(solution.active[1].index, 0);
}

TEST(ProjectionSolverTest, GivesTheDearerOfTwoOpposedRowsItsWay) {
  ProjectionQp qp(1, 2);
  qp.num_rows = 2;
  qp.rows << 1, -1;
  qp.bounds << 1, 1;  // u >= 1 and u <= -1
  qp.penalties << 50, 60;
  EXPECT_NEAR(SolutionOf(qp).u[0], -1.0, 1e-15);
  qp.penalties << 60, 50;
  EXPECT_NEAR(SolutionOf(qp).u[0], 1.0, 1e-15);
}

TEST(ProjectionSolverTest, IgnoresARowThatNothingMoves) {
  const QpSolution solution = SolutionOf(OneRow({0, 0}, 1, 100));
  EXPECT_EQ(solution.status, QpStatus::kOptimal);
  EXPECT_EQ(solution.u, Eigen::VectorXd(Eigen::Vector2d(1, 1)));
}

TEST(ProjectionSolverTest, AShortRowMovesNothingAndHidesNothing) {
  // u1 >= 0 against a wish of -1; a second row that nothing moves but for rounding asks for more
  // than all speeds of the box.
  for (double length = 1.0; length > 1e-19; length *= 0.1) {
    ProjectionQp qp(2, 2);
    qp.wish = Eigen::Vector2d(-1, 0);
    qp.lower.setConstant(-10);
    qp.upper.setConstant(10);
    qp.num_rows = 2;
    qp.rows << 1, 0, 0, length;
    qp.bounds << 0, 20;
    qp.penalties << 1e4, 10;
    const QpSolution solution = SolutionOf(qp);
    EXPECT_EQ(solution.status, QpStatus::kOptimal) << length;
    EXPECT_NEAR(solution.u[0], 0.0, 1e-15) << length;
    EXPECT_NEAR(solution.u[1], std::min(10.0 * length, 10.0), 1e-14) << length;
    EXPECT_LT(KktResidual(qp, solution), 1e-13L) << length;
  }
}

TEST(ProjectionSolverTest, SolvesAMillionProblemsToAProof) {
  RandomQps random(11);
  std::array<long double, RandomQps::kKinds> worst{};
  for (int k = 0; k < Fewer(1000000); ++k) {
    const int n = 1 + random.Choose(k % 50 == 0 ? 20 : 8);
    const int m = random.Choose(k % 100 == 0 ? 500 : 40);
    const int kind = k % RandomQps::kKinds;
    const ProjectionQp qp = random.Make(kind, n, m);
    const QpSolution solution = SolutionOf(qp);
    ASSERT_EQ(solution.status, QpStatus::kOptimal) << k;
    const long double residual = KktResidual(qp, solution);
    ASSERT_LT(residual, 1e-9L) << k;
    ASSERT_GE(solution.gap, -1e-12) << k;
    worst[static_cast<std::size_t>(kind)] =
        std::max(worst[static_cast<std::size_t>(kind)], residual);
  }
  for (int kind = 0; kind < RandomQps::kKinds; ++kind) {
    RecordProperty("worst_residual_of_kind_" + std::to_string(kind),
                   std::to_string(worst[static_cast<std::size_t>(kind)] * 1e12L) + "e-12");
  }
}

TEST(ProjectionSolverTest, ItsCertificateSeesAWrongAnswer) {
  const ProjectionQp qp = OneRow({-1, -1}, -1, 100);
  QpSolution solution = SolutionOf(qp);
  EXPECT_LT(solution.kkt_residual, 1e-15);
  solution.u[0] += 1e-3;
  Certify(qp, solution);
  EXPECT_GT(solution.kkt_residual, 5e-4);
  EXPECT_GT(solution.gap, 0.5e-6);
  EXPECT_GT(KktResidual(qp, solution), 5e-4L);
  solution.u[0] -= 1e-3;
  solution.active[0].multiplier *= 1.01;
  Certify(qp, solution);
  EXPECT_GT(solution.kkt_residual, 1e-3);
}

TEST(ProjectionSolverTest, AGuessChangesTheWayButNotTheAnswer) {
  RandomQps random(12);
  int fewer = 0;
  for (int k = 0; k < 2000; ++k) {
    const ProjectionQp qp = random.Make(k % RandomQps::kKinds, 7, 40);
    QpSolution solution = SolutionOf(qp);
    const Eigen::VectorXd u = solution.u;
    const int iterations = solution.iterations;
    ProjectionSolver solver(7, 40);
    solver.Solve(qp, solution);
    EXPECT_NEAR((solution.u - u).norm(), 0.0, 1e-7) << k;
    fewer += solution.iterations < iterations ? 1 : 0;
    solution.active = {{QpActive::Kind::kRow, 39, 1, 0},
                       {QpActive::Kind::kRow, -1, 1, 0},
                       {QpActive::Kind::kUpper, 7, 1, 0},
                       {QpActive::Kind::kLower, 3, 1, 0}};
    solver.Solve(qp, solution);
    EXPECT_NEAR((solution.u - u).norm(), 0.0, 1e-7) << k;
  }
  EXPECT_GT(fewer, 400);
}

TEST(ProjectionSolverTest, AnswersWithinTheBoxWhateverItIsGiven) {
  const auto answer = [](auto&& spoil) {
    ProjectionQp qp = OneRow({-1, -1}, -1, 100);
    qp.lower = Eigen::Vector2d(0.25, -1);
    qp.upper = Eigen::Vector2d(3, 3);
    spoil(qp);
    const QpSolution solution = SolutionOf(qp);
    EXPECT_EQ(solution.status, QpStatus::kInvalid);
    EXPECT_EQ(solution.gap, std::numeric_limits<double>::infinity());
    return solution.u;
  };
  const Eigen::VectorXd nearest = Eigen::Vector2d(0.25, 0);
  EXPECT_EQ(answer([](auto& qp) { qp.wish[0] = kNaN; }), nearest);
  EXPECT_EQ(answer([](auto& qp) { qp.rows(0, 1) = kNaN; }), nearest);
  EXPECT_EQ(answer([](auto& qp) { qp.rows(0, 1) = 1e200; }), nearest);
  EXPECT_EQ(answer([](auto& qp) { qp.bounds[0] = kNaN; }), nearest);
  EXPECT_EQ(answer([](auto& qp) {
              qp.rows.row(0) *= 1e-10;
              qp.bounds[0] = 1e305;
            }),
            nearest);
  EXPECT_EQ(answer([](auto& qp) { qp.penalties[0] = -1; }), nearest);
  EXPECT_EQ(answer([](auto& qp) { qp.weights[1] = 0; }), nearest);
  EXPECT_EQ(answer([](auto& qp) { qp.num_rows = 2; }), nearest);
  EXPECT_TRUE(answer([](auto& qp) { qp.lower[0] = kNaN; }).allFinite());
  EXPECT_TRUE(answer([](auto& qp) { qp.lower[1] = 3.5; }).allFinite());
}

TEST(ProjectionSolverTest, StopsAtItsLimitWithinTheBox) {
  RandomQps random(13);
  const ProjectionQp qp = random.Make(4, 7, 40);
  QpSolution solution(qp);
  ProjectionSolver solver(7, 40);
  solver.iteration_limit = 2;
  solver.Solve(qp, solution);
  EXPECT_EQ(solution.status, QpStatus::kIterationLimit);
  EXPECT_LE(solution.iterations, 3);
  EXPECT_TRUE((solution.u.array() >= qp.lower.array()).all());
  EXPECT_TRUE((solution.u.array() <= qp.upper.array()).all());
  EXPECT_GT(solution.gap, 0.0);
}

TEST(ProjectionSolverTest, SolvesWithoutTheHeap) {
  if (!kCountsAllocations) GTEST_SKIP() << "malloc is not ours to count here";
  RandomQps random(14);
  ProjectionSolver solver(20, 500);
  for (int kind = 0; kind < RandomQps::kKinds; ++kind) {
    const ProjectionQp qp = random.Make(kind, 20, 500);
    QpSolution solution(qp);
    const std::int64_t before = AllocationCount();
    solver.Solve(qp, solution);
    solver.Solve(qp, solution);
    EXPECT_EQ(AllocationCount(), before);
  }
}

}  // namespace projection_solver_test
}  // namespace oca::qp::test
