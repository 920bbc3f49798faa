// SPDX-License-Identifier: BSD-3-Clause
// Blocks of somebody else, which no file of OCA knows by name, are treated as ours are if they
// declare the same roles.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "oca/diagrams/record/plot_hints.h"
#include "oca/diagrams/runs/blind_spots.h"
#include "oca/systems/sensing/geometry_params.h"
#include "oca/systems/signals/motion_metrics_value.h"
#include "oca/systems/signals/roles.h"
#include "tests/diagrams/record/record_runs.h"

namespace oca::record {
namespace foreign_block_test {

using nlohmann::json;
using systems::ObstacleSet;
using systems::ProximitySet;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

systems::ShapeParams Ball() {
  systems::ShapeParams ball;
  ball.type = systems::ShapeType::kSphere;
  ball.radius = 0.1;
  return ball;
}

/// Holds one ball.
class Camera final : public System {
 public:
  Camera()
      : body_(systems::MakeObstacleBody("ball", Ball(), "ball", nullptr)),
        obstacles(DeclareOutput<ObstacleSet, &Camera::Calc>("obstacles", {})) {
    DeclareRole(systems::Boundary{"a camera"});
    DeclareRole(systems::HoldsObstacles{.obstacles = obstacles});
  }

 private:
  const std::shared_ptr<const systems::ObstacleBody> body_;
  void Calc(ObstacleSet& set) const { set.obstacles = {{body_}}; }

 public:
  const Output<ObstacleSet> obstacles;
};

/// Sees everything at 0.25 m, but no glass.
class Lidar final : public System {
 public:
  Lidar()
      : obstacles(DeclareInput<ObstacleSet>("obstacles")),
        proximities(DeclareOutput<ProximitySet, &Lidar::Calc>("proximities", {}, obstacles)) {
    DeclareRole(systems::BlindSpots{.spots = [](const std::string& own_name, bool /*one_robot*/) {
      return std::vector<std::string>{"glass (" + own_name + " is a lidar)"};
    }});
    DeclareRole(
        systems::Plots{.id = "distance", .title = "Distances", .signal = proximities, .unit = "m"});
    DeclareRole(systems::Plots{.id = "echo", .title = "Echoes", .signal = obstacles, .unit = "dB"});
  }

 private:
  void Calc(const ObstacleSet& set, ProximitySet& found) const {
    found.proximities.clear();
    for (const auto& obstacle : set.obstacles) {
      found.proximities.push_back({models::Name("link"), obstacle.body->id, 0.25});
    }
    found.compared = true;
  }

 public:
  const Input<ObstacleSet> obstacles;
  const Output<ProximitySet> proximities;
};

/// command = -position, no larger than 0.5.
class Governor final : public System {
 public:
  explicit Governor(bool limits)
      : position(DeclareInput<Vector>("position", {2, "rad"})),
        proximities(DeclareOptionalInput<ProximitySet>("proximities")),
        command(DeclareOutput<Vector, &Governor::Calc>("command", {2, "rad/s"}, position)) {
    if (!limits) return;
    DeclareRole(systems::Limits{.shown = systems::Limits::Shown::kAbove,
                                .signal = command,
                                .bound = {0.4, 0.5},
                                .how = "governed",
                                .period = Period(1, 200)});
    DeclareRole(systems::Limits{.shown = systems::Limits::Shown::kBelow,
                                .signal = proximities,
                                .bound = {0.7},
                                .member = "ball"});
    DeclareRole(systems::Repels{0.7});
  }

 private:
  void Calc(VectorView q, MutableVectorView out) const { out = (-q).cwiseMin(0.5).cwiseMax(-0.5); }

 public:
  const Input<Vector> position;
  const OptionalInput<ProximitySet> proximities;
  const Output<Vector> command;
};

class Motors final : public System {
 public:
  Motors()
      : q_(DeclareContinuousState("q", {2, "rad"}, 1.0)),
        command(DeclareInput<Vector>("command", {2, "rad/s"})),
        position(DeclareStateOutput("position", q_)),
        velocity(DeclareOutput<Vector, &Motors::Calc>("velocity", {2, "rad/s"}, command)) {
    DeclareDerivative<&Motors::Calc>(q_, command);
    DeclareRole(systems::Boundary{"motors"});
    DeclareRole(systems::Plant{.command = command, .position = position, .velocity = velocity});
    DeclareRole(systems::Plots{.id = "speed", .title = "Joint speeds", .signal = velocity});
  }

 private:
  void Calc(VectorView now, MutableVectorView out) const { out = now; }
  const ContinuousState q_;

 public:
  const Input<Vector> command;
  const Output<Vector> position, velocity;
};

class Referee final : public System {
 public:
  Referee()
      : position(DeclareInput<Vector>("position", {2, "rad"})),
        proximities(DeclareInput<ProximitySet>("proximities")),
        verdict(DeclareOutput<systems::MotionMetricsValue, &Referee::Calc>("verdict", {},
                                                                           proximities)) {
    DeclareRole(systems::Boundary{"a referee"});
    DeclareRole(systems::Judges{
        .metrics = verdict, .position = position, .proximities = proximities, .model = {}});
    DeclareRole(systems::Plots{.id = "final", .title = "Final joints", .signal = position});
  }

 private:
  void Calc(const ProximitySet& set, systems::MotionMetricsValue& value) const {
    value.min_distance = set.proximities.at(0).distance;
  }

