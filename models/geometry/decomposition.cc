// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/decomposition.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/file_cache.h"
#include "oca/models/geometry/coarse_mesh.h"
#include "oca/models/geometry/decomposition_cache.h"
#include "oca/models/geometry/flat_points.h"
#include "oca/models/geometry/mesh_surface.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wextra"
#include <bullet/HACD/hacdHACD.h>
#pragma GCC diagnostic pop

namespace oca::geometry {
namespace {

using Eigen::Vector3d;

constexpr double kScale = 1000.0;  // to which HACD brings the diagonal

/// HACD knows no data of a caller beside its callback.
struct Listening {
  const DecompositionListener::Show* show;
  std::string_view name;
};
thread_local DecompositionListener* listener = nullptr;
thread_local Listening listening{};

// HACD says the number of a triangle out of `whole` while it looks at each, then the percentage of
// triangles that have joined others, `left` clusters being left.
bool TellProgress(const char*, double done, double whole, std::size_t left) {
  constexpr double kFirst = 0.05;  // of the time
  if (listening.show == nullptr) return true;
  if (left == 0 && whole > 0.0) (*listening.show)(listening.name, kFirst * done / whole);
  if (left > 0 && done > 0.0) {
    (*listening.show)(listening.name, kFirst + (1.0 - kFirst) * std::min(0.01 * done, 1.0));
  }
  return true;
}

// For each triangle the number of its cluster.
std::vector<long> Partition(const TriangleMesh& mesh, double concavity) {
  if (mesh.triangles.empty()) return {0};
  std::vector<HACD::Vec3<HACD::Real>> points;
  std::vector<HACD::Vec3<long>> triangles;
  for (const Vector3d& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  for (const auto& [a, b, c] : mesh.triangles) triangles.emplace_back(a, b, c);
  HACD::HACD hacd;
  hacd.SetPoints(points.data());
  hacd.SetNPoints(points.size());
  hacd.SetTriangles(triangles.data());
  hacd.SetNTriangles(triangles.size());
  hacd.SetScaleFactor(kScale);
  hacd.SetCompacityWeight(1e-4);
  hacd.SetVolumeWeight(0.0);
  hacd.SetNClusters(1);
  hacd.SetNVerticesPerCH(100);
  hacd.SetConcavity(concavity * kScale);
  hacd.SetAddExtraDistPoints(true);
  hacd.SetAddNeighboursDistPoints(true);
  hacd.SetAddFacesPoints(true);
  hacd.SetCallBack(TellProgress);
  if (!hacd.Compute()) return std::vector<long>(triangles.size(), 0);
  return {hacd.GetPartition(), hacd.GetPartition() + triangles.size()};
}

}  // namespace

DecompositionListener::DecompositionListener(Show show)
    : show_(std::move(show)), outer_(std::exchange(listener, this)) {}
DecompositionListener::~DecompositionListener() { listener = outer_; }

std::vector<std::shared_ptr<const ConvexHull>> DecomposeMesh(const TriangleMesh& mesh,
                                                             std::string_view name,
                                                             double concavity,
                                                             std::size_t most_triangles) {
  if (!(concavity > 0.0 && concavity < 1.0)) {
    throw models::ModelError(
        fmt::format("{}: concavity; got {}; expected between 0 and 1", name, concavity));
  }
  const TriangleMesh welded = WeldVertices(mesh);
  if (welded.triangles.empty()) {
    throw models::ModelError(
        fmt::format("{}: mesh is empty; got 0 triangles; expected some", name));
  }
  const DecompositionListener::Show* const show = listener != nullptr ? &listener->show_ : nullptr;
  listening = {show, name};
  const internal::CoarseMesh coarse = internal::Coarsen(welded, most_triangles);
  const std::vector<long> cluster = Partition(coarse.mesh, concavity);
  listening = {};
  std::map<long, std::vector<Vector3d>> points;
  for (std::size_t i = 0; i < welded.triangles.size(); ++i) {
    auto& of_cluster = points[cluster[static_cast<std::size_t>(coarse.nearest[i])]];
    for (const int vertex : welded.triangles[i]) {
      of_cluster.push_back(welded.vertices[static_cast<std::size_t>(vertex)]);
    }
  }
  std::vector<std::shared_ptr<const ConvexHull>> parts;
  for (auto& entry : points) {
    internal::PadFlat(entry.second, internal::kThinnest);
    parts.push_back(MakeConvexHull(entry.second, fmt::format("{} part {}", name, parts.size())));
  }
  if (show != nullptr) (*show)(name, 1.0);
  return parts;
}

Compound LoadDecomposition(const std::filesystem::path& file, const Vector3d& scale,
                           double concavity, const std::filesystem::path& cache) {
  const std::string form = fmt::format("{} {} {} {}", scale.x(), scale.y(), scale.z(), concavity);
  return *models::ReadOnce<Compound>(file, form, [&] {
    const internal::DecompositionEntry entry(cache, file, scale, concavity);
    auto parts = entry.Read(file.string());
    if (parts.empty()) {
      parts = DecomposeMesh(LoadMesh(file, scale), file.string(), concavity);
      entry.Write(parts);
    }
    Compound compound;
    for (const auto& hull : parts) {
      compound.parts.push_back({Eigen::Isometry3d::Identity(), ConvexMesh{hull}});
    }
    return compound;
  });
}

}  // namespace oca::geometry
