// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/own_ranges.h"

#include <gtest/gtest.h>

#include "oca/models/error.h"
#include "oca/models/robot/clearance.h"

namespace oca::robot {
namespace own_ranges_test {

/// A mast with a ball and, behind two slides along x, another ball: 1 + x + y - 0.2 apart. The
/// carriage between has a ball far above.
std::shared_ptr<const RobotModel> Slides() {
  std::vector<Link> links(3);
  const char* names[] = {"mast", "carriage", "tip"};
  const Eigen::Vector3d at[] = {{0, 0, 0}, {0, 0, 5}, {1, 0, 0}};
  for (int i = 0; i < 3; ++i) {
    links[i].name = models::Name(names[i]);
    CollisionElement ball;
    ball.X_LC.translation() = at[i];
    ball.shape = geometry::Sphere{0.1};
    ball.source = names[i];
    links[i].collisions.push_back(ball);
  }
  std::vector<Joint> joints(2);
  for (int j = 0; j < 2; ++j) {
    joints[j].name = models::Name(j == 0 ? "x" : "y");
    joints[j].type = JointType::kPrismatic;
    joints[j].axis = Eigen::Vector3d::UnitX();
    joints[j].parent_link = j;
    joints[j].child_link = j + 1;
    joints[j].lower_limit = -5.0;
    joints[j].upper_limit = 5.0;
  }
  return std::make_shared<const RobotModel>(models::Name("slides"), std::move(links),
                                            std::move(joints));
}

/// What is asked of mast and tip on a straight way of x with y = 0.
double Asked(std::vector<double> x, double self_distance) {
  std::vector<motion::KeyPoint> points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    points.push_back({.time = 1.0 + static_cast<double>(i), .position = Eigen::Vector2d(x[i], 0)});
  }
  const auto request = motion::Trajectory::Linear(points);
  const OwnRanges ranges = OwnRangesAlong(Slides(), &request, self_distance);
  EXPECT_EQ(ranges.of(0, 2), ranges.of(2, 0));
  return ranges.of(0, 2);
}

TEST(OwnRangesTest, AskForSelfDistanceWhereTheRequestLeavesIt) {
  EXPECT_EQ(Asked({0.0, 1.0}, 0.01), 0.01);
  EXPECT_EQ(Asked({0.0}, 0.2), 0.2) << "0.8 m apart";
  EXPECT_EQ(OwnRangesAlong(Slides(), nullptr, 0.05).of(0, 2), 0.05);
}

TEST(OwnRangesTest, AskForAThirdOfTheLeastThatTheRequestLeaves) {
  EXPECT_NEAR(Asked({0.0}, 1.0), 0.8 / 3.0, 1e-9);
  EXPECT_NEAR(Asked({0.0, -0.797}, 0.01), 0.001, 1e-9) << "3 mm at its end";
  EXPECT_NEAR(Asked({0.0, -0.797, 0.5}, 0.01), 0.001, 1e-9) << "and on the way";
  // 30.3 mm leave a little more than 0.01.
  EXPECT_EQ(Asked({0.0, -0.7697}, 0.01), 0.01);
  EXPECT_LT(Asked({0.0, -0.7703}, 0.01), 0.01);
}

TEST(OwnRangesTest, OfARequestThroughContactTheEndsCount) {
  EXPECT_NEAR(Asked({0.0, -0.9, -0.7}, 0.2), 0.1 / 3.0, 1e-9) << "0.1 m apart at the end";
  EXPECT_EQ(Asked({0.0, -0.9, -0.7}, 0.01), 0.01);
}

TEST(OwnRangesTest, OfARequestThatBeginsOrEndsInContactNothingLessIsAsked) {
  EXPECT_EQ(Asked({0.0, -0.9}, 0.01), 0.01);
  EXPECT_EQ(Asked({-0.9}, 0.01), 0.01);
  EXPECT_EQ(Asked({-0.7998}, 0.01), 0.01) << "0.2 mm are a contact";
  EXPECT_LT(Asked({-0.7996}, 0.01), 0.01) << "0.4 mm are not";
}

TEST(OwnRangesTest, AreNoneIfOwnLinksAreToBeAsObstacles) {
  const OwnRanges ranges = OwnRangesAlong(Slides(), nullptr, 0.0);
  EXPECT_TRUE(ranges.empty());
  EXPECT_EQ(ranges.of(0, 2), kUnlimited);
}

TEST(OwnRangesTest, RefuseARequestOfAnotherRobot) {
  const auto request = motion::Trajectory::Linear({{.position = Eigen::Vector3d::Zero()}});
  EXPECT_THROW(OwnRangesAlong(Slides(), &request, 0.01), models::ModelError);
}

// A long request of many key points: nothing between them is missed for good.
TEST(OwnRangesTest, LookAlongAllOfALongRequest) {
  std::vector<double> x(5000, 0.5);
  x[3001] = x[3002] = x[3003] = x[3004] = x[3005] = x[3006] = x[3007] = x[3008] = -0.797;
  x[3009] = x[3010] = x[3011] = x[3012] = x[3013] = x[3014] = x[3015] = x[3016] = -0.797;
  EXPECT_NEAR(Asked(x, 0.01), 0.001, 1e-4);
}

// The band asks all pairs for one distance, and each own pair for its range.
TEST(OwnRangesTest, OfAClearanceCountInProportion) {
  const auto model = Slides();
  Clearance clearance(model, true);
  OwnRanges ranges(3, 0.01);
  clearance.KeepOwn(ranges, 0.05);
  const auto move = [&](double distance) {
    clearance.MoveTo(Eigen::Vector2d(distance - 0.8, 0.0));
  };
  move(0.0099);
  EXPECT_TRUE(clearance.NearerThan(0.05));
  move(0.0101);
  EXPECT_FALSE(clearance.NearerThan(0.05));
  const NearPair pair = clearance.Nearest();
  EXPECT_NEAR(pair.distance, 0.0505, 1e-9);
  EXPECT_NEAR(pair.distance / pair.scale, 0.0101, 1e-9);
  Eigen::VectorXd row(2);
  clearance.Gradient(pair, row);
  EXPECT_NEAR(row[0], 5.0, 1e-9) << "five times as fast as it is";
  std::vector<double> own(clearance.own_pairs().size());
  clearance.OwnDistances(1.0, own);
  EXPECT_NEAR(own[0], 0.0101, 1e-9) << "as it is";
  // A range that asks for more than all others are asked for changes nothing.
  clearance.KeepOwn(OwnRanges(3, 0.06), 0.05);
  EXPECT_NEAR(clearance.Nearest().distance, 0.0101, 1e-9);
}

}  // namespace own_ranges_test
}  // namespace oca::robot
