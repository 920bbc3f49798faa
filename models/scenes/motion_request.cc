// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/scenes/motion_request.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "oca/models/scenes/foreign_tree.h"
#include "oca/models/scenes/scene_bodies.h"
#include "oca/models/table_text.h"

namespace oca::scenes {
namespace {

using internal::Foreign;

/// One file.
class RequestReader {
 public:
  explicit RequestReader(const Foreign& tree) : tree_(tree) {}

  MotionRequest Read() {
    if (!tree_.is_map()) tree_.Refuse("a map with `goal_constraints`");
    internal::NoteUnknown(
        tree_,
        {"start_state", "goal_constraints", "workspace_parameters", "planner_id", "pipeline_id",
         "group_name", "num_planning_attempts", "allowed_planning_time",
         "max_velocity_scaling_factor", "max_acceleration_scaling_factor", "path_constraints",
         "trajectory_constraints", "reference_trajectories", "cartesian_speed_end_effector_link",
         "cartesian_speed_limited_link", "max_cartesian_speed"},
        request_.notes);
    request_.group = tree_.Text("group_name");
    if (const auto state = tree_.Find("start_state")) {
      request_.start = internal::JointsOf(*state, request_.notes);
      if (!state->Items("attached_collision_objects").empty()) {
        Note(*state, "attached_collision_objects", "not taken over; those of the scene are");
      }
    }
    ReadGoal();
    NoteRest();
    return std::move(request_);
  }

 private:
  void Note(const Foreign& at, const char* what, const std::string& why) {
    request_.notes.push_back(fmt::format("{}: {}: {}", at.where(), what, why));
  }

  void ReadGoal() {
    const Foreign goals = tree_.Get("goal_constraints");
    const auto all = goals.Items();
    if (all.size() != 1) goals.Refuse(fmt::format("{} goals", all.size()), "one goal");
    const Foreign& goal = all.front();
    internal::NoteUnknown(goal,
                          {"name", "joint_constraints", "position_constraints",
                           "orientation_constraints", "visibility_constraints"},
                          request_.notes);
    const auto joints = goal.Items("joint_constraints");
    const auto positions = goal.Items("position_constraints");
    const auto rotations = goal.Items("orientation_constraints");
    if (!goal.Items("visibility_constraints").empty()) {
      Note(goal, "visibility_constraints", "not looked at");
    }
    if (!joints.empty() && positions.size() + rotations.size() > 0) {
      goal.Refuse("two goals, of joints and of a pose", "one");
    }
    if (!joints.empty()) return ReadJoints(goal, joints);
    if (positions.empty()) {
      goal.Refuse(rotations.empty() ? "no constraint" : "an orientation without a position",
                  "joint_constraints, or position_constraints");
    }
    if (positions.size() > 1 || rotations.size() > 1) {
      goal.Refuse(fmt::format("{} position and {} orientation constraints", positions.size(),
                              rotations.size()),
                  "one goal: one of each");
    }
    ReadPose(positions.front(), rotations);
  }

  void ReadJoints(const Foreign& goal, const std::vector<Foreign>& constraints) {
    request_.goal.where = goal.where();
    for (const Foreign& constraint : constraints) {
      const std::string joint = constraint.Get("joint_name").Text();
      if (request_.goal.Find(joint) != nullptr) {
        constraint.Refuse(fmt::format("joint '{}' a second time", models::internal::Shown(joint)),
                          "it once");
      }
      request_.goal.positions.emplace_back(joint, constraint.Get("position").Number());
    }
  }

  void ReadPose(const Foreign& position, const std::vector<Foreign>& rotations) {
    RequestedPose pose;
    pose.where = position.where();
    pose.link = internal::NameOf(position.Get("link_name"));
    pose.frame = internal::FrameOf(position);
    if (const auto offset = position.Find("target_point_offset")) pose.offset = offset->Vector();
    const Foreign region = position.Get("constraint_region");
    const auto poses = region.Items("primitive_poses");
    const auto mesh_poses = region.Items("mesh_poses");
    if (poses.size() + mesh_poses.size() != 1) {
      region.Refuse(fmt::format("{} poses", poses.size() + mesh_poses.size()),
                    "one, the middle of which is the goal");
    }
    pose.position = (poses.empty() ? mesh_poses : poses).front().Pose().translation();
    if (!rotations.empty()) {
      const Foreign& rotation = rotations.front();
      const std::string link = rotation.Get("link_name").Text();
      if (link != pose.link.text) {
        rotation.Refuse(fmt::format("link '{}'", models::internal::Shown(link)),
                        fmt::format("'{}', of which the position is", pose.link.text));
      }
      pose.rotation = rotation.Get("orientation").Rotation();
      pose.rotation_frame = internal::FrameOf(rotation);
    } else if (!pose.offset.isZero(0.0)) {
      position.Refuse("a target_point_offset without an orientation", "both, or neither");
    }
    request_.pose = std::move(pose);
  }

  void NoteRest() {
    if (const auto workspace = tree_.Find("workspace_parameters")) {
      Note(*workspace, "workspace_parameters", "not looked at; the limits of the joints bound it");
    }
    for (const char* key : {"path_constraints", "trajectory_constraints"}) {
      const auto constraints = tree_.Find(key);
      if (constraints && SaysAnything(*constraints)) Note(*constraints, key, "not taken over");
    }
    for (const char* key : {"max_velocity_scaling_factor", "max_acceleration_scaling_factor"}) {
      const auto factor = tree_.Find(key);
      if (!factor || factor->Number() == 0.0 || factor->Number() == 1.0) continue;
      Note(*factor, key,
           fmt::format("{} not taken over; limits are the model's", factor->Number()));
    }
  }

  /// Whether any of its lists has something in it.
  static bool SaysAnything(const Foreign& constraints) {
    if (!constraints.is_map()) return constraints.size() > 0;
    for (const char* key : {"joint_constraints", "position_constraints", "orientation_constraints",
                            "visibility_constraints", "constraints"}) {
      if (!constraints.Items(key).empty()) return true;
    }
    return false;
  }

  const Foreign& tree_;
  MotionRequest request_;
};

}  // namespace

MotionRequest ReadMotionRequest(const std::filesystem::path& file) {
  const internal::ForeignValue tree = internal::ReadForeignYaml(file);
  const Foreign root(std::make_shared<const std::string>(file.string()), tree, "");
  MotionRequest request = RequestReader(root).Read();
  request.file = file.string();
  return request;
}

}  // namespace oca::scenes