 public:
  const Input<Vector> position;
  const Input<ProximitySet> proximities;
  const Output<systems::MotionMetricsValue> verdict;
};

/// What a file of such blocks would say.
loading::LoadedDiagram Foreign(bool limits = true) {
  DiagramBuilder builder;
  const auto& camera = builder.Add<Camera>("camera");
  const auto& lidar = builder.Add<Lidar>("lidar");
  const auto& governor = builder.Add<Governor>("governor", limits);
  const auto& motors = builder.Add<Motors>("motors");
  const auto& referee = builder.Add<Referee>("referee");
  builder.Connect(camera.obstacles, lidar.obstacles);
  builder.Connect(motors.position, governor.position);
  builder.Connect(lidar.proximities, governor.proximities);
  builder.Connect(governor.command, motors.command);
  builder.Connect(motors.position, referee.position);
  builder.Connect(lidar.proximities, referee.proximities);
  loading::LoadedDiagram loaded;
  loaded.name = "foreign";
  loaded.simulator.duration = 1.0;
  loaded.diagram = builder.Build();
  for (const auto& leaf : loaded.diagram->systems()) {
    loaded.systems.push_back({leaf.path, "Foreign_" + leaf.path, {}, nullptr, nullptr});
  }
  for (const auto& judge : loaded.diagram->FindRoles<systems::Judges>()) {
    loaded.metrics.emplace_back(judge.path, judge.role->metrics);
  }
  return loaded;
}

TEST(ForeignBlockTest, IsNamedAmongThoseThatLimit) {
  const auto loaded = Foreign();
  const auto hints = LimitHintsOf(loaded);
  ASSERT_EQ(hints.size(), 2u);
  EXPECT_EQ(hints[0].system, "governor");
  EXPECT_EQ(hints[0].type, "Foreign_governor");
  EXPECT_EQ(hints[0].period, Period(1, 100));
  EXPECT_EQ(hints[1].output, loaded.diagram->FindOutput("lidar.proximities"));
  EXPECT_EQ(json::parse(LimitHintsJson(loaded, hints)), json::parse(R"([
      {"system": "governor", "type": "Foreign_governor", "kind": "above",
       "signal": "/governor/command", "bound": [0.4, 0.5], "how": "governed"},
      {"system": "governor", "type": "Foreign_governor", "kind": "below",
       "signal": "/lidar/proximities", "bound": 0.7, "member": "ball"}])"));
  EXPECT_THAT(LimitHintsOf(Foreign(false)), IsEmpty());
}

TEST(ForeignBlockTest, IsPlottedBesideOurs) {
  const auto loaded = Foreign();
  const auto hints = PlotHintsOf(loaded);
  std::vector<std::string> seen;
  for (const PlotHint& hint : hints) seen.push_back(hint.id + " " + hint.unit);
  EXPECT_THAT(seen, ElementsAre("final rad", "distance m", "speed rad/s", "echo dB"));
  EXPECT_EQ(hints[1].limit, 0.7);
  EXPECT_EQ(PlotHintsOf(Foreign(false))[1].limit, std::nullopt);
  EXPECT_EQ(hints[3].outputs, std::vector{loaded.diagram->FindOutput("camera.obstacles")});
}

TEST(ForeignBlockTest, JudgesARunAndSaysWhatItDoesNotSee) {
  const auto loaded = Foreign();
  const auto result = runs::Run(loaded, {.duration = 0.1});
  EXPECT_EQ(result.metrics->min_distance, 0.25);
  EXPECT_TRUE(runs::JudgesDistances(loaded));
  EXPECT_THAT(runs::BlindSpots(loaded), ElementsAre("glass (lidar is a lidar)"));
}

TEST(ForeignBlockTest, GivesItsPlaceToARobotsOwnLoop) {
  EXPECT_THAT(loading::InsideOf(*Foreign().diagram), ElementsAre("lidar", "governor"));
}

TEST(ForeignBlockTest, IsRecordedAndDrawn) {
  const auto loaded = Foreign();
  std::ostringstream stream;
  McapSink sink(stream, Compression::kNone);
  RecorderOptions options;
  options.start_epoch = test::kEpoch;
  options.attach_files = false;
  Recording recorder({&sink}, options);
  runs::Run(loaded, {.duration = 0.5, .outputs = {&recorder}});
  const McapFile file = McapFile::Parse(stream.str(), "memory");
  EXPECT_EQ(file.MessagesOf("/governor/command").size(), 51u);  // its limit, at 100 Hz
  EXPECT_GT(file.MessagesOf("/camera/obstacles").size(), 25u);  // its plot, at the picture's 60 Hz
  const json limits = json::parse(file.FindMetadata("oca.plots")->at("limits"));
  EXPECT_EQ(limits.size(), 2u);
  EXPECT_THAT(file.FindMetadata("oca")->at("not_seen"), HasSubstr("glass"));
  const auto pictures = file.MessagesOf("/scene/obstacles");
  ASSERT_EQ(pictures.size(), 1u);
  EXPECT_THAT(pictures[0]->data, HasSubstr("obstacle/ball"));
  const json lines = json::parse(file.MessagesOf("/scene/forces").back()->data);
  EXPECT_EQ(lines["entities"][0]["lines"][0]["points"].size(), 2u);
}

}  // namespace foreign_block_test
}  // namespace oca::record
