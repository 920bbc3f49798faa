# SPDX-License-Identifier: BSD-3-Clause
set(fields
  contact_slopes
  loop_gain
  velocity_aware_field
  vortex_field)
