// SPDX-License-Identifier: BSD-3-Clause
// Robots by package:// without a diagram file: where the tip of a UR5e is, in the world.
#include <cstdio>
#include <exception>

#include "oca/diagrams/files/load_models.h"
#include "oca/framework/simulation/simulator.h"
#include "oca/models/robot/robot_model.h"
#include "oca/systems/basics/constant.h"
#include "oca/systems/sensing/robot_kinematics.h"

using oca::systems::Constant;
using oca::systems::RobotKinematics;

int main() {
  try {
    // As section `models` of a file has them: a base pose, limits, held objects, ...
    const auto models = oca::files::LoadModels({{"arm",
                                                 {.urdf = "package://ur5e/ur5e.urdf",
                                                  .srdf = "package://ur5e/ur5e.srdf",
                                                  .base_pose = {.xyz = {0.0, 0.0, 0.8}}}}});
    const auto arm = models.Get("arm");
    const Eigen::VectorXd q{{0.0, -1.0, 1.4, -1.9, -1.6, 0.0}};

    oca::DiagramBuilder builder;
    const auto& joints = builder.Add<Constant>("joints", {.value = q, .unit = "rad"});
    const auto& kinematics = builder.Add<RobotKinematics>("kinematics", {.model = "arm"}, models);
    builder.Connect(joints.value, kinematics.position);
    const auto diagram = builder.Build();

    const oca::Context context = diagram->MakeContext();  // no time passes: no simulator
    const auto& links = kinematics.links.Eval(context);
    const Eigen::Vector3d tip = links.poses.back().translation();
    std::printf("%s: %d joints, %d links\n", arm->name().text().c_str(), arm->num_positions(),
                arm->num_links());
    std::printf("%s at %.3f %.3f %.3f m\n", links.links.back().text().c_str(), tip.x(), tip.y(),
                tip.z());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
