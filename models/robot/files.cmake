# SPDX-License-Identifier: BSD-3-Clause
list(APPEND headers
  robot/attach_objects.h
  robot/collision_check.h
  robot/jacobian_mapping.h
  robot/joint_axis.h
  robot/joint_limits.h
  robot/kinematics.h
  robot/pseudo_inverse.h
  robot/robot_model.h
  robot/srdf.h
  robot/urdf.h
  robot/urdf_meshes.h)
list(APPEND sources
  robot/attach_objects.cc
  robot/collision_check.cc
  robot/fuse_capsules.cc
  robot/jacobian_mapping.cc
  robot/joint_limits.cc
  robot/kinematics.cc
  robot/mesh_path.cc
  robot/nearest_name.cc
  robot/pseudo_inverse.cc
  robot/robot_model.cc
  robot/srdf.cc
  robot/srdf_reader.cc
  robot/urdf.cc
  robot/urdf_meshes.cc
  robot/urdf_outline.cc
  robot/urdf_tree.cc
  robot/urdfdom.cc
  robot/xml_file.cc
  robot/xml_numbers.cc
  robot/xml_reader.cc)
list(APPEND headers robot/travel_bound.h)
list(APPEND sources robot/travel_bound.cc)
list(APPEND headers robot/link_colliders.h)
list(APPEND sources robot/link_colliders.cc)
list(APPEND headers robot/inverse_kinematics.h robot/pose_error.h)
list(APPEND sources robot/inverse_kinematics.cc robot/pose_error.cc)
list(APPEND headers robot/loop_gain.h)
list(APPEND sources robot/loop_gain.cc)
list(APPEND headers robot/filtered_inverse.h robot/saturated_task.h)
list(APPEND sources robot/filtered_inverse.cc robot/saturated_task.cc)
list(APPEND headers robot/unseen_links.h)
list(APPEND sources robot/unseen_links.cc)
