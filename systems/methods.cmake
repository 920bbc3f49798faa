# SPDX-License-Identifier: BSD-3-Clause
set(methods
  filter_activity
  motion_limiter
  safety_filter)
set(methods_sources safety_filter_problem.cc)
