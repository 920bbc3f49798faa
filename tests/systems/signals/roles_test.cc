// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/signals/roles.h"

#include <gmock/gmock.h>

#include <cmath>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/dynamic_port.h"
#include "oca/framework/dataflow/error.h"
#include "oca/systems/basics/gain.h"
#include "oca/systems/basics/saturation.h"
#include "oca/systems/fields/attractive_field.h"
#include "oca/systems/fields/delta_limiter.h"
#include "oca/systems/fields/delta_overlay.h"
#include "oca/systems/fields/delta_relaxation.h"
#include "oca/systems/fields/force_sum.h"
#include "oca/systems/fields/repulsive_field.h"
#include "oca/systems/fields/velocity_aware_field.h"
#include "oca/systems/fields/vortex_field.h"
#include "oca/systems/judging/motion_metrics.h"
#include "oca/systems/methods/elastic_band.h"
#include "oca/systems/methods/flacco_de_luca.h"
#include "oca/systems/methods/safety_filter.h"
#include "oca/systems/methods/servo_scaling.h"
#include "oca/systems/methods/task_priority.h"
#include "oca/systems/plants/integrator_plant.h"
#include "oca/systems/plants/motion_limiter.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/sensing/obstacle_source.h"
#include "tests/systems/test_models.h"

