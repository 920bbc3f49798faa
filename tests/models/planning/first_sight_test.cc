// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/first_sight.h"

#include <gtest/gtest.h>

#include <vector>

#include "oca/models/geometry/shape.h"
#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace first_sight_test {

constexpr double kSeen = 1.0;  // s; until then the box is far away

/// An arm that rests, stretched along x, and a box that stands 0.09 m deep in its end `after` it
/// was first seen to move.
FirstSight Look(double after) {
  const auto model = test::Arm("planar2");
  const robot::PlacedBody box = test::BoxAt({0.2, 0.2, 0.2}, {0.95, 0.0, 0.0});
  const auto pose = [&](double time) {
    Eigen::Isometry3d X = box.X_WO;
    if (time < kSeen + 0.005)
      X.translation().y() = 5.0;
    else if (time < kSeen + after)
      X.translation().y() = 4.0;
    return X;
  };
  const std::vector<BandBody> bodies{{models::Name("box"), box.collider, pose, false}};
  ClairvoyantTask task;
  task.request = [](double, int, Eigen::Ref<Eigen::VectorXd> out) { out.setZero(); };
  task.duration = 4.0;
  task.bodies = bodies;
  return LookAtFirstSight(model, task);
}

TEST(FirstSightTest, IsTooLateForWhatIsThereAtOnceAndNotForWhatTakesItsTime) {
  const FirstSight at_once = Look(0.02);
  EXPECT_NEAR(at_once.time.value(), kSeen, 0.011);
  EXPECT_TRUE(at_once.too_late);
  EXPECT_EQ(at_once.body, models::Name("box"));
  EXPECT_GT(at_once.depth, at_once.reach);
  EXPECT_FALSE(Look(1.0).too_late);
  // The later it comes the less is proven: there is one time up to which it is too late.
  bool before = true;
  for (double after = 0.02; after < 1.0; after += 0.02) {
    const bool now = Look(after).too_late;
    EXPECT_TRUE(before || !now) << after;
    before = now;
  }
}

TEST(FirstSightTest, NothingIsSeenWhereNothingMoves) {
  const auto model = test::Arm("planar2");
  const robot::PlacedBody box = test::BoxAt({0.2, 0.2, 0.2}, {0.95, 0.0, 0.0});
  const std::vector<BandBody> bodies{
      {models::Name("box"), box.collider, [&](double) { return box.X_WO; }, true}};
  ClairvoyantTask task;
  task.request = [](double, int, Eigen::Ref<Eigen::VectorXd> out) { out.setZero(); };
  task.duration = 1.0;
  task.bodies = bodies;
  EXPECT_FALSE(LookAtFirstSight(model, task).time.has_value());
  EXPECT_FALSE(LookAtFirstSight(model, task).too_late);
}

}  // namespace first_sight_test
}  // namespace oca::planning
