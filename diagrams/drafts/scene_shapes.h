// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "oca/models/scenes/planning_scene.h"

namespace oca::drafts::internal {

/// What a diagram file has of a solid, and where: in the frame of the object.
struct SolidText {
  std::string shape{};  ///< {type: ...}
  Eigen::Isometry3d X_OS{Eigen::Isometry3d::Identity()};
  bool convex{true};  ///< it may be part of a compound
};

/// An obstacle or a held object of a diagram file.
struct BodyText {
  std::string id{};
  std::string shape{};
  Eigen::Isometry3d X_OB{Eigen::Isometry3d::Identity()};  ///< in the frame of the object
};

/// {xyz: ..., quaternion: ...}, without a rotation that is none.
std::string PoseText(const Eigen::Isometry3d& X);
std::string NumbersText(const Eigen::Ref<const Eigen::VectorXd>& numbers);

/// Makes what a diagram file has of the objects of a scene.
class SceneShapes {
 public:
  struct Options {
    std::filesystem::path diagram{};  ///< mesh files go beside it
    std::filesystem::path scene{};    ///< relative resources start at it
    /// Where a package is.
    std::function<std::filesystem::path(const std::string& package)> find_package{};
    std::function<void(const std::string& line)> told{};
  };
  explicit SceneShapes(Options options) : options_(std::move(options)) {}

  /// One body, a compound of them, or, where one is not convex, several of their own. `p_W` is a
  /// point, in the frame of the object, on the free side of planes.
  std::vector<BodyText> BodiesOf(const scenes::SceneObject& object, const Eigen::Vector3d& p_O);
  /// The mesh files that were written.
  const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  SolidText TextOf(const scenes::SceneObject& object, const scenes::SceneBody& body,
                   const Eigen::Vector3d& p_O);
  SolidText MeshText(const std::filesystem::path& file, const std::string& named,
                     const std::string& where);
  SolidText PlaneText(const scenes::SceneObject& object, const scenes::SceneBody& body,
                      const scenes::ScenePlane& plane, const Eigen::Vector3d& p_O);
  std::filesystem::path FileOf(const scenes::MeshResource& resource,
                               const std::string& where) const;
  std::filesystem::path Keep(const std::string& id, const geometry::TriangleMesh& mesh);
  /// The id, or, if it is taken, with a number behind it.
  std::string Unused(const std::string& id);

  Options options_;
  std::vector<std::filesystem::path> files_;
  std::set<std::string> ids_;
};

}  // namespace oca::drafts::internal
