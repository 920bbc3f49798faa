#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Makes scan.xyz beside it: what a depth camera might see of a cube and of a post, a point every
# 0.01 m of their surfaces with 2 mm of noise. The same points everywhere, whatever awk there is.
awk '
function noise() { seed = (seed * 16807) % 2147483647; return (seed / 2147483647 - 0.5) * 0.004 }
function point(x, y, z) { printf "%.3f %.3f %.3f\n", x + noise(), y + noise(), z + noise() }
BEGIN {
  seed = 42
  for (i = 0; i < 20; ++i)            # the cube: 0.2 m about (0, 0.6, 1), the faces of x, y and z
    for (j = 0; j < 20; ++j) {
      u = (i - 9.5) * 0.01; v = (j - 9.5) * 0.01
      for (side = -0.1; side < 0.2; side += 0.2) {
        point(side, 0.6 + u, 1 + v); point(u, 0.6 + side, 1 + v); point(u, 0.6 + v, 1 + side)
      }
    }
  for (k = 0; k < 60; ++k)            # the post: 0.05 m about (0.45, -0.5), up to 0.6 m
    for (i = 0; i < 31; ++i) {
      angle = 2 * 3.14159265358979 * i / 31
      point(0.45 + 0.05 * cos(angle), -0.5 + 0.05 * sin(angle), 0.005 + 0.01 * k)
    }
}' > "$(dirname "$0")/scan.xyz"
