// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/decomposition.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/file_cache.h"
#include "oca/models/geometry/decomposition_cache.h"
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

constexpr double kThinnest = 1e-4;  // of a part's extent; flat ones are padded to it
constexpr double kScale = 1000.0;   // to which HACD brings the diagonal

struct Span {
  Vector3d low, size;
};

Span ExtentOf(const std::vector<Vector3d>& points) {
  Vector3d low = points.front(), high = low;
  for (const Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return {low, high - low};
}

// For each triangle the number of its cluster.
std::vector<long> Partition(const TriangleMesh& mesh, double concavity) {
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
  if (!hacd.Compute()) return std::vector<long>(triangles.size(), 0);
  return {hacd.GetPartition(), hacd.GetPartition() + triangles.size()};
}

// Hull of points that may lie in one plane: then it gets the least thickness of a body.
std::shared_ptr<const ConvexHull> HullOf(std::vector<Vector3d> points, std::string_view name) {
  const double extent = ExtentOf(points).size.maxCoeff();
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) spread += (p - mean) * (p - mean).transpose();
  const Vector3d normal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  double low = 0.0, high = 0.0;
  for (const Vector3d& p : points) {
    low = std::min(low, normal.dot(p - mean));
    high = std::max(high, normal.dot(p - mean));
  }
  if (high - low < kThinnest * extent) {
    const Vector3d pad = 0.5 * kThinnest * extent * normal;
    for (std::size_t i = 0, n = points.size(); i < n; ++i) {
      points.push_back(points[i] + pad);
      points[i] -= pad;
    }
  }
  return MakeConvexHull(points, name);
}

}  // namespace

std::vector<std::shared_ptr<const ConvexHull>> DecomposeMesh(const TriangleMesh& mesh,
                                                             std::string_view name,
                                                             double concavity) {
  if (!(concavity > 0.0 && concavity < 1.0)) {
    throw models::ModelError(
        fmt::format("{}: concavity; got {}; expected between 0 and 1", name, concavity));
  }
  const TriangleMesh welded = WeldVertices(mesh);
  if (welded.triangles.empty()) {
    throw models::ModelError(
        fmt::format("{}: mesh is empty; got 0 triangles; expected some", name));
  }
  const std::vector<long> cluster = Partition(welded, concavity);
  std::map<long, std::vector<Vector3d>> points;
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    for (const int vertex : welded.triangles[i]) {
      points[cluster[i]].push_back(welded.vertices[static_cast<std::size_t>(vertex)]);
    }
  }
  std::vector<std::shared_ptr<const ConvexHull>> parts;
  for (auto& entry : points) {
    parts.push_back(HullOf(std::move(entry.second), fmt::format("{} part {}", name, parts.size())));
  }
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
