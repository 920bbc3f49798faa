# SPDX-License-Identifier: BSD-3-Clause
set(methods
  band_memory
  elastic_band
  filter_activity
  motion_limiter
  request_ahead
  safety_filter)
set(methods_sources safety_filter_problem.cc)
