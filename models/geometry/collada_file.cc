// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/geometry/collada_file.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "oca/models/geometry/collada_mesh.h"
#include "oca/models/geometry/collada_tree.h"
#include "oca/models/table_text.h"

namespace oca::geometry::internal {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix4d;
using Eigen::Vector3d;

constexpr std::size_t kMostSceneNodes = 20'000;

/// From the eye, the point it looks at and what is up to the frame whose z axis looks back.
Matrix4d LookAt(const std::vector<double>& numbers) {
  const Eigen::Map<const Vector3d> eye(numbers.data()), at(numbers.data() + 3),
      up(numbers.data() + 6);
  const Vector3d z = (eye - at).normalized(), x = up.cross(z).normalized();
  Matrix4d X = Matrix4d::Identity();
  X.block<3, 4>(0, 0) << x, z.cross(x), z, eye;
  return X;
}

/// Walks over the nodes that a scene shows, as often as it shows them.
class ColladaScene {
 public:
  explicit ColladaScene(const ColladaTree& tree) : tree_(tree), meshes_(tree) {}

  TriangleMesh Show() {
    const Matrix4d X_unit = Eigen::Affine3d(Eigen::Scaling(Unit())).matrix();
    Add({VisualScene(), -1, X_unit});
    while (!open_.empty()) {
      const int visit = open_.back();
      open_.pop_back();
      Enter(visit);
    }
    return std::move(mesh_);
  }

 private:
  /// A node shown, in the frame of the file.
  struct Visit {
    int node;
    int parent;  // of visits_
    Matrix4d X;
  };

  double Unit() const {
    const int asset = tree_.Child(0, "asset");
    const int unit = asset < 0 ? -1 : tree_.Child(asset, "unit");
    const std::string_view text =
        models::internal::Trimmed(unit < 0 ? std::string_view() : tree_.Attribute(unit, "meter"));
    if (text.empty()) return 1.0;
    const auto metres = models::internal::ToNumber(text);
    if (metres && std::isfinite(*metres) && *metres > 0.0) return *metres;
    tree_.Refuse(unit, "<unit> meter", models::internal::Shown(text), "a number above 0");
  }

  /// The one that <scene> names; without <scene> the first.
  int VisualScene() const {
    const int scene = tree_.Child(0, "scene");
    if (scene >= 0) {
      const int instance = tree_.Child(scene, "instance_visual_scene");
      if (instance < 0) tree_.Refuse(scene, "shows nothing", "no <instance_visual_scene>", "one");
      return meshes_.Resolve(instance, "url", "visual_scene");
    }
    const int library = tree_.Child(0, "library_visual_scenes");
    const int first = library < 0 ? -1 : tree_.Child(library, "visual_scene");
    if (first < 0) tree_.Refuse(0, "shows nothing", "no <scene>", "one");
    return first;
  }

  void Add(const Visit& visit) {
    if (visits_.size() == kMostSceneNodes) {
      tree_.Refuse(visit.node, "nodes and what their instances repeat", "more",
                   fmt::format("at most {}", kMostSceneNodes));
    }
    visits_.push_back(visit);
    open_.push_back(static_cast<int>(visits_.size()) - 1);
  }

  void Enter(int visit) {
    const int node = visits_[visit].node;
    const std::vector<int> children = tree_.Children(node);
    Matrix4d X = visits_[visit].X;
    for (const int child : children) {
      if (const auto X_child = Transform(child)) X = X * *X_child;
    }
    for (const int child : children) {
      const std::string_view kind = tree_[child].name;
      if (kind == "node") Add({child, visit, X});
      if (kind == "instance_node") Add({InstancedNode(child, visit), visit, X});
      if (kind == "instance_geometry") {
        AddGeometry(child, meshes_.Resolve(child, "url", "geometry"), X);
      }
      if (kind == "instance_controller") AddGeometry(child, SkinnedGeometry(child), X);
    }
  }

