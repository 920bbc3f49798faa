// SPDX-License-Identifier: BSD-3-Clause
// certified_min_distance: a distance that holds between the samples too.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/kinematics.h"
#include "oca/systems/judging/motion_metrics.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/sensing/model_links.h"
#include "tests/systems/system_bench.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace motion_certificate_test {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kReach = 1.0;  // m
constexpr double kStep = 0.1;   // s

/// The tally of the planar arm, fed by hand every 0.1 s.
class PlanarCertificateTest : public ::testing::Test {
 protected:
  PlanarCertificateTest() : model_(LoadTestModel("planar2")), travel_(*model_) {
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
                        .position = VectorView(q_.data(), q_.size()),
                        .request = {},
                        .goal = {},
                        .delta = {},
                        .proximities = &near_};
    sample.model = model_.get();
    sample.travel = &travel_;
    return sample;
  }
  std::optional<double> Certified() { return tally_.At(Sample(q_)).certified_min_distance; }

  std::shared_ptr<const robot::RobotModel> model_;
  robot::TravelBound travel_;
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
  EXPECT_TRUE(Signal<MotionTally>::Check(tally_, Look::kFinite).ok());
  near_.proximities[0].distance = std::nan("");
  Add(Vector2d::Zero());
  near_.proximities[0].distance = 0.2;
  Add(Vector2d::Zero());
  EXPECT_FALSE(Signal<MotionTally>::Check(tally_, Look::kFinite).ok());
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

TEST_F(PlanarCertificateTest, AddsTheTravelOfBothLinksOfAPairOfTheArm) {
  Near("planar2_link_2", 0.3).own_link = models::Name("planar2_link_1");
  Add(Vector2d::Zero());
  Add(Vector2d(0.1, 0.0));  // ends 0.95 m and 0.55 m from the shoulder
  EXPECT_NEAR(Certified().value(), 0.3 - 0.5 * 0.1 * (0.95 + 0.55), 1e-12);
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

// Samples 0.1 s apart miss how near the arm came; the certificate, from the samples alone, does
// not. The judge looks every 2 ms.
TEST(MotionCertificateTest, IsBelowEveryDistanceBetweenTheSamplesOfAFastArm) {
  const auto model = LoadTestModel("lwr4");
  const robot::TravelBound travel(*model);
  SystemBench<BulletDistance> bench(BulletDistance::Params{.max_distance = kReach},
                                    TestModels("lwr4"));
  LinkPoses links;
  NameLinks(*model, links);
  ShapeParams ball;
  ball.radius = 0.1;
  ObstacleSet set;
  set.obstacles.emplace_back();
  set.obstacles[0].body = MakeObstacleBody("ball", ball, "ball");
  int missed = 0;
  for (int place = 0; place < 60; ++place) {
    set.obstacles[0].X_WO.translation() =
        Vector3d(0.7 * std::cos(place), 0.7 * std::sin(place), 0.3 + 0.01 * place);
    Eigen::VectorXd q(7);
    const auto look = [&](int millisecond) -> const ProximitySet& {
      for (int j = 0; j < 7; ++j) {
        q[j] = 1.2 * std::sin(j + place) + 0.002 * std::cos(3 * j + place) * millisecond;
      }
      robot::ForwardKinematics(*model, q, links.poses);
      bench->links.Fix(bench.context(), links);
      bench->obstacles.Fix(bench.context(), set);
      return bench->proximities.Eval(bench.context());
    };
    MotionTally tally;
    double between = std::numeric_limits<double>::infinity();
    MotionMetricsValue value;
    for (int ms = 0; ms <= 500; ms += 2) {
      const ProximitySet& near = look(ms);
      for (const Proximity& p : near.proximities) between = std::min(between, p.distance);
      if (ms % 100 != 0) continue;
      MotionSample sample{0.001 * ms, VectorView(q.data(), 7), {}, {}, {}, &near};
      sample.model = model.get();
      sample.travel = &travel;
      tally.Add(sample);
      value = tally.At(sample);
    }
    ASSERT_TRUE(value.certified_min_distance.has_value());
    ASSERT_LE(*value.certified_min_distance, between) << "place " << place;
    EXPECT_GT(*value.certified_min_distance, between - 0.35) << "place " << place;
    if (value.min_distance && between < *value.min_distance - 1e-6) ++missed;
  }
  EXPECT_GT(missed, 20);
}

TEST(MotionCertificateTest, RefusesARobotThatIsNotThere) {
  const MotionMetrics::Params params{.period = Period(1, 10), .model = "nobody"};
  EXPECT_THROW(MotionMetrics(params, TestModels("planar2")), ConfigError);
}

}  // namespace motion_certificate_test
}  // namespace oca::systems