namespace oca::systems {
namespace roles_test {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const ModelSet& Arm() {
  static const ModelSet models = TestModels("planar2");
  return models;
}

/// What the only Limits of a system comes to: how it is shown, by what port, at which bound.
std::string LimitOf(const System& system) {
  const auto all = system.roles<Limits>();
  if (all.size() != 1) return std::to_string(all.size()) + " limits";
  const Limits& limits = *all[0];
  const bool output = limits.signal.output.system != nullptr;
  const std::string port = output ? system.outputs()[limits.signal.output.index].name
                                  : system.inputs()[limits.signal.input.index].name;
  const char* const shown[] = {"rate", "below", "above", "listed"};
  std::string text = shown[static_cast<int>(limits.shown)];
  text += (output ? " out " : " in ") + port;
  if (!limits.member.empty()) text += "." + limits.member;
  for (const double bound : limits.bound) text += " " + std::to_string(bound).substr(0, 4);
  return text;
}

TEST(RolesTest, EveryMethodSaysWhatShowsThatItLimits) {
  const Period period(1, 100);
  EXPECT_EQ(LimitOf(RepulsiveField({})), "below in proximities 0.30");  // its default
  EXPECT_EQ(LimitOf(VortexField({.period = period}, Arm())), "below in proximities 0.30");
  EXPECT_EQ(LimitOf(VelocityAwareField({})), "listed out forces.forces");
  EXPECT_EQ(LimitOf(AttractiveField(AttractiveField::Example())), "listed out forces.forces");
  EXPECT_EQ(LimitOf(SafetyFilter({.period = period}, Arm())), "listed out activity.bounds");
  EXPECT_EQ(LimitOf(MotionLimiter({.period = period}, Arm())), "listed out clips.clips");
  EXPECT_EQ(LimitOf(ServoScaling({.period = period}, Arm())), "below out scale 1.00");
  EXPECT_EQ(LimitOf(FlaccoDeLuca({}, Arm())), "above out rows 0.00");
  EXPECT_EQ(LimitOf(TaskPriority({}, Arm())), "above out rows 0.00");
  EXPECT_EQ(LimitOf(ElasticBand({.period = period, .margin = 0.2}, Arm())),
            "below out plan.nearest 0.20");
}

TEST(RolesTest, ALimiterOfTheDeltaSaysItsBoundOfEachJoint) {
  DeltaLimiter::Params params = DeltaLimiter::Example();
  params.max_joint_velocity = 0.25;
  EXPECT_EQ(LimitOf(DeltaLimiter(params)), "rate out limited_delta 0.25");
  params.max_joint_velocity = Eigen::VectorXd(Eigen::Vector2d(0.5, 2.0));
  EXPECT_EQ(LimitOf(DeltaLimiter(params)), "rate out limited_delta 0.50 2.00");
  EXPECT_EQ(DeltaLimiter(params).role<Limits>()->period, params.period);
}

TEST(RolesTest, ASaturationShowsByItsInputWhatItCutsOnEachSideThatItHas) {
  EXPECT_EQ(LimitOf(Saturation({.lower = -0.5})), "below in in -0.5");
  EXPECT_EQ(LimitOf(Saturation({.upper = Eigen::Vector2d(0.25, 2.0)})), "above in in 0.25 2.00");
  EXPECT_EQ(LimitOf(Saturation({.lower = -1.0, .upper = 1.0})), "2 limits");
  EXPECT_EQ(LimitOf(Saturation({})), "0 limits");
}

TEST(RolesTest, JointsWithStopsShowByTheirPositionWhereTheyStandAtOne) {
  EXPECT_EQ(LimitOf(IntegratorPlant({})), "0 limits");
  EXPECT_EQ(LimitOf(IntegratorPlant({.lower = -1.0, .upper = 1.0})), "2 limits");
  const IntegratorPlant above({.upper = Eigen::Vector2d(0.1, 2.5)});
  EXPECT_EQ(LimitOf(above), "above out position 0.10 2.50");
  const auto& upper = above.role<Limits>()->bound;
  EXPECT_LT(upper[0], 0.1);  // at the stop is above
  EXPECT_EQ(std::nextafter(upper[0], 1.0), 0.1);
  const IntegratorPlant below({.lower = -0.25});
  EXPECT_EQ(LimitOf(below), "below out position -0.2");
  EXPECT_GT(below.role<Limits>()->bound[0], -0.25);
}

TEST(RolesTest, WhatIsSwitchedOffLimitsNothing) {
  const Period period(1, 100);
  DeltaLimiter::Params params = DeltaLimiter::Example();
  params.enabled = false;
  EXPECT_EQ(LimitOf(DeltaLimiter(params)), "0 limits");
  EXPECT_EQ(LimitOf(MotionLimiter({.period = period, .enabled = false}, Arm())), "0 limits");
  EXPECT_EQ(LimitOf(ElasticBand({.period = period, .enabled = false}, Arm())), "0 limits");
  const DeltaOverlay overlay({.period = period, .enabled = false});
  EXPECT_EQ(overlay.role<PassesOn>(), nullptr);
  EXPECT_EQ(overlay.role<AddsDelta>(), nullptr);
}

TEST(RolesTest, FieldsSayHowFarTheyReach) {
  EXPECT_EQ(RepulsiveField({}).role<Repels>()->range, 0.3);
  EXPECT_EQ(VelocityAwareField({}).role<Repels>()->range, 0.6);
  EXPECT_EQ(
      VortexField({.max_distance = 0.4, .period = Period(1, 100)}, Arm()).role<Repels>()->range,
      0.4);
}

TEST(RolesTest, ADeltaIsFollowedFromTheMappingToTheOverlay) {
  const DeltaRelaxation relaxation({.relaxation_time = 0.4, .period = Period(1, 100)});
  const auto* const carries = relaxation.role<CarriesDelta>();
  ASSERT_NE(carries, nullptr);
  EXPECT_EQ(carries->in, relaxation.delta);
  EXPECT_EQ(carries->out, relaxation.relaxed_delta);
  EXPECT_EQ(carries->relaxation_time, 0.4);
  EXPECT_EQ(carries->adapts, relaxation.relaxation_time);
  EXPECT_EQ(DeltaLimiter(DeltaLimiter::Example()).role<CarriesDelta>()->relaxation_time,
            std::nullopt);
  const DeltaOverlay overlay({.period = Period(1, 100)});
  EXPECT_EQ(overlay.role<AddsDelta>()->request, overlay.request);
}

TEST(RolesTest, WhatARobotsLoopReplacesSaysSo) {
  EXPECT_NE(IntegratorPlant({}).role<Boundary>(), nullptr);
  EXPECT_NE(MotionMetrics(MotionMetrics::Example()).role<Boundary>(), nullptr);
  EXPECT_NE(ObstacleSource(ObstacleSource::Example()).role<Boundary>(), nullptr);
  EXPECT_EQ(Gain(Gain::Example()).role<Boundary>(), nullptr);
  EXPECT_EQ(RepulsiveField({}).role<Boundary>(), nullptr);
}

TEST(RolesTest, ASourceOfObstaclesSaysWhichStandWhere) {
  ObstacleSource::Params params = ObstacleSource::Example();
  params.obstacles.push_back(params.obstacles[0]);
  params.obstacles[1].id = "moving";
  params.obstacles[1].motion = MotionParams{};
  params.obstacles.push_back(params.obstacles[0]);
  params.obstacles[2].id = "last";
  const ObstacleSource source(params);
  const auto* const holds = source.role<HoldsObstacles>();
  ASSERT_NE(holds, nullptr);
  ASSERT_EQ(holds->standing.size(), 2u);
  EXPECT_EQ(holds->standing[0].parameter, "obstacles.0.pose.xyz");
  EXPECT_THAT(holds->standing[0].position, ElementsAre(0.0, 0.6, 1.0));
  EXPECT_EQ(holds->standing[1].id, "last");
  EXPECT_EQ(holds->standing[1].first, 6);
  EXPECT_NE(holds->unsampled()->role<HoldsObstacles>(), nullptr);
}

TEST(RolesTest, ADistanceBlockSaysWhatItLooksAt) {
  ModelSet models = TestModels("planar2");
  models.Add("other", LoadTestModel("planar2"));
  models.Add("third", LoadTestModel("planar2"));
  BulletDistance::Params params{.model = "planar2", .calculate_link_forces = true};
  params.others = {"third", "other"};
  params.ignore = {{"planar2_link_1", "ball"}};
  const BulletDistance distance(params, models);
  const auto* const measures = distance.role<MeasuresDistances>();
  ASSERT_NE(measures, nullptr);
  EXPECT_EQ(measures->model, "planar2");
  ASSERT_EQ(measures->others.size(), 2u);
  EXPECT_EQ(measures->others[0].model, "third");
  EXPECT_EQ(measures->others[1].links, distance.FindInput("links_other"));
  EXPECT_THAT(measures->ignored,
              ElementsAre(std::pair<std::string, std::string>("planar2_link_1", "ball")));
  EXPECT_THAT(distance.role<BlindSpots>()->spots("sight", false), Contains(HasSubstr("(ignore)")));
  params.others = {"third"};
  const BulletDistance blind(params, models);
  EXPECT_THAT(blind.role<BlindSpots>()->spots("sight", false),
              Contains("model 'other' (not among others of sight)"));
}

TEST(RolesTest, ASafetyFilterNotesWhatItsTicksCost) {
  const SafetyFilter filter({.period = Period(1, 100), .safe_distance = 0.07}, Arm());
  const auto notes = filter.role<Remarks>()->notes();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_THAT(notes[0], testing::StartsWith("keeps 0.07 m, less "));
}

/// A system with two roles of one type.
class Twice final : public System {
 public:
  Twice() {
    DeclareRole(Repels{1.0});
    DeclareRole(Boundary{"something"});
    DeclareRole(Repels{2.0});
  }
};

TEST(RolesTest, ASystemMayHaveSeveralRolesOfAType) {
  const Twice twice;
  EXPECT_EQ(twice.role<Repels>()->range, 1.0);
  const auto all = twice.roles<Repels>();
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[1]->range, 2.0);
  EXPECT_EQ(twice.role<Limits>(), nullptr);
  EXPECT_THAT(twice.roles<Limits>(), IsEmpty());
  EXPECT_THAT(DescribeRoles(twice),
              ElementsAre("stands for something, whose place a robot's own loop takes",
                          "pushes links up to 1 m away", "pushes links up to 2 m away"));
}

TEST(RolesTest, ADiagramFindsThoseOfNestedSystemsToo) {
  DiagramBuilder inner;
  inner.Add<Twice>("twice");
  DiagramBuilder builder;
  builder.AddSystem("cell", inner.Build());
  builder.Add<Twice>("own");
  const auto diagram = builder.Build();
  std::vector<std::string> found;
  for (const auto& [path, system, repels] : diagram->FindRoles<Repels>()) {
    EXPECT_EQ(diagram->FindSystem(path), system);
    found.push_back(path + " " + std::to_string(static_cast<int>(repels->range)));
  }
  EXPECT_THAT(found, ElementsAre("cell.twice 1", "cell.twice 2", "own 1", "own 2"));
}

TEST(RolesTest, APortOfARoleIsAnOutputOrWhatDrivesAnInput) {
  DiagramBuilder builder;
  const auto& first = builder.Add<ForceSum>("first", ForceSum::Params{});
  const auto& second = builder.Add<ForceSum>("second", ForceSum::Params{});
  builder.Connect(first.forces, second.forces0);
  builder.Connect(first.forces, second.forces1);
  builder.ExportInput("a", first.forces0);
  builder.ExportInput("b", first.forces1);
  const auto diagram = builder.Build();
  EXPECT_EQ(RolePort(second.forces).In(*diagram), second.forces);
  EXPECT_EQ(RolePort(second.forces1).In(*diagram), first.forces);
  EXPECT_EQ(RolePort(first.forces0).In(*diagram), std::nullopt);  // from outside
  EXPECT_EQ(RolePort().In(*diagram), std::nullopt);
}

}  // namespace roles_test
}  // namespace oca::systems
