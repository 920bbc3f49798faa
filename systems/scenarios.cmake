# SPDX-License-Identifier: BSD-3-Clause
set(scenarios
  obstacle_sensor
  tip_trajectory)
