// SPDX-License-Identifier: BSD-3-Clause
#include "oca/systems/commands/pose_goal.h"

#include <fmt/format.h>

#include <utility>

#include "oca/framework/dataflow/diagram.h"
#include "oca/framework/dataflow/port_access.h"
#include "oca/models/planning/pose_goal.h"
#include "oca/systems/sensing/placed_bodies.h"
#include "oca/systems/signals/config_errors.h"

namespace oca::systems {
namespace {

std::vector<robot::PlacedBody> BodiesAt(const std::vector<ObstacleSource::Params>& sources,
                                        double time) {
  std::vector<robot::PlacedBody> bodies;
  for (const ObstacleSource::Params& params : sources) {
    auto owned = std::make_unique<ObstacleSource>(params);
    const ObstacleSource& source = *owned;
    const auto diagram = MakeDiagramOf(std::move(owned));
    Context context = diagram->MakeContext();
    context.SetTime(time);
    const auto placed = PlacedBodies(source.obstacles.Eval(context));
    bodies.insert(bodies.end(), placed.begin(), placed.end());
  }
  return bodies;
}

}  // namespace

void PoseGoalParams::Describe(Fields<PoseGoalParams>& fields) {
  fields.Add("pose", &PoseGoalParams::pose, "",
             "of the link, in the world; this or point is required");
  fields.Add(
      "point", &PoseGoalParams::point, "m",
      "instead of pose: where the origin of the link shall be, turned however it is, as of an "
      "arm of four or five joints");
  fields.Add("link", &PoseGoalParams::link, "",
             "the link; may be left out if the robot has one tip");
  fields.Add("time", &PoseGoalParams::time, "s",
             "of arrival; absent: with a quarter of the joints' speed limits");
  fields
      .Add("clearance", &PoseGoalParams::clearance, "m",
           "kept from obstacles and own links, if that can be; 0: not looked at")
      .AtLeast(0.0);
  fields.Add("around", &PoseGoalParams::around, "",
             "obstacles, as parameters of ObstacleSources; absent: those of the file");
}

motion::KeyPoint KeyPointAt(const PoseGoalParams& params, const motion::KeyPoint& before,
                            const std::shared_ptr<const robot::RobotModel>& model) {
  planning::PoseGoal goal;
  if (params.pose.has_value() == params.point.has_value()) {
    throw ConfigError(fmt::format("goal: got {}; expected one of pose and point",
                                  params.pose ? "both pose and point" : "neither pose nor point"));
  }
  if (params.pose) goal.X_WG = params.pose->Pose("goal.pose");
  if (params.point) goal.X_WG.translation() = *params.point;
  goal.turns_freely = params.point.has_value();
  goal.link = params.link;
  goal.time = params.time;
  goal.clearance = params.clearance;
  goal.bodies = [&](double time) { return BodiesAt(params.around, time); };
  return WithConfigErrors([&] { return planning::KeyPointAt(goal, before, model); });
}

}  // namespace oca::systems
