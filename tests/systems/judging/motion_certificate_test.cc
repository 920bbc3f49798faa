// SPDX-License-Identifier: BSD-3-Clause
// certified_min_distance with distances as the arm meets them.
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

using Eigen::Vector3d;

constexpr double kReach = 1.0;  // m

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
    robot::MotionTally tally, looking;  // the latter looks every 10 ms too
    double between = std::numeric_limits<double>::infinity();
    MotionMetricsValue value, looked;
    for (int ms = 0; ms <= 500; ms += 2) {
      const ProximitySet& near = look(ms);
      for (const Proximity& p : near.proximities) between = std::min(between, p.distance);
      if (ms % 10 != 0) continue;
      robot::MotionSample sample{0.001 * ms, VectorView(q.data(), 7), {}, {}, {}, &near};
      sample.model = model.get();
      sample.travel = &travel;
      if (ms % 100 != 0) {
        looking.Look(sample);
        continue;
      }
      tally.Add(sample);
      value = tally.At(sample);
      looking.Add(sample);
      looked = looking.At(sample);
    }
    ASSERT_TRUE(value.certified_min_distance.has_value());
    ASSERT_LE(*value.certified_min_distance, between) << "place " << place;
    EXPECT_GT(*value.certified_min_distance, between - 0.35) << "place " << place;
    ASSERT_LE(*looked.certified_min_distance, between) << "place " << place;
    EXPECT_GT(*looked.certified_min_distance, between - 0.035) << "place " << place;
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