  /// Of an element that is one.
  std::optional<Matrix4d> Transform(int element) const {
    const std::string_view kind = tree_[element].name;
    Eigen::Affine3d X = Eigen::Affine3d::Identity();
    if (kind == "matrix") {
      const auto v = FiniteNumbers(element, 16);
      X.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(v.data());
    } else if (kind == "translate") {
      const auto v = FiniteNumbers(element, 3);
      X.translate(Vector3d(v[0], v[1], v[2]));
    } else if (kind == "scale") {
      const auto v = FiniteNumbers(element, 3);
      X.scale(Vector3d(v[0], v[1], v[2]));
    } else if (kind == "rotate") {
      const auto v = FiniteNumbers(element, 4);
      X.rotate(Eigen::AngleAxisd(v[3] * std::numbers::pi / 180.0,
                                 Vector3d(v[0], v[1], v[2]).normalized()));
    } else if (kind == "lookat") {
      X.matrix() = LookAt(FiniteNumbers(element, 9));
    } else if (kind == "skew") {
      tree_.Refuse(element, "transform", "<skew>",
                   "<matrix>, <translate>, <rotate>, <scale> or <lookat>");
    } else {
      return std::nullopt;
    }
    return X.matrix();
  }

  std::vector<double> FiniteNumbers(int element, std::size_t count) const {
    std::vector<double> numbers = ColladaNumbers(tree_, element, count);
    for (const double number : numbers) {
      if (std::isfinite(number)) continue;
      tree_.Refuse(element, fmt::format("<{}>", tree_[element].name), fmt::format("{}", number),
                   "finite numbers");
    }
    return numbers;
  }

  int InstancedNode(int instance, int visit) const {
    const int target = meshes_.Resolve(instance, "url", "node");
    for (int i = visit; i >= 0; i = visits_[i].parent) {
      if (visits_[i].node != target) continue;
      tree_.Refuse(instance, "<instance_node>",
                   fmt::format("'{}', which it is within",
                               models::internal::Shown(tree_.Attribute(target, "id"))),
                   "a node that does not contain itself");
    }
    return target;
  }

  /// Of the shape at rest: what a skin or morph begins with, which may be one again.
  int SkinnedGeometry(int instance) const {
    constexpr int kMostControllers = 8;
    int from = instance;
    std::string_view attribute = "url";
    for (int i = 0; i < kMostControllers; ++i) {
      const std::string_view reference = tree_.Attribute(from, attribute);
      const std::string_view id = reference.starts_with('#') ? reference.substr(1) : "";
      const int controller = meshes_.Find(id, "controller");
      if (controller < 0) return meshes_.Resolve(from, attribute, "geometry");
      from = tree_.Child(controller, "skin");
      if (from < 0) from = tree_.Child(controller, "morph");
      if (from < 0) tree_.Refuse(controller, "moves nothing", "no <skin>", "one");
      attribute = "source";
    }
    tree_.Refuse(instance, "controllers of controllers", "more",
                 fmt::format("at most {}", kMostControllers));
  }

  void AddGeometry(int instance, int geometry, const Matrix4d& X) {
    const TriangleMesh& added = meshes_.Of(geometry);
    constexpr std::size_t kMost = ColladaMeshes::kMost;
    if (mesh_.triangles.size() + added.triangles.size() > kMost ||
        mesh_.vertices.size() + added.vertices.size() > kMost) {
      tree_.Refuse(instance, "triangles with what instances repeat", "more",
                   fmt::format("at most {}", kMost));
    }
    const int first = static_cast<int>(mesh_.vertices.size());
    const Eigen::Affine3d X_affine(X);
    for (const Vector3d& p : added.vertices) mesh_.vertices.push_back(X_affine * p);
    const bool mirrored = X.topLeftCorner<3, 3>().determinant() < 0.0;
    for (auto [a, b, c] : added.triangles) {
      if (mirrored) std::swap(b, c);
      mesh_.triangles.push_back({first + a, first + b, first + c});
    }
  }

  const ColladaTree& tree_;
  ColladaMeshes meshes_;
  std::vector<Visit> visits_;
  std::vector<int> open_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh ReadCollada(const fs::path& file, std::string_view text) {
  const ColladaTree tree(file, text);
  return ColladaScene(tree).Show();
}

}  // namespace oca::geometry::internal
