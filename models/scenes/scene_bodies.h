// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "oca/models/scenes/foreign_tree.h"
#include "oca/models/scenes/planning_scene.h"

namespace oca::scenes::internal {

/// The solid of a primitive. `sizes` as shape_msgs/SolidPrimitive has them: of a box the three edge
/// lengths, of a sphere the radius, of a cylinder or cone height and radius. `type` is a word
/// ("box") or MoveIt's number of it ("1").
/// throws ModelError beginning with `where`
geometry::Shape PrimitiveOf(std::string_view type, std::span<const double> sizes,
                            const std::string& where);

/// throws ModelError beginning with `where` unless each index is of a vertex
void CheckTriangles(const geometry::TriangleMesh& mesh, const std::string& where);
/// a x + b y + c z + d = 0.
ScenePlane PlaneOf(std::span<const double> coefficients, const std::string& where);

/// The object of a moveit_msgs/CollisionObject; what it says beside that is added to `notes`.
SceneObject ObjectOf(const Foreign& tree, std::vector<std::string>& notes);

/// `sensor_msgs/JointState` and MultiDOFJointState of a moveit_msgs/RobotState.
JointPositions JointsOf(const Foreign& robot_state, std::vector<std::string>& notes);

inline PlacedName NameOf(const Foreign& text) { return {text.Text(), text.where()}; }

/// The frame_id of a header without a leading slash, as ROS 1 writes it; empty if it has none.
PlacedName FrameOf(const Foreign& tree);

/// Adds a line for each key that is not known.
void NoteUnknown(const Foreign& tree, std::initializer_list<std::string_view> known,
                 std::vector<std::string>& notes);

}  // namespace oca::scenes::internal
