// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/mesh.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/file_bytes.h"
#include "oca/models/geometry/collada_check.h"
#include "oca/models/geometry/ply_file.h"
#include "oca/models/table_text.h"

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

/// Gives assimp the bytes of one file and none that it names: materials and pictures have no shape.
class OneFile final : public Assimp::IOSystem {
 public:
  OneFile(std::string name, std::string_view bytes) : name_(std::move(name)), bytes_(bytes) {}
  bool Exists(const char* name) const override { return name == name_; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char* /*mode*/) override {
    if (name != name_) return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes_.data()),
                                      bytes_.size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  const std::string name_;
  const std::string_view bytes_;
};

// assimp computes the size of a binary STL in 32 bits, and makes room for what it announces.
void CheckStlCount(const fs::path& file, std::string_view bytes) {
  constexpr std::uint64_t kHead = 84, kTriangle = 50;
  const std::uint64_t size = bytes.size();
  if (size < kHead) return;
  const std::string_view head = bytes.substr(0, kHead);
  std::uint32_t count = 0;
  std::memcpy(&count, head.data() + kHead - sizeof count, sizeof count);
  const std::uint64_t announced = kHead + kTriangle * count;
  const bool wraps = static_cast<std::uint32_t>(announced) == static_cast<std::uint32_t>(size);
  const auto words = models::internal::Words(head);
  const bool text = !words.empty() && words.front().starts_with("solid");
  if (announced <= size || (text && !wraps)) return;
  Refuse(file, fmt::format("binary STL ends too early; got {} bytes; expected {} for its {} "
                           "triangles",
                           size, announced, count));
}

void CheckScale(const fs::path& file, const Vector3d& scale) {
  if (scale.allFinite() && (scale.array() != 0.0).all()) return;
  Refuse(file, fmt::format("scale; got ({}, {}, {}); expected finite numbers other than 0",
                           scale.x(), scale.y(), scale.z()));
}

// In the words of this project: the path is said before, a stop comes after.
std::string ReasonOf(std::string reason) {
  if (reason.find("STL storage representation") != std::string::npos) {
    return "neither text nor binary STL";
  }
  while (reason.ends_with('.')) reason.pop_back();
  return reason.empty() ? "no scene" : reason;
}

// Appends the triangles of a node and of all below it. The tree of a file may be deep: no
// recursion.
void Collect(const aiScene& scene, const Vector3d& scale, TriangleMesh* result) {
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> open{{scene.mRootNode, aiMatrix4x4()}};
  while (!open.empty()) {
    const auto [node, parent] = open.back();
    open.pop_back();
    const aiMatrix4x4 X = parent * node->mTransformation;
    const bool mirrored = (X.Determinant() < 0) != (scale.prod() < 0);
    for (unsigned m = 0; m < node->mNumMeshes; ++m) {
      const aiMesh& mesh = *scene.mMeshes[node->mMeshes[m]];
      const int offset = static_cast<int>(result->vertices.size());
      for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
        const aiVector3D p = X * mesh.mVertices[i];
        result->vertices.push_back(scale.cwiseProduct(Vector3d(p.x, p.y, p.z)));
      }
      for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
        const aiFace& face = mesh.mFaces[i];
        if (face.mNumIndices != 3) continue;  // points and lines enclose nothing
        std::array<int, 3> corner;
        for (int k = 0; k < 3; ++k) corner[k] = offset + static_cast<int>(face.mIndices[k]);
        if (mirrored) std::swap(corner[1], corner[2]);
        result->triangles.push_back(corner);
      }
    }
    for (unsigned i = 0; i < node->mNumChildren; ++i) open.emplace_back(node->mChildren[i], X);
  }
}

// Vertices that no triangle uses (points, lines) are no part of the surface.
void DropUnused(TriangleMesh* mesh) {
  std::vector<int> index(mesh->vertices.size(), -1);
  std::vector<Vector3d> used;
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

TriangleMesh ReadByAssimp(const fs::path& file, std::string_view bytes, const Vector3d& scale) {
  if (LowerExtension(file) == ".stl") CheckStlCount(file, bytes);
  if (LowerExtension(file) == ".dae") internal::CheckCollada(file, bytes);
  Assimp::Importer importer;
  importer.SetIOHandler(new OneFile(file.string(), bytes));  // the importer deletes it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = nullptr;
  std::string reason;
  try {
    scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
    reason = importer.GetErrorString();
  } catch (const std::bad_alloc&) {  // a hostile size
    reason = "more than the memory holds";
  } catch (const std::exception& error) {
    reason = error.what();
  }
  if (!scene || !scene->mRootNode) {
    Refuse(file, fmt::format("cannot be read as a mesh; got {}; expected STL, OBJ or Collada",
                             ReasonOf(reason)));
  }
  TriangleMesh mesh;
  Collect(*scene, scale, &mesh);
  return mesh;
}

// Not by assimp, which makes room for what the header announces.
TriangleMesh ReadPlyMesh(const fs::path& file, std::string_view bytes, const Vector3d& scale) {
  TriangleMesh mesh = internal::ReadPly(file, bytes, internal::PlyPart::kMesh);
  for (Vector3d& p : mesh.vertices) p = scale.cwiseProduct(p);
  if (scale.prod() < 0.0) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  return mesh;
}

}  // namespace

TriangleMesh LoadMesh(const fs::path& file, const Vector3d& scale) {
  CheckKind(file);
  const std::string bytes = models::ReadFile(file);
  if (bytes.empty()) Refuse(file, "mesh is empty; got 0 bytes; expected triangles");
  CheckScale(file, scale);
  TriangleMesh mesh = LowerExtension(file) == ".ply" ? ReadPlyMesh(file, bytes, scale)
                                                     : ReadByAssimp(file, bytes, scale);
  if (mesh.triangles.empty()) Refuse(file, "mesh is empty; got 0 triangles; expected some");
  DropUnused(&mesh);
  for (const Vector3d& p : mesh.vertices) {
    if (p.allFinite()) continue;
    Refuse(file, fmt::format("vertex {} is not finite; got ({}, {}, {}); expected numbers",
                             &p - mesh.vertices.data(), p.x(), p.y(), p.z()));
  }
  return mesh;
}

}  // namespace oca::geometry
