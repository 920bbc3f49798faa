// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_curve.h"

#include <gtest/gtest.h>

#include <cmath>

namespace oca::planning {
namespace band_curve_test {

using Eigen::VectorXd;

BandCurve Uneven() { return {2, {0.0, 0.1, 0.2, 0.35, 0.6, 1.0, 1.4, 2.0, 2.6}}; }

VectorXd At(const BandCurve& curve, double time, int derivative) {
  VectorXd x(curve.size());
  curve.Evaluate(time, derivative, x);
  return x;
}

TEST(BandCurveTest, WeightsSumToOneAndTheirDerivativesToZero) {
  const BandCurve curve = Uneven();
  for (double t = 0.0; t <= 2.6; t += 0.013) {
    const BandCurve::Basis basis = curve.BasisAt(t);
    double sums[3] = {};
    for (int d = 0; d < 3; ++d) {
      for (const double weight : basis.weights[d]) sums[d] += weight;
    }
    EXPECT_NEAR(sums[0], 1.0, 1e-14);
    EXPECT_NEAR(sums[1], 0.0, 1e-12);
    EXPECT_NEAR(sums[2], 0.0, 1e-10);
  }
}

TEST(BandCurveTest, UniformWeightsAreThoseOfTheCardinalSpline) {
  const BandCurve curve(1, {0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
  const BandCurve::Basis basis = curve.BasisAt(2.0);
  EXPECT_EQ(basis.first, 2);
  EXPECT_NEAR(basis.weights[0][0], 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(basis.weights[0][1], 4.0 / 6.0, 1e-15);
  EXPECT_NEAR(basis.weights[0][2], 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(basis.weights[0][3], 0.0, 1e-15);
}

TEST(BandCurveTest, StartsInTheStateThatItIsGiven) {
  BandCurve curve = Uneven();
  curve.controls().setRandom();
  const Eigen::Vector2d x(0.3, -0.2), v(1.5, 0.25), a(-4.0, 7.0);
  curve.StartWith(x, v, a);
  EXPECT_TRUE(At(curve, 0.0, 0).isApprox(x, 1e-12));
  EXPECT_TRUE(At(curve, 0.0, 1).isApprox(v, 1e-12));
  EXPECT_TRUE(At(curve, 0.0, 2).isApprox(a, 1e-10));
}

TEST(BandCurveTest, ItsDerivativesAreThoseOfItsPositionAndContinuous) {
  BandCurve curve = Uneven();
  for (int i = 0; i < curve.controls().cols(); ++i) {
    curve.controls().col(i) << std::sin(1.7 * i), std::cos(2.3 * i);
  }
  constexpr double kStep = 1e-6;
  for (double t = 0.0505; t < 2.5; t += 0.037) {
    for (int d = 1; d < 3; ++d) {
      const VectorXd numeric =
          (At(curve, t + kStep, d - 1) - At(curve, t - kStep, d - 1)) / (2.0 * kStep);
      EXPECT_LT((At(curve, t, d) - numeric).norm(), 1e-3 * (1.0 + numeric.norm())) << t;
    }
  }
  for (const double knot : {0.1, 0.35, 1.0, 2.0}) {
    EXPECT_LT((At(curve, knot - 1e-9, 2) - At(curve, knot + 1e-9, 2)).norm(), 1e-4) << knot;
  }
}

TEST(BandCurveTest, RestsAtItsEndAndStaysThere) {
  BandCurve curve = Uneven();
  curve.Follow([](double t) { return Eigen::Vector2d(t, 1.0); });
  EXPECT_TRUE(At(curve, 2.6, 0).isApprox(Eigen::Vector2d(2.6, 1.0), 1e-12));
  EXPECT_LT(At(curve, 2.6, 1).norm(), 1e-12);
  EXPECT_LT(At(curve, 2.6, 2).norm(), 1e-10);
  EXPECT_TRUE(At(curve, 9.0, 0).isApprox(Eigen::Vector2d(2.6, 1.0), 1e-12));
  EXPECT_EQ(At(curve, 9.0, 1).norm(), 0.0);
}

}  // namespace band_curve_test
}  // namespace oca::planning
