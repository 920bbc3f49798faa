# SPDX-License-Identifier: BSD-3-Clause
set(avoidance
  attractive_field
  avoidance_log
  bullet_distance
  force_sum
  jacobian_mapping
  motion_metrics
  near_obstacles
  obstacle_motion
  obstacle_source
  repulsive_field
  robot_kinematics
  signals
  tip_error
  wrench_transform)
set(avoidance_headers distance_blind_spots.h geometry_params.h link_colliders.h model_links.h motion_metrics_value.h
    rotation.h)
set(avoidance_sources bullet_distance_scope.cc distance_blind_spots.cc geometry_params.cc json_fields.cc link_colliders.cc
    model_links.cc motion_certificate.cc motion_metrics_value.cc motion_tally.cc rotation.cc
    signal_checks.cc waypoint_table.cc)
