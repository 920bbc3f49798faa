# SPDX-License-Identifier: BSD-3-Clause
set(basics
  delta_limiter
  delta_overlay
  delta_relaxation
  gain
  integrator_plant
  joint_servo
  key_points
  linear_interpolator
  require
  spline_generator
  trajectory)
