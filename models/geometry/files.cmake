# SPDX-License-Identifier: BSD-3-Clause
list(APPEND headers geometry/convex_hull.h geometry/mesh.h geometry/collider.h
  geometry/distance.h)
list(APPEND sources geometry/box_overlap.cc geometry/bullet_penetration.cc
  geometry/closed_forms.cc geometry/collider.cc geometry/contact_refinement.cc
  geometry/convex_hull.cc geometry/distance.cc
  geometry/gjk.cc geometry/hull_support.cc geometry/lattice_hull.cc geometry/mesh.cc
  geometry/point_forms.cc geometry/polytope_depth.cc geometry/segment_forms.cc
  geometry/simplex.cc)

# Many bodies at once.
list(APPEND headers geometry/ball_tree.h geometry/decomposition.h geometry/mesh_surface.h
  geometry/octree.h geometry/point_cloud.h)
list(APPEND sources geometry/ball_tree.cc geometry/decomposition.cc
  geometry/decomposition_cache.cc geometry/heightmap.cc geometry/mesh_surface.cc
  geometry/nearest_part.cc geometry/octree.cc geometry/point_cloud.cc geometry/table_text.cc)
