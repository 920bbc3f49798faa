// SPDX-License-Identifier: BSD-3-Clause
// Goals that cannot be had, by the recommended method in whole loops: the arm comes as near to them
// as long searches do, rests there, and says what blocks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

#include "oca/diagrams/foresight/foresight.h"
#include "oca/diagrams/runs/request_check.h"
#include "oca/diagrams/runs/result_json.h"
#include "oca/diagrams/runs/run.h"
#include "oca/models/planning/path_search.h"
#include "tests/diagrams/runs/method_run.h"

namespace oca::runs {
namespace unreachable_goal_test {

using Eigen::VectorXd;
using testing::HasSubstr;
using Overrides = std::vector<files::Override>;

constexpr double kHard = 0.002;  // m; that the files' method keeps

/// The least distance (2-norm of the joints) to the end of the request that ten searches reach,
/// each of 8000 nodes, or 40000 configurations without a gain, among what stands; they keep what
/// the method keeps.
double LeastDistance(const loading::LoadedDiagram& loaded) {
  const foresight::Foresight scene(*loaded.diagram, loaded.models, "arm",
                                   loaded.simulator.duration);
  std::vector<robot::PlacedBody> bodies;
  for (const planning::BandBody& body : scene.bodies()) bodies.push_back(body.At(0.0));
  robot::Clearance clearance(scene.model(), scene.own_links(), bodies);
  const VectorXd wanted = scene.request().goal();
  const robot::RobotModel& model = *scene.model();
  const VectorXd goal = wanted.cwiseMax(model.lower_limits()).cwiseMin(model.upper_limits());
  clearance.MoveTo(goal);
  const bool clear = clearance.Nearest(2.0 * kHard).distance > kHard;
  double least = (wanted - scene.start()).norm();
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    planning::PathSearch search;
    search.Begin(scene.start(), goal, clear,
                 {.margins = {kHard}, .last_nodes = 8000, .patience = 40000}, seed);
    long looks = 0;
    search.Continue(clearance, 1'000'000, looks);
    const bool found = search.state() == planning::PathSearch::State::kFound;
    least = std::min(least, ((found ? goal : search.nearest()) - wanted).norm());
  }
  return least;
}

/// How a run ended.
struct Rest {
  VectorXd q;
  double begins{-1.0};  ///< s; from which on the arm moved by less than 0.005 in 0.5 s; -1: never
  double path_after{0.0};
  double distance{0.0};  ///< from the goal, 2-norm
};

/// Looks for the rest from `from` (s) on.
Rest RestOf(MethodRun& run, double from) {
  constexpr int kHalfSecond = 50;  // ticks
  run.Initialize();
  Rest rest;
  std::vector<double> steps;
  VectorXd last = run.Vector("plant", "position");
  const int ticks = static_cast<int>(std::lround(100.0 * run.loaded().simulator.duration));
  for (int k = 1; k <= ticks; ++k) {
    run.AdvanceTo(0.01 * k);
    rest.q = run.Vector("plant", "position");
    EXPECT_TRUE(rest.q.allFinite());
    steps.push_back((rest.q - last).norm());
    last = rest.q;
    if (rest.begins >= 0.0) {
      rest.path_after += steps.back();
    } else if (0.01 * k >= from && std::ssize(steps) >= kHalfSecond &&
               std::accumulate(steps.end() - kHalfSecond, steps.end(), 0.0) < 0.005) {
      rest.begins = 0.01 * k;
    }
  }
  rest.distance = (rest.q - run.Vector("spline", "goal")).norm();
  return rest;
}

double RequestEnd(const MethodRun& run) {
  return foresight::Foresight(*run.loaded().diagram, run.loaded().models, "arm",
                              run.loaded().simulator.duration)
      .request()
      .times()
      .back();
}

void ExpectRestsAsNearAsSearchesCome(const std::string& file, const Overrides& overrides) {
  SCOPED_TRACE(file +
               (overrides.empty() ? "" : " " + overrides[0].path + "=" + overrides[0].value));
  MethodRun run("scenarios/" + file, "recommended", overrides);
  const double least = LeastDistance(run.loaded());
  const Rest rest = RestOf(run, RequestEnd(run));
  std::printf(
      "%s: rests from %.2f s on, %.4f rad from the goal, the least of searches %.4f, path after "
      "%.2g\n",
      file.c_str(), rest.begins, rest.distance, least, rest.path_after);
  EXPECT_LE(rest.distance, 1.1 * least);
  EXPECT_GE(rest.begins, 0.0);
  EXPECT_LT(rest.path_after, 0.01);
}

TEST(UnreachableGoalTest, AnArmRestsBeforeAWallThatHasNoWayRound) {
  for (const char* wall : {"1.4", "1.0", "2.0"}) {
    ExpectRestsAsNearAsSearchesCome("goal_walled_in", {{"parameters.wall", wall}});
  }
}

TEST(UnreachableGoalTest, AnArmRestsBeforeAGoalInContact) {
  ExpectRestsAsNearAsSearchesCome("goal_in_contact", {});
  ExpectRestsAsNearAsSearchesCome("goal_in_contact", {{"parameters.box_z", "0.2"}});
  ExpectRestsAsNearAsSearchesCome("goal_in_contact", {{"parameters.box_x", "0.55"}});
}

TEST(UnreachableGoalTest, AnArmRestsAtTheLimitsThatItsGoalIsBeyond) {
  ExpectRestsAsNearAsSearchesCome("goal_beyond_limits", {});
  ExpectRestsAsNearAsSearchesCome("goal_beyond_limits", {{"parameters.turn", "175"}});
}

TEST(UnreachableGoalTest, AGoalThatBecomesFreeIsReached) {
  MethodRun run("scenarios/goal_freed", "recommended", {});
  const Rest rest = RestOf(run, 13.0);
  EXPECT_LT(rest.distance, 1e-3);
  EXPECT_LT(rest.path_after, 0.01);
}

TEST(UnreachableGoalTest, WhatComesAndGoesOutOfReachMovesNoArmThatRests) {
  const std::string box = "size: [0.25, 0.25, 0.25]}, pose: {xyz: ";
  MethodRun run(
      "scenarios/goal_in_contact", "recommended",
      {{"systems.obstacles.obstacles",
        "[{id: box, shape: {type: box, " + box + "[0.65, -0.24, 0.3]}}, " +
            "{id: far, shape: {type: box, " + box + "[3, 3, 0]}, appear: 10, disappear: 14}]"}});
  const Rest rest = RestOf(run, 6.5);
  EXPECT_GT(rest.begins, 0.0);
  EXPECT_LT(rest.begins, 9.0);
  EXPECT_LT(rest.path_after, 0.001);
}

/// What a run and its check say.
struct Told {
  nlohmann::json json;
  std::vector<std::string> warnings;
};

Told ToldOf(const std::string& file) {
  const auto loaded = loading::LoadDiagram(OCA_SOURCE_DIR "/diagrams/scenarios/" + file + ".yaml");
  Told told{{}, RequestWarnings(loaded)};
  told.json = nlohmann::json::parse(ResultJson(loaded, runs::Run(loaded, {})));
  return told;
}

TEST(UnreachableGoalTest, RunAndCheckSayWhatBlocksAndByHowMuch) {
  const Told walled = ToldOf("goal_walled_in");
  EXPECT_THAT(walled.warnings, testing::ElementsAre(HasSubstr("no way to the end of the request")));
  ASSERT_EQ(walled.json["blocked"].size(), 1u);
  EXPECT_EQ(walled.json["blocked"][0]["kind"], "way");
  EXPECT_EQ(walled.json["blocked"][0]["unit"], "m");
  EXPECT_EQ(walled.json["metrics"]["stuck_pair"][1], "wall");
  EXPECT_LT(walled.json["metrics"]["stuck_amount"], 0.05);

  const Told contact = ToldOf("goal_in_contact");
  EXPECT_THAT(contact.warnings, testing::ElementsAre(HasSubstr("the request ends in contact")));
  ASSERT_EQ(contact.json["blocked"].size(), 1u);
  EXPECT_EQ(contact.json["blocked"][0]["kind"], "contact");
  EXPECT_EQ(contact.json["blocked"][0]["pair"][1], "box");
  EXPECT_GT(contact.json["blocked"][0]["amount"], 0.01);

  const Told limit = ToldOf("goal_beyond_limits");
  EXPECT_THAT(limit.warnings, testing::Contains(HasSubstr("its limits are")));
  ASSERT_EQ(limit.json["blocked"].size(), 1u);
  EXPECT_EQ(limit.json["blocked"][0]["kind"], "limit");
  EXPECT_EQ(limit.json["blocked"][0]["unit"], "rad");
  EXPECT_NEAR(limit.json["blocked"][0]["amount"].get<double>(), 20.0 * std::numbers::pi / 180.0,
              1e-6);
  EXPECT_EQ(limit.json["metrics"]["stuck_pair"][1], "limit");
  EXPECT_NEAR(limit.json["metrics"]["stuck_amount"].get<double>(), 20.0 * std::numbers::pi / 180.0,
              1e-6);

  EXPECT_TRUE(ToldOf("goal_freed").json["blocked"].empty()) << "it got there";
}

}  // namespace unreachable_goal_test
}  // namespace oca::runs
