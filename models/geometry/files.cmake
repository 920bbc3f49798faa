# SPDX-License-Identifier: BSD-3-Clause
list(APPEND headers geometry/convex_hull.h geometry/mesh.h)
list(APPEND sources geometry/convex_hull.cc geometry/lattice_hull.cc geometry/mesh.cc)
