# SPDX-License-Identifier: BSD-3-Clause
set(methods
  motion_limiter)
