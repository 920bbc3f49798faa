// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_certificate.h"

#include <gtest/gtest.h>

#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace band_certificate_test {

using Eigen::VectorXd;

/// The arm of two joints turns from -0.5 to 0.5 rad in 0.4 s, at rest before and after.
class Swing {
 public:
  explicit Swing(std::vector<robot::PlacedBody> bodies)
      : clearance(test::Arm("planar2"), false, std::move(bodies)), curve(2, Times()) {}
  double Until(double hard, double from = 0.0) {
    BandCertificate certificate(clearance, hard, 0.045);
    return certificate.Until(
        [](double time, int derivative, Eigen::Ref<VectorXd> out) {
          const double s = std::clamp(time / 0.4, 0.0, 1.0);
          const double inside = time >= 0.0 && time <= 0.4 ? 1.0 : 0.0;
          const double shape[3] = {s * s * (3.0 - 2.0 * s) - 0.5, inside * 15.0 * s * (1.0 - s),
                                   inside * 37.5 * (1.0 - 2.0 * s)};
          out.setZero();
          out[0] = shape[derivative];
        },
        curve, from);
  }
  /// The least distance, finely sampled.
  double Least() {
    double least = 10.0;
    for (int i = 0; i <= 4000; ++i) {
      const double s = i / 4000.0;
      clearance.MoveTo(Eigen::Vector2d(s * s * (3.0 - 2.0 * s) - 0.5, 0.0));
      least = std::min(least, clearance.Nearest().distance);
    }
    return least;
  }
  robot::Clearance clearance;
  BandCurve curve;

 private:
  static std::vector<double> Times() {
    std::vector<double> times;
    for (int i = 0; i <= 8; ++i) times.push_back(0.05 * i);
    return times;
  }
};

TEST(BandCertificateTest, SeesAPlateThatEveryPointOfTheGridSteppedOver) {
  // 1 mm thick, and passed within 2 ms.
  Swing swing({test::BoxAt({0.4, 0.001, 0.4}, {0.7, 0.05, 0.0})});
  const double until = swing.Until(0.002);
  EXPECT_GT(until, 0.1);
  EXPECT_LT(until, 0.2);
  EXPECT_EQ(swing.Until(0.002, 0.3), BandCheck::kNever) << "it is past the plate then";
}

TEST(BandCertificateTest, HoldsTheDistanceFromBothSides) {
  // Before the stretched arm: nearest half-way.
  Swing swing({test::BoxAt({0.1, 0.1, 0.4}, {1.1, 0.0, 0.0})});
  const double least = swing.Least();
  ASSERT_GT(least, 0.01);
  EXPECT_EQ(swing.Until(least - 1e-3), BandCheck::kNever);
  EXPECT_LE(swing.Until(least + 1e-3), 0.4);
}

TEST(BandCertificateTest, AsksOfAPairForHalfOfWhatItsEndLeaves) {
  // The swing ends before a box that it comes nearer to up to its end.
  Swing swing({test::BoxAt({0.1, 0.1, 0.4}, {0.6, 0.6, 0.0})});
  swing.clearance.MoveTo(Eigen::Vector2d(0.5, 0.0));
  const double left = swing.clearance.Nearest().distance;
  ASSERT_NEAR(left, swing.Least(), 1e-4);
  EXPECT_EQ(swing.Until(1.5 * left), BandCheck::kNever);
}

TEST(BandCertificateTest, ProvesAllOfAMotionThatIsFarFromEverything) {
  Swing swing({test::BoxAt({0.1, 0.1, 0.4}, {0.0, 9.0, 0.0})});
  EXPECT_EQ(swing.Until(0.002), BandCheck::kNever);
}

}  // namespace band_certificate_test
}  // namespace oca::planning
