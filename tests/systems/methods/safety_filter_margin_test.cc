// SPDX-License-Identifier: BSD-3-Clause
// That a SafetyFilter keeps its margin: arms that cross rooms of balls.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "oca/systems/sensing/link_colliders.h"
#include "tests/systems/methods/filter_bench.h"

namespace oca::systems {
namespace safety_filter_margin_test {

using filter_bench::Hundred;
using filter_bench::kDt;
using filter_bench::Loop;

/// Balls that drift in straight lines, and their exact distances to the links of an arm.
class Balls {
 public:
  Balls(const robot::RobotModel& model, int count, double speed, std::mt19937& random)
      : model_(model), links_(MakeLinkColliders(model)) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    while (std::ssize(balls_) < count) {
      const Eigen::Vector3d p(unit(random), unit(random), 0.5 + 0.6 * unit(random));
      if (p.norm() < 0.45 || p.head<2>().norm() < 0.3) continue;
      balls_.push_back({p, speed * Eigen::Vector3d(unit(random), unit(random), unit(random))});
    }
  }
  ProximitySet operator()(const LinkPoses& poses) const {
    ProximitySet set;
    for (const LinkCollider& link : links_) {
      if (model_.body(link.number) < 0) continue;
      for (std::size_t b = 0; b < balls_.size(); ++b) {
        const auto found =
            DistanceToBody(link, poses.poses[link.number], ball_,
                           Eigen::Isometry3d(Eigen::Translation3d(balls_[b].position)), 10.0);
        set.proximities.push_back({link.link,
                                   names_[b],
                                   found.distance,
                                   found.point_a,
                                   found.point_b,
                                   found.normal,
                                   balls_[b].velocity,
                                   {}});
      }
    }
    return set;
  }
  double Nearest(const Eigen::VectorXd& q) const {
    LinkPoses poses;
    NameLinks(model_, poses);
    robot::ForwardKinematics(model_, q, poses.poses);
    double nearest = 10.0;
    for (const Proximity& p : (*this)(poses).proximities) nearest = std::min(nearest, p.distance);
    return nearest;
  }
  void Drift(double time) {
    for (Ball& ball : balls_) ball.position += time * ball.velocity;
  }

 private:
  struct Ball {
    Eigen::Vector3d position;
    Eigen::Vector3d velocity;
  };
  const robot::RobotModel& model_;
  const std::vector<LinkCollider> links_;
  const geometry::Collider ball_{geometry::Shape(geometry::Sphere{0.08}), "ball"};
  const std::vector<models::Name> names_{models::Name("a"), models::Name("b"), models::Name("c"),
                                         models::Name("d")};
  std::vector<Ball> balls_;
};

struct Campaign {
  int ticks{0};         ///< that the bound speaks of: up to the first slack
  int endangered{0};    ///< runs whose request comes below safe_distance
  double lowest{1.0};   ///< least of h over bound; the bound holds above -1
  double nearest{1.0};  ///< least h, m
  double margin{0.0};   ///< largest, m
};

/// Arms that cross a room of balls from one random configuration to the next; between the ticks
/// they are looked at too.
Campaign Cross(SafetyFilter::Form form, double speed, int runs) {
  Campaign campaign;
  std::mt19937 random(41);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const ModelSet models = TestModels("lwr4");
  const auto model = models.Get("");
  for (int run = 0; run < runs; ++run) {
    SafetyFilter::Params params = Hundred();
    params.form = form;
    params.position_gain = 2.0;
    Balls balls(*model, 4, speed, random);
    const auto configuration = [&] {
      Eigen::VectorXd q(7);
      for (int j = 0; j < 7; ++j) q[j] = 1.2 * unit(random);
      return q;
    };
    const Eigen::VectorXd start = configuration();
    const Eigen::VectorXd goal = configuration();
    if (balls.Nearest(start) < params.safe_distance) continue;
    Loop loop(params, models, start);
    double margin = 0.0;
    double least = 1.0;
    bool endangered = false;
    for (int k = 0; k < 200; ++k) {
      const Eigen::VectorXd request = start + std::min(k / 150.0, 1.0) * (goal - start);
      const Eigen::VectorXd before = loop.q();
      const FilterActivity& activity = loop.Tick(request, balls);
      margin = std::max(margin, activity.margin);
      if (activity.slack > 1e-9) break;
      bool recovers = true;
      for (int b = 0; b < activity.num_bounds; ++b) recovers &= activity.bounds[b].slack <= 1e-9;
      if (!recovers) break;
      ++campaign.ticks;
      endangered |= balls.Nearest(request) < params.safe_distance;
      for (int part = 1; part <= 4; ++part) {
        balls.Drift(kDt / 4);
        const double h = balls.Nearest(before + 0.25 * part * (loop.q() - before)) - 0.05;
        least = std::min(least, h);
        if (h < 0.0) campaign.lowest = std::min(campaign.lowest, h / std::max(margin, 1e-9));
      }
    }
    campaign.endangered += endangered ? 1 : 0;
    campaign.nearest = std::min(campaign.nearest, least);
    campaign.margin = std::max(campaign.margin, margin);
  }
  return campaign;
}

void ExpectTheBound(SafetyFilter::Form form, double speed) {
  const Campaign campaign = Cross(form, speed, 180);
  EXPECT_GT(campaign.ticks, 5000);
  EXPECT_GT(campaign.endangered, 10);
  EXPECT_GT(campaign.lowest, -1.0);
  EXPECT_LT(campaign.nearest, 0.005);  // it goes as near as it may
  testing::Test::RecordProperty("nearest_h_mm", std::to_string(1e3 * campaign.nearest));
  testing::Test::RecordProperty("margin_mm", std::to_string(1e3 * campaign.margin));
  testing::Test::RecordProperty("share_of_margin", std::to_string(-campaign.lowest));
}

TEST(SafetyFilterMarginTest, KeepsItsMarginAmongBallsAtRest) {
  ExpectTheBound(SafetyFilter::Form::kLinear, 0.0);
}

TEST(SafetyFilterMarginTest, KeepsItsMarginAmongBallsThatMove) {
  ExpectTheBound(SafetyFilter::Form::kLinear, 0.3);
}

TEST(SafetyFilterMarginTest, KeepsItsMarginInTheBrakingFormToo) {
  ExpectTheBound(SafetyFilter::Form::kBraking, 0.3);
}

}  // namespace safety_filter_margin_test
}  // namespace oca::systems
