# SPDX-License-Identifier: BSD-3-Clause
set(avoidance
  attractive_field
  force_sum
  jacobian_mapping
  repulsive_field
  robot_kinematics
  signals
  wrench_transform)
set(avoidance_headers geometry_params.h model_links.h rotation.h)
set(avoidance_sources geometry_params.cc json_fields.cc model_links.cc rotation.cc)
