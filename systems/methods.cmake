# SPDX-License-Identifier: BSD-3-Clause
set(methods
  avoidance_velocity
  band_memory
  clear_motion
  elastic_band
  filter_activity
  flacco_de_luca
  motion_limiter
  request_ahead
  safety_filter
  servo_scaling
  task_priority
  velocity_loop
  velocity_methods)
set(methods_sources safety_filter_problem.cc)
