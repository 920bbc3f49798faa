// SPDX-License-Identifier: BSD-3-Clause
// Obstacles from a source of one's own: a wedge, made of points, that swings past a UR5e.
#include <cmath>
#include <cstdio>

#include "oca/diagrams/files/load_models.h"
#include "oca/framework/simulation/simulator.h"
#include "oca/models/geometry/collider.h"
#include "oca/models/geometry/convex_hull.h"
#include "oca/systems/basics/constant.h"
#include "oca/systems/sensing/bullet_distance.h"
#include "oca/systems/sensing/robot_kinematics.h"

namespace systems = oca::systems;
using systems::ObstacleSet;

/// out  obstacles  one wedge at (0, -0.8 + 0.2 sin t, 0.3), with its velocity
class SwingingWedge final : public oca::System {
 public:
  SwingingWedge()
      : obstacles(DeclareOutput<ObstacleSet, &SwingingWedge::Calc>("obstacles", {}, oca::kTime)) {
    const Eigen::Vector3d points[]{{0, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.1}};
    const oca::geometry::ConvexMesh mesh{oca::geometry::MakeConvexHull(points, "wedge")};
    body_ = std::make_shared<systems::ObstacleBody>(systems::ObstacleBody{
        .id = oca::models::Name("wedge"), .collider = MakeCollider(mesh, "wedge")});
  }

 private:
  void Calc(double t, ObstacleSet& set) const {
    set.obstacles.resize(1);
    set.obstacles[0] = {.body = body_, .linear = {0.0, 0.2 * std::cos(t), 0.0}};
    set.obstacles[0].X_WO.translation() << 0.0, -0.8 + 0.2 * std::sin(t), 0.3;
  }
  std::shared_ptr<const systems::ObstacleBody> body_;

 public:
  const oca::Output<ObstacleSet> obstacles;
};

int main() {
  const auto models = oca::files::LoadModels({{"arm", {.urdf = "package://ur5e/ur5e.urdf"}}});
  const Eigen::VectorXd q{{1.2, -1.0, 1.4, -1.9, -1.6, 0.0}};
  oca::DiagramBuilder builder;
  const auto& joints = builder.Add<systems::Constant>("joints", {.value = q, .unit = "rad"});
  const auto& arm = builder.Add<systems::RobotKinematics>("kinematics", {}, models);
  const auto& wedge = builder.Add<SwingingWedge>("wedge");
  const auto& distance =
      builder.Add<systems::BulletDistance>("distance", {.max_distance = 2.0}, models);
  builder.Connect(joints.value, arm.position);
  builder.Connect(arm.links, distance.links);
  builder.Connect(wedge.obstacles, distance.obstacles);
  const auto diagram = builder.Build();
  oca::Simulator simulator(*diagram);
  for (const double t : {0.0, 1.5}) {
    simulator.AdvanceTo(t);
    const auto& pair = distance.proximities.Eval(simulator.context()).proximities.back();
    std::printf("t = %.1f s: %s to %s %.3f m\n", t, pair.link.text().c_str(),
                pair.obstacle.text().c_str(), pair.distance);
  }
}
