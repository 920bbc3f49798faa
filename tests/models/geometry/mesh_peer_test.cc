// SPDX-License-Identifier: BSD-3-Clause
// Meshes as LoadMesh reads them beside those that assimp makes of the same files.
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "oca/models/error.h"
#include "oca/models/geometry/mesh.h"

// What assimp 5.2 leaks itself is no fault of ours.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }

namespace oca::geometry {
namespace mesh_peer_test {

using Eigen::Vector3d;

struct Measured {
  std::size_t triangles{0};
  Eigen::AlignedBox3d bounds;
  double volume{0.0};  // m^3, signed

  void Add(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    ++triangles;
    for (const Vector3d& p : {a, b, c}) bounds.extend(p);
    volume += a.dot(b.cross(c)) / 6.0;
  }
};

std::optional<Measured> Ours(const std::filesystem::path& file) {
  try {
    const TriangleMesh mesh = LoadMesh(file);
    Measured measured;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto at = [&mesh](int i) { return mesh.vertices[static_cast<std::size_t>(i)]; };
      measured.Add(at(a), at(b), at(c));
    }
    return measured;
  } catch (const models::ModelError&) {
    return std::nullopt;
  }
}

void AddNode(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent, Measured& into) {
  const aiMatrix4x4 X = parent * node.mTransformation;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const aiFace& face = mesh.mFaces[k];
      if (face.mNumIndices != 3) continue;  // a point or a line
      Vector3d corners[3];
      for (int j = 0; j < 3; ++j) {
        const aiVector3D p = X * mesh.mVertices[face.mIndices[j]];
        corners[j] = Vector3d(p.x, p.y, p.z);
      }
      into.Add(corners[0], corners[1], corners[2]);
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) AddNode(scene, *node.mChildren[i], X, into);
}

std::optional<Measured> Assimps(const std::filesystem::path& file) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* const scene = importer.ReadFile(file.string(), aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) return std::nullopt;
  Measured measured;
  AddNode(*scene, *scene->mRootNode, aiMatrix4x4(), measured);
  return measured;
}

TEST(MeshPeerTest, AssimpMakesTheSameOfWhatBothTake) {
  std::map<std::string, int> compared;
  for (const char* folder : {"models/robots", "tests/fuzz/corpus", "tests/models"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(
             std::filesystem::path(OCA_SOURCE_DIR) / folder)) {
      const std::filesystem::path& file = entry.path();
      const std::string kind = file.extension().string();
      if (kind != ".stl" && kind != ".obj" && kind != ".dae") continue;
      const auto ours = Ours(file);
      if (!ours) continue;  // what is refused here may hang or crash there
      const auto theirs = Assimps(file);
      if (!theirs || theirs->triangles == 0) continue;
      SCOPED_TRACE(file.string());
      ++compared[kind];
      const double size = ours->bounds.diagonal().norm();
      EXPECT_EQ(ours->triangles, theirs->triangles);
      EXPECT_LT((ours->bounds.min() - theirs->bounds.min()).norm(), 1e-5 * size);
      EXPECT_LT((ours->bounds.max() - theirs->bounds.max()).norm(), 1e-5 * size);
      EXPECT_NEAR(ours->volume, theirs->volume, 1e-5 * size * size * size);
    }
  }
  for (const char* kind : {".stl", ".obj", ".dae"}) EXPECT_GE(compared[kind], 1) << kind;
}

}  // namespace mesh_peer_test
}  // namespace oca::geometry
