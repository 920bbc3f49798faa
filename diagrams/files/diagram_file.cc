// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/files/diagram_file.h"

#include <fmt/format.h>

#include "oca/framework/dataflow/error.h"
#include "oca/models/robot/joint_limits.h"
#include "oca/models/robot/xacro.h"

namespace oca::files {

void AttachedParams::Describe(Fields<AttachedParams>& fields) {
  fields.Add("id", &AttachedParams::id, "", "its name, as a link of the robot").Required();
  fields.Add("link", &AttachedParams::link, "", "link that carries it").Required();
  fields.Add("shape", &AttachedParams::shape, "", "its solid").Required();
  fields.Add("pose", &AttachedParams::pose, "", "of the shape in the frame of that link");
  fields.Add("touches", &AttachedParams::touches, "",
             "links of the robot that it may touch, besides those rigidly connected to it");
}

void ModelParams::Describe(Fields<ModelParams>& fields) {
  fields.Add("urdf", &ModelParams::urdf, "",
             "robot description: a path or package://NAME/PATH; this or xacro is required");
  fields.Add("xacro", &ModelParams::xacro, "",
             "instead of urdf: a file that is expanded first, named .xacro");
  fields.Add("arguments", &ModelParams::arguments, "",
             "values of the arguments that the xacro declares, by name");
  fields.Add(
      "srdf", &ModelParams::srdf, "",
      "pairs of links that are not checked for collision, groups of joints, and postures that "
      "have names");
  fields.Add(
      "group", &ModelParams::group, "",
      "of the SRDF: the joints that move; all others are held, at 0 or the limit nearest to it "
      "if `held` does not say where");
  fields.Add(
      "held", &ModelParams::held, "",
      "joints that no method moves, by name with their positions, rad or m; or by group with "
      "the name of a state of it. They are no joints of the robot's positions");
  fields.Add("collision", &ModelParams::collision, "",
             "what its collision meshes count as: their convex hull, or the convex parts of a "
             "decomposition, which keep hollows");
  fields.Add("visual_as_collision", &ModelParams::visual_as_collision, "",
             "which links take what is drawn of them as their collision shapes: none, those that "
             "are missing any, or all that are drawn");
  fields.Add("base_pose", &ModelParams::base_pose, "", "pose of the root link in the world");
  fields
      .Add("acceleration_limits", &ModelParams::acceleration_limits, "rad/s^2",
           "which URDF lacks; a number or one a joint")
      .AtLeast(robot::kLeastAcceleration);
  fields
      .Add("jerk_limits", &ModelParams::jerk_limits, "rad/s^3",
           "which URDF lacks; a number or one a joint")
      .AtLeast(robot::kLeastJerk);
  fields.Add("joint_limits", &ModelParams::joint_limits, "",
             "YAML file of joint limits as MoveIt writes it, which narrow all others");
  fields.Add("attached", &ModelParams::attached, "",
             "tools and grasped objects: they move with a link of the robot and collide");
}

const std::string& DescriptionOf(const ModelParams& params) {
  const bool xacro = !params.xacro.empty();
  if (xacro == !params.urdf.empty()) {
    throw ConfigError(fmt::format("got {}; expected one of urdf and xacro",
                                  xacro ? "both urdf and xacro" : "neither urdf nor xacro"));
  }
  const std::string& file = xacro ? params.xacro : params.urdf;
  if (robot::IsXacro(file) != xacro) {
    throw ConfigError(fmt::format(
        "{}: got '{}'; expected {}", xacro ? "xacro" : "urdf", file,
        xacro ? "a file named .xacro (a URDF goes into urdf)" : "a URDF (key xacro expands this)"));
  }
  if (!xacro && !params.arguments.texts.empty()) {
    throw ConfigError(fmt::format("arguments: got '{}'; expected none: urdf takes no arguments",
                                  params.arguments.texts.begin()->first));
  }
  return file;
}

const std::vector<Section>& Sections() {
  static const std::vector<Section> sections = {
      {"name", "short name of the diagram"},
      {"description", "what it shows, in a sentence"},
      {"include", "files to merge first; this file wins"},
      {"parameters", "knobs of this file, used as ${name}"},
      {"simulator", "duration, integrator, tolerances, seed"},
      {"simulator_tolerances", "tolerances of single systems, by name"},
      {"sampling",
       "makes the file a family of scenarios: what the seed draws, and what is accepted"},
      {"packages", "folders that package://NAME/ stands for"},
      {"models", "robots and frames, by name"},
      {"systems", "blocks, by name: type and parameters"},
      {"connections",
       "list of `system.output -> system.input`; `inputs.NAME` and `outputs.NAME` are ports of the "
       "file itself, `<x>` stands for any name"},
      {"record", "signals to keep, with their rates in Hz"},
      {"expect", "bounds on metrics and signals that the run must keep"},
  };
  return sections;
}

const std::vector<Section>& DiagramKeys() {
  static const std::vector<Section> keys = {
      {"file", "the diagram file, relative to this one, or package://NAME/PATH; required"},
      {"parameters",
       "values for its parameters, in place of its own: a map, or a list of maps of which the "
       "later ones win"},
      {"models", "models of this file that stand for its own, by their names there"},
  };
  return keys;
}

}  // namespace oca::files
