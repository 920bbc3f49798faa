// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/geometry/collada_file.h"
#include "oca/models/geometry/obj_file.h"
#include "oca/models/geometry/ply_file.h"
#include "oca/models/geometry/stl_file.h"

namespace oca::geometry {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

[[noreturn]] void Refuse(const fs::path& file, const std::string& what) {
  throw models::ModelError(fmt::format("{}: {}", file.string(), what));
}

std::string LowerExtension(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

void CheckKind(const fs::path& file) {
  const std::string extension = LowerExtension(file);
  if (extension == ".stl" || extension == ".obj" || extension == ".dae" || extension == ".ply")
    return;
  Refuse(file,
         fmt::format("unknown kind of mesh; got extension '{}'; expected .stl, .obj, .dae, .ply",
                     extension));
}

void CheckScale(const fs::path& file, const Vector3d& scale) {
  if (scale.allFinite() && (scale.array() != 0.0).all()) return;
  Refuse(file, fmt::format("scale; got ({}, {}, {}); expected finite numbers other than 0",
                           scale.x(), scale.y(), scale.z()));
}

// Vertices that no triangle uses (points, lines) are no part of the surface.
void DropUnused(TriangleMesh* mesh) {
  std::vector<int> index(mesh->vertices.size(), -1);
  std::vector<Vector3d> used;
  used.reserve(mesh->vertices.size());
  for (auto& triangle : mesh->triangles) {
    for (int& v : triangle) {
      if (index[v] < 0) {
        index[v] = static_cast<int>(used.size());
        used.push_back(mesh->vertices[v]);
      }
      v = index[v];
    }
  }
  mesh->vertices = std::move(used);
}

TriangleMesh ReadMesh(const fs::path& file, std::string_view bytes) {
  const std::string kind = LowerExtension(file);
  if (kind == ".stl") return internal::ReadStl(file, bytes);
  if (kind == ".obj") return internal::ReadObj(file, bytes);
  if (kind == ".dae") return internal::ReadCollada(file, bytes);
  return internal::ReadPly(file, bytes, internal::PlyPart::kMesh);
}

}  // namespace

TriangleMesh LoadMesh(const fs::path& file, const Vector3d& scale) {
  CheckKind(file);
  const std::string bytes = models::ReadFile(file);
  if (bytes.empty()) Refuse(file, "mesh is empty; got 0 bytes; expected triangles");
  CheckScale(file, scale);
  TriangleMesh mesh = ReadMesh(file, bytes);
  if (mesh.triangles.empty()) Refuse(file, "mesh is empty; got 0 triangles; expected some");
  DropUnused(&mesh);
  for (Vector3d& p : mesh.vertices) p = scale.cwiseProduct(p);
  if (scale.prod() < 0.0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  for (const Vector3d& p : mesh.vertices) {
    if (p.allFinite()) continue;
    Refuse(file, fmt::format("vertex {} is not finite; got ({}, {}, {}); expected numbers",
                             &p - mesh.vertices.data(), p.x(), p.y(), p.z()));
  }
  return mesh;
}

}  // namespace oca::geometry
