// SPDX-License-Identifier: BSD-3-Clause
// certified_min_distance: a distance that holds between the samples too.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "oca/models/robot/motion_tally.h"
#include "oca/models/robot/urdf.h"

namespace oca::robot {
namespace motion_tally_certificate_test {

using Eigen::Vector2d;

constexpr double kReach = 1.0;  // m
constexpr double kStep = 0.1;   // s

/// The tally of the planar arm, fed by hand every 0.1 s.
class PlanarCertificateTest : public ::testing::Test {
 protected:
  PlanarCertificateTest()
      : model_(std::make_shared<const RobotModel>(
            LoadUrdf(OCA_SOURCE_DIR "/models/robots/planar2/planar2.urdf"))),
        travel_(*model_) {
    near_.max_distance = kReach;
    near_.compared = true;
  }
  Proximity& Near(const std::string& link, double distance) {
    Proximity& proximity = near_.proximities.emplace_back();
    proximity.link = models::Name(link);
    proximity.obstacle = models::Name("box");
    proximity.distance = distance;
    return proximity;
  }
  void Add(const Eigen::VectorXd& q) { tally_.Add(Sample(q)); }
  MotionSample Sample(const Eigen::VectorXd& q) {
    q_ = q;
    MotionSample sample{.time = kStep * tally_.samples(),
                        .position = MotionSample::Positions(q_.data(), q_.size()),
                        .request = {},
                        .goal = {},
                        .delta = {},
                        .proximities = &near_};
    sample.model = model_.get();
    sample.travel = &travel_;
    return sample;
  }
  std::optional<double> Certified() { return tally_.At(Sample(q_)).certified_min_distance; }

  std::shared_ptr<const RobotModel> model_;
  TravelBound travel_;
  ProximitySet near_;
  MotionTally tally_;
  Eigen::VectorXd q_;
};

TEST_F(PlanarCertificateTest, OfAnArmAtRestIsTheLeastDistance) {
  Near("planar2_link_2", 0.3);
  Add(Vector2d::Zero());
  Add(Vector2d::Zero());
  EXPECT_DOUBLE_EQ(Certified().value(), 0.3);
}

TEST_F(PlanarCertificateTest, TakesHalfOfWhatTheLinkTravelled) {
  // 0.1 rad about the elbow, whose fore link ends 0.45 m from it, in 0.1 s.
  Near("planar2_link_2", 0.3);
  Add(Vector2d::Zero());
  Add(Vector2d(0.0, 0.1));
  EXPECT_NEAR(Certified().value(), 0.3 - 0.045 / 2.0, 1e-12);
}

TEST_F(PlanarCertificateTest, TakesTheFasterEndOfTheObstacle) {
  Near("planar2_link_1", 0.3).obstacle_speed = 0.2;
  Add(Vector2d::Zero());
  near_.proximities[0].obstacle_speed = 0.4;
  Add(Vector2d::Zero());
  EXPECT_NEAR(Certified().value(), 0.3 - 0.5 * 0.4 * kStep, 1e-12);
}

// A pair whose distance could not be computed must not vanish behind the next number.
TEST_F(PlanarCertificateTest, ADistanceThatIsNoneIsNotForgotten) {
  Near("planar2_link_2", 0.3);
  Add(Vector2d::Zero());
  EXPECT_TRUE(tally_.finite());
  near_.proximities[0].distance = std::nan("");
  Add(Vector2d::Zero());
  near_.proximities[0].distance = 0.2;
  Add(Vector2d::Zero());
  EXPECT_FALSE(tally_.finite());
}

TEST_F(PlanarCertificateTest, SaysNothingIfNothingWasThereToCompare) {
  near_.compared = false;
  Add(Vector2d::Zero());
  EXPECT_FALSE(Certified().has_value());
  near_.compared = true;
  Add(Vector2d::Zero());
  EXPECT_DOUBLE_EQ(Certified().value(), kReach);
}

TEST_F(PlanarCertificateTest, CountsWhatIsNotListedAtItsReach) {
  Add(Vector2d::Zero());
  EXPECT_DOUBLE_EQ(Certified().value(), kReach);
  near_.fastest = 4.0;  // somewhere out there
  Add(Vector2d::Zero());
  EXPECT_NEAR(Certified().value(), kReach - 0.5 * 4.0 * kStep, 1e-12);
}

TEST_F(PlanarCertificateTest, FollowsPairsThatComeAndGo) {
  Add(Vector2d::Zero());
  Near("planar2_link_2", 0.5).obstacle_speed = 8.0;  // 0.8 m a step, from beyond 1 m
  near_.fastest = 8.0;
  Add(Vector2d::Zero());
  EXPECT_NEAR(Certified().value(), 0.5 * (1.0 + 0.5 - 0.8), 1e-12);
  near_.proximities.clear();
  near_.fastest = 0.0;
  near_.proximities.shrink_to_fit();
  Add(Vector2d::Zero());
  EXPECT_NEAR(Certified().value(), 0.5 * (1.0 + 0.5 - 0.8), 1e-12);
}

TEST_F(PlanarCertificateTest, OfAPairOfTheArmTheJointsBetweenThemCount) {
  Near("planar2_link_2", 0.3).own_link = models::Name("planar2_link_1");
  Add(Vector2d::Zero());
  Add(Vector2d(0.1, 0.0));
  EXPECT_NEAR(Certified().value(), 0.3, 1e-12) << "joint 1 carries both";
  Add(Vector2d(0.1, 0.1));  // the fore link ends 0.45 m from the elbow
  EXPECT_NEAR(Certified().value(), 0.3 - 0.5 * 0.1 * 0.45, 1e-12);
}

TEST_F(PlanarCertificateTest, HasNoValueOnceSomethingWasUnknown) {
  Near("planar2_link_2", 0.3);
  Add(Vector2d::Zero());
  near_.max_distance = 0.0;
  Add(Vector2d::Zero());
  near_.max_distance = kReach;
  Add(Vector2d::Zero());
  EXPECT_FALSE(Certified().has_value());
}

}  // namespace motion_tally_certificate_test
}  // namespace oca::robot
