// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/planning/band_replanner.h"

#include <gtest/gtest.h>

#include "tests/models/planning/scene.h"

namespace oca::planning {
namespace band_replanner_test {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Joint 1 of planar3 turns by 1 rad in 2 s; a box stands far away.
class BandReplannerTest : public testing::Test {
 protected:
  BandReplannerTest() {
    auto body = std::make_shared<geometry::ObstacleBody>();
    body->id = models::Name("box");
    body->collider = geometry::MakeCollider(geometry::Box{Vector3d(0.1, 0.1, 0.1)}, "box");
    obstacles_.resize(1);
    obstacles_[0].body = body;
    obstacles_[0].X_WO.translation() = Vector3d(5.0, 0.0, 0.0);
  }
  BandSituation At(double time, const VectorXd& measured) const {
    return {time, request_, obstacles_, measured};
  }
  VectorXd Requested(double time) const { return request_->Evaluate(time, 0); }
  double ClearFor(double time, const VectorXd& measured, const VectorXd& planned) const {
    robot::ClearMotion motion;
    replanner_.TellClear(At(time, measured), planned, memory_, motion);
    return motion.clear_for;
  }

  const std::shared_ptr<const motion::Trajectory> request_ =
      std::make_shared<const motion::Trajectory>(
          motion::Trajectory::CubicHermite({{.time = 0.0, .position = Vector3d(0, 0, 0)},
                                            {.time = 2.0, .position = Vector3d(1, 0, 0)}}));
  std::vector<geometry::Obstacle> obstacles_;
  // What is planned costs nothing here, however long it is looked for.
  const BandReplanner replanner_{test::Arm("planar3"),
                                 {.planner = {.prices = {1e-9, 1e-9, 1e-9, 1e-9}}}};
  BandMemory memory_;
};

TEST_F(BandReplannerTest, IsStuckOnceTheRequestRestsAndNothingMovedForStuckTime) {
  const VectorXd here = Vector3d(0.5, 0, 0);
  for (const double time : {0.0, 1.0, 1.99, 2.0, 3.98}) {
    replanner_.Follow(At(time, here), memory_);
    EXPECT_FALSE(memory_.report.stuck) << time;
  }
  replanner_.Follow(At(4.0, here), memory_);
  EXPECT_TRUE(memory_.report.stuck) << "2 s after it was last seen to get on, at 1.99 s";
  replanner_.Follow(At(4.0, here + VectorXd(Vector3d(0.009, 0, 0))), memory_);
  EXPECT_TRUE(memory_.report.stuck);
  replanner_.Follow(At(4.0, here + VectorXd(Vector3d(0.011, 0, 0))), memory_);
  EXPECT_FALSE(memory_.report.stuck);
  for (const double goal : {0.991, 0.989}) {
    replanner_.Follow(At(9.0, Vector3d(goal, 0, 0)), memory_);
    replanner_.Follow(At(20.0, Vector3d(goal, 0, 0)), memory_);
    EXPECT_EQ(memory_.report.stuck, goal < 0.99) << "it has arrived";
    memory_ = {};
  }
}

TEST_F(BandReplannerTest, KeepsAPlanWhileWhatStandsStaysWhereItStood) {
  replanner_.Plan(At(0.0, Requested(0.0)), 0.02, std::nullopt, memory_);
  EXPECT_EQ(memory_.report.plans, 1u);
  EXPECT_EQ(memory_.report.change, 0.02);
  EXPECT_EQ(memory_.report.start, BandStart::kRequest);
  replanner_.Plan(At(0.02, Requested(0.02)), 0.04, std::nullopt, memory_);
  EXPECT_EQ(memory_.report.plans, 1u);
  obstacles_[0].X_WO.translation().x() += 1e-3;
  replanner_.Plan(At(0.04, Requested(0.04)), 0.06, std::nullopt, memory_);
  EXPECT_EQ(memory_.report.plans, 2u);
}

TEST_F(BandReplannerTest, LooksAgainBeforeASlowRequestLeavesItsHorizon) {
  // The box is in the way at half the time, 50 s later than the first plans look ahead.
  obstacles_[0].X_WO.translation() = Vector3d(0.7, 0.4, 0.0);
  const double end = 160.0;
  const auto slow = std::make_shared<const motion::Trajectory>(
      motion::Trajectory::CubicHermite({{.time = 0.0, .position = Vector3d(0, 0, 0)},
                                        {.time = end, .position = Vector3d(1, 0, 0)}}));
  robot::Clearance clearance(test::Arm("planar3"), false,
                             {{obstacles_[0].body->collider, obstacles_[0].X_WO}});
  double least = robot::kUnlimited, least_requested = robot::kUnlimited;
  for (double time = 0.0; time <= end; time += 1.0) {
    VectorXd q = slow->Evaluate(time, 0);
    clearance.MoveTo(q);
    least_requested = std::min(least_requested, clearance.Nearest(1.0).distance);
    if (!memory_.At(time).empty()) memory_.At(time).Add(time, 0, q);
    clearance.MoveTo(q);
    least = std::min(least, clearance.Nearest(1.0).distance);
    const BandSituation now{time, slow, obstacles_, q};
    replanner_.Plan(now, time + 0.02, std::nullopt, memory_);
    if (memory_.next.end() < end) {
      EXPECT_LE(memory_.next_until.all, memory_.next.end()) << time;
    }
  }
  EXPECT_LT(least_requested, 0.0);
  EXPECT_GT(least, 0.04);
  EXPECT_LT(memory_.report.plans, 80u) << "it is not made anew all the time";
}

TEST_F(BandReplannerTest, LeavesOutPairsThatWhoeverMeasuresLeavesOut) {
  obstacles_[0].X_WO.translation() = Vector3d(0.7, 0.4, 0.0);  // in the way
  const VectorXd here = Requested(0.0);
  replanner_.Plan(At(0.0, here), 0.02, std::nullopt, memory_);
  EXPECT_NE(memory_.report.start, BandStart::kRequest);
  memory_ = {};
  std::vector<std::pair<models::Name, models::Name>> all;
  const auto arm = test::Arm("planar3");
  for (const robot::Link& link : arm->links()) {
    all.emplace_back(link.name, models::Name("box"));
  }
  BandSituation now = At(0.0, here);
  now.ignored = &all;
  replanner_.Plan(now, 0.02, std::nullopt, memory_);
  EXPECT_EQ(memory_.report.start, BandStart::kRequest);
  EXPECT_TRUE(memory_.report.link.empty());
}

TEST_F(BandReplannerTest, ThrowsAwayAPlanThatIsLateAndGivesTheNextOneTheTimeItTakes) {
  obstacles_[0].X_WO.translation() = Vector3d(0.7, 0.4, 0.0);  // in the way
  const auto replanner = [](double price) {
    return BandReplanner(test::Arm("planar3"), {.planner = {.most_evaluations = 500,
                                                            .prices = {price, 1e-9, 1e-9, 1e-9}}});
  };
  const VectorXd here = Requested(0.0);
  const BandReplanner timely = replanner(0.019);
  timely.Plan(At(0.0, here), timely.TimeToPlan(memory_), std::nullopt, memory_);
  EXPECT_EQ(memory_.report.plans, 1u);
  EXPECT_EQ(memory_.report.overruns, 0u);
  EXPECT_NEAR(memory_.report.charged, 0.019, 1e-4);

  memory_ = {};
  const BandReplanner late = replanner(0.05);
  EXPECT_EQ(late.TimeToPlan(memory_), 0.02);
  late.Plan(At(0.0, here), 0.02, std::nullopt, memory_);
  EXPECT_EQ(memory_.report.plans, 0u);
  EXPECT_TRUE(memory_.next.empty());
  EXPECT_EQ(memory_.report.overruns, 1u);
  EXPECT_NEAR(memory_.report.charged, 0.05, 1e-4);
  late.Plan(At(0.04, here), 0.5, std::nullopt, memory_);
  EXPECT_EQ(memory_.report.plans, 0u) << "it would still be made";
  EXPECT_NEAR(late.TimeToPlan(memory_), 1.25 * 0.05, 1e-4);
  const double begin = 0.06 + late.TimeToPlan(memory_);
  late.Plan(At(0.06, here), 0.06 + late.TimeToPlan(memory_), std::nullopt, memory_);
  EXPECT_EQ(memory_.report.plans, 1u);
  EXPECT_EQ(memory_.report.overruns, 1u);
  EXPECT_EQ(memory_.report.change, begin);
  EXPECT_EQ(late.TimeToPlan(memory_), 0.02);
}

TEST_F(BandReplannerTest, StartsFromAnArmThatIsFartherThanRestartDistance) {
  const VectorXd rate = Vector3d(0.5, 0, 0);
  for (const double off : {0.099, 0.101}) {
    memory_ = {};
    const VectorXd measured = Requested(1.0) + VectorXd(Vector3d(0, off, 0));
    replanner_.Plan(At(1.0, measured), 1.02, BandSituation::Positions(rate), memory_);
    VectorXd start = Requested(1.02);
    memory_.next.Add(1.02, 0, start);
    const VectorXd expected = off < 0.1 ? Requested(1.02) : VectorXd(measured + 0.02 * rate);
    EXPECT_LT((start - expected).norm(), 1e-12) << off;
  }
}

TEST_F(BandReplannerTest, IsClearFromTheStartOfItsPlanOnWhileTheArmFollows) {
  const VectorXd planned = Requested(0.0);
  EXPECT_EQ(ClearFor(0.0, planned, planned), 0.0) << "without a plan";
  replanner_.Plan(At(0.0, planned), 0.02, std::nullopt, memory_);
  EXPECT_EQ(ClearFor(0.019, planned, planned), 0.0);
  EXPECT_EQ(ClearFor(0.02, planned, planned), 30.0);
  EXPECT_EQ(ClearFor(0.02, planned + VectorXd(Vector3d(0, 0.0049, 0)), planned), 30.0);
  EXPECT_EQ(ClearFor(0.02, planned + VectorXd(Vector3d(0, 0.0051, 0)), planned), 0.0);
  obstacles_[0].linear = Vector3d(0.05, 0, 0);  // 15 mm in 0.3 s
  EXPECT_EQ(ClearFor(0.02, planned, planned), 0.0);
}

}  // namespace band_replanner_test
}  // namespace oca::planning
