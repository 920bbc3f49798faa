// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/travel_bound.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "oca/models/geometry/distance.h"
#include "oca/models/robot/clearance.h"
#include "oca/models/robot/kinematics.h"
#include "oca/models/robot/urdf.h"

namespace oca::robot {
namespace travel_bound_test {

RobotModel Arm(const std::string& name) {
  return LoadUrdf(OCA_SOURCE_DIR "/models/robots/" + name + "/" + name + ".urdf");
}

std::vector<double> Travel(const RobotModel& model, const Eigen::VectorXd& from,
                           const Eigen::VectorXd& to) {
  std::vector<double> travel(model.links().size());
  TravelBound(model).Calc(LinkPoses(model, from), (to - from).cwiseAbs(), travel);
  return travel;
}

TEST(TravelBoundTest, OfOneHingeIsItsAngleTimesTheFarthestPoint) {
  // The planar arm's upper link is a capsule of radius 0.05 from 0 to 0.5, its ball reaches 0.55.
  const RobotModel arm = Arm("planar2");
  const int upper = arm.FindLink("planar2_link_1");
  EXPECT_NEAR(Travel(arm, Eigen::Vector2d::Zero(), Eigen::Vector2d(0.1, 0.0))[upper], 0.055, 1e-12);
  EXPECT_EQ(Travel(arm, Eigen::Vector2d::Zero(), Eigen::Vector2d(0.0, 0.1))[upper], 0.0);
}

TEST(TravelBoundTest, OfTwoHingesAddsWhatTheOuterOneMovesTheFarthestPoint) {
  // Fore link: 0.45 from joint 2, at most 0.95 from joint 1 and 0.1 x 0.45 farther on the way.
  const RobotModel arm = Arm("planar2");
  const int fore = arm.FindLink("planar2_link_2");
  EXPECT_NEAR(Travel(arm, Eigen::Vector2d::Zero(), Eigen::Vector2d(0.2, 0.1))[fore],
              0.045 + 0.2 * (0.95 + 0.045), 1e-12);
}

TEST(TravelBoundTest, BetweenTwoLinksCountsTheJointsBetweenThem) {
  const RobotModel arm = Arm("planar2");
  const int upper = arm.FindLink("planar2_link_1");
  const int fore = arm.FindLink("planar2_link_2");
  const auto X_WL = LinkPoses(arm, Eigen::VectorXd::Zero(2));
  const TravelBound bound(arm);
  const Eigen::VectorXd path = Eigen::Vector2d(0.2, 0.1);
  EXPECT_NEAR(bound.Between(X_WL, path, fore, upper), 0.045, 1e-12);
  EXPECT_NEAR(bound.Between(X_WL, path, upper, fore), 0.045, 1e-12);
  EXPECT_EQ(bound.Between(X_WL, path, fore, fore), 0.0);
}

TEST(TravelBoundTest, BetweenTwoLinksIsNeverBelowWhatTheirDistanceChanges) {
  const RobotModel arm = Arm("lwr4");
  const TravelBound bound(arm);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> angle(-2.0, 2.0), step(-0.3, 0.3);
  for (int i = 0; i < 200; ++i) {
    Eigen::VectorXd from(7), to(7);
    for (int j = 0; j < 7; ++j) from[j] = angle(random), to[j] = from[j] + step(random);
    const auto before = LinkPoses(arm, from);
    const auto after = LinkPoses(arm, to);
    const Eigen::VectorXd path = (to - from).cwiseAbs();
    for (int a = 1; a < arm.num_links(); ++a) {
      for (int b = a + 1; b < arm.num_links(); ++b) {
        if (arm.links()[a].collisions.empty() || arm.links()[b].collisions.empty()) continue;
        const auto centre = [&](const auto& X, int link) -> Eigen::Vector3d {
          const CollisionElement& element = arm.links()[link].collisions.front();
          const geometry::Collider collider(element.shape, "");
          return X[static_cast<std::size_t>(link)] * (element.X_LC * collider.centre());
        };
        const double change = std::fabs((centre(after, a) - centre(after, b)).norm() -
                                        (centre(before, a) - centre(before, b)).norm());
        EXPECT_LE(change, bound.Between(before, path, a, b) + 1e-12);
      }
    }
  }
}

TEST(TravelBoundTest, IsNeverBelowThePathOfAnyPoint) {
  const RobotModel arm = Arm("lwr4");
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(-2.0, 2.0), step(-0.3, 0.3), unit(-1.0, 1.0);
  double tightest = 10.0;
  for (int i = 0; i < 100; ++i) {
    Eigen::VectorXd from(7), to(7);
    for (int j = 0; j < 7; ++j) from[j] = angle(random), to[j] = from[j] + step(random);
    const auto travel = Travel(arm, from, to);
    for (int link = 0; link < arm.num_links(); ++link) {
      for (const CollisionElement& element : arm.links()[link].collisions) {
        const geometry::Collider collider(element.shape, "");
        const Eigen::Vector3d aim(unit(random), unit(random), unit(random));
        const Eigen::Vector3d p =
            element.X_LC * (collider.Support(aim) + collider.radius() * aim.normalized());
        Eigen::Vector3d last = LinkPoses(arm, from)[link] * p;
        double path = 0.0;
        for (int k = 1; k <= 50; ++k) {
          const Eigen::Vector3d next = LinkPoses(arm, from + k / 50.0 * (to - from))[link] * p;
          path += (next - last).norm();
          last = next;
        }
        ASSERT_LE(path, travel[link] + 1e-12);
        if (path > 0.05) tightest = std::min(tightest, travel[link] / path);
      }
    }
  }
  EXPECT_LT(tightest, 1.5);  // nor is it far above
}

TEST(LeastDistanceBetweenTest, IsExactHeadOnAndNeverAboveTheEnds) {
  EXPECT_DOUBLE_EQ(LeastDistanceBetween(0.5, 0.3, 0.2), 0.3);   // came 0.2 nearer
  EXPECT_DOUBLE_EQ(LeastDistanceBetween(0.3, 0.3, 0.2), 0.2);   // 0.1 to and fro
  EXPECT_DOUBLE_EQ(LeastDistanceBetween(0.1, 0.1, 0.4), -0.1);  // may have touched
  EXPECT_DOUBLE_EQ(LeastDistanceBetween(0.5, 0.3, 0.1), 0.3);   // what moved more than it could
}

TEST(LeastDistanceBetweenTest, HoldsForAnArmThatPassesABall) {
  // Dense sampling between two instants is the judge; the bound must not be above any sample.
  const RobotModel arm = Arm("lwr4");
  const geometry::Collider ball(geometry::Sphere{0.1}, "ball");
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> angle(-1.5, 1.5), step(-0.1, 0.1), place(-0.8, 0.8);
  int dipped = 0;
  for (int i = 0; i < 200; ++i) {
    Eigen::VectorXd from(7), to(7);
    for (int j = 0; j < 7; ++j) from[j] = angle(random), to[j] = from[j] + step(random);
    Eigen::Isometry3d X_WO = Eigen::Isometry3d::Identity();
    X_WO.translation() << place(random), place(random), 0.5 + 0.5 * place(random);
    const auto travel = Travel(arm, from, to);
    for (int link = 1; link < arm.num_links(); ++link) {
      if (arm.links()[link].collisions.empty()) continue;
      const CollisionElement& element = arm.links()[link].collisions[0];
      const geometry::Collider collider(element.shape, "");
      const auto at = [&](double s) {
        const auto X_WL = LinkPoses(arm, from + s * (to - from));
        return geometry::Distance(collider, X_WL[link] * element.X_LC, ball, X_WO).distance;
      };
      const double before = at(0.0), after = at(1.0);
      const double bound = LeastDistanceBetween(before, after, travel[link]);
      for (double s = 0.05; s < 1.0; s += 0.05) {
        const double between = at(s);
        ASSERT_GE(between, bound - 1e-12);
        if (between < std::min(before, after)) ++dipped;
      }
    }
  }
  EXPECT_GT(dipped, 10);  // the samples alone would have missed these
}

}  // namespace travel_bound_test
}  // namespace oca::robot
