# SPDX-License-Identifier: BSD-3-Clause
set(basics
  gain)
