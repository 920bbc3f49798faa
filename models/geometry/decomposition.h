// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "oca/models/geometry/convex_hull.h"
#include "oca/models/geometry/mesh.h"
#include "oca/models/geometry/shape.h"

namespace oca::geometry {

/// Deepest dent that a part may have before it is cut further, of the diagonal of the mesh.
inline constexpr double kDefaultConcavity = 0.03;

/// Triangles of a mesh that are clustered one by one. The time grows with more than their square:
/// 4 s for a robot's link of 3000, most of which are flat, 22 s for a torus of 1800.
inline constexpr std::size_t kDefaultTriangles = 4000;

/// Convex parts whose union holds every triangle of the mesh: hulls of the clusters that
/// hierarchical approximate convex decomposition finds. Vertices within 1e-6 of the extent are
/// welded first. What is inside a closed mesh need not be covered. The same mesh gives the same
/// parts.
///
/// Takes seconds for thousands of triangles, a minute at worst: of a mesh with more than
/// `most_triangles` the clusters are sought on one of so many, whose vertices lie some hundredths
/// of the diagonal off. The parts hold every triangle of the mesh all the same.
///
/// throws ModelError naming `name` for a concavity outside (0, 1), and as MakeConvexHull does
/// source Mamou, Ghorbel 2009, A simple and efficient approach for 3D mesh approximate convex
/// decomposition
std::vector<std::shared_ptr<const ConvexHull>> DecomposeMesh(
    const TriangleMesh& mesh, std::string_view name, double concavity = kDefaultConcavity,
    std::size_t most_triangles = kDefaultTriangles);

/// Hears, while it lives, how far decompositions on this thread are; of two the younger one does.
class DecompositionListener {
 public:
  /// Gets the name of the mesh and the share that is done, 1 at the end; some times a second or
  /// once in seconds, as it comes.
  using Show = std::function<void(std::string_view name, double share)>;

  explicit DecompositionListener(Show show);
  ~DecompositionListener();
  DecompositionListener(const DecompositionListener&) = delete;
  DecompositionListener& operator=(const DecompositionListener&) = delete;

 private:
  friend std::vector<std::shared_ptr<const ConvexHull>> DecomposeMesh(const TriangleMesh& mesh,
                                                                      std::string_view name,
                                                                      double concavity,
                                                                      std::size_t most_triangles);
  const Show show_;
  DecompositionListener* const outer_;
};

/// Where decompositions are kept: oca in $XDG_CACHE_HOME, else .cache/oca in $HOME; empty if
/// neither is set.
std::filesystem::path DecompositionCache();

/// The parts of a mesh file as a compound. They are kept in `cache` under a hash of the file's
/// content, the scale and the concavity, and taken from there the next time; several processes may
/// do so at once. An empty folder, or one that cannot be written, only costs time. A FileCache in
/// use keeps them too.
/// throws ModelError as LoadMesh and DecomposeMesh do
Compound LoadDecomposition(const std::filesystem::path& file,
                           const Eigen::Vector3d& scale = Eigen::Vector3d::Ones(),
                           double concavity = kDefaultConcavity,
                           const std::filesystem::path& cache = DecompositionCache());

}  // namespace oca::geometry
