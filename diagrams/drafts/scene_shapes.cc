// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/drafts/scene_shapes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "oca/diagrams/drafts/draft_text.h"
#include "oca/diagrams/drafts/robot_reader.h"
#include "oca/framework/dataflow/error.h"
#include "oca/models/error.h"
#include "oca/models/geometry/mesh_surface.h"
#include "oca/models/whole_file.h"

namespace oca::drafts::internal {
namespace {

namespace fs = std::filesystem;

template <class... Parts>
struct Cases : Parts... {
  using Parts::operator()...;
};
template <class... Parts>
Cases(Parts...) -> Cases<Parts...>;

std::string PrimitiveText(const geometry::Shape& shape) {
  if (const auto* const box = std::get_if<geometry::Box>(&shape)) {
    return fmt::format("{{type: box, size: {}}}", NumbersText(box->size));
  }
  if (const auto* const sphere = std::get_if<geometry::Sphere>(&shape)) {
    return fmt::format("{{type: sphere, radius: {}}}", sphere->radius);
  }
  if (const auto* const cone = std::get_if<geometry::Cone>(&shape)) {
    return fmt::format("{{type: cone, radius: {}, length: {}}}", cone->radius, cone->length);
  }
  const auto& cylinder = std::get<geometry::Cylinder>(shape);
  return fmt::format("{{type: cylinder, radius: {}, length: {}}}", cylinder.radius,
                     cylinder.length);
}

/// What is less comes from rounding, and nobody would have written it; m, or of a quaternion.
Eigen::VectorXd Rounded(const Eigen::VectorXd& numbers) {
  Eigen::VectorXd rounded = numbers;
  for (double& number : rounded) number = std::round(1e12 * number) / 1e12 + 0.0;
  return rounded;
}

std::string ObjText(const geometry::TriangleMesh& mesh) {
  std::string text;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  return text;
}

}  // namespace

std::string NumbersText(const Eigen::Ref<const Eigen::VectorXd>& numbers) {
  std::vector<std::string> texts;
  for (const double number : numbers) texts.push_back(fmt::format("{}", number));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string PoseText(const Eigen::Isometry3d& X) {
  const std::string xyz = fmt::format("xyz: {}", NumbersText(Rounded(X.translation())));
  Eigen::Quaterniond q(X.linear());
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  const Eigen::VectorXd xyzw = Rounded(q.coeffs());
  if (xyzw.head(3).isZero(0.0)) return fmt::format("{{{}}}", xyz);
  return fmt::format("{{{}, quaternion: {}}}", xyz, NumbersText(xyzw));
}

std::string SceneShapes::Unused(const std::string& id) {
  std::string name = id;
  for (int i = 2; !ids_.insert(name).second; ++i) name = fmt::format("{}_{}", id, i);
  return name;
}

fs::path SceneShapes::Keep(const std::string& id, const geometry::TriangleMesh& mesh) {
  const std::string stem = options_.diagram.stem().string();
  const fs::path folder = options_.diagram.parent_path();
  fs::path file = folder / fmt::format("{}_{}.obj", stem, PlainName(id));
  for (int i = 2; std::find(files_.begin(), files_.end(), file) != files_.end(); ++i) {
    file = folder / fmt::format("{}_{}_{}.obj", stem, PlainName(id), i);
  }
  CheckAbsent(file);
  models::WriteWhole(file, ObjText(mesh));
  files_.push_back(file);
  return file;
}

fs::path SceneShapes::FileOf(const scenes::MeshResource& resource, const std::string& where) const {
  const std::string& name = resource.name;
  constexpr std::string_view kPackage = "package://", kFile = "file://";
  if (name.starts_with(kPackage)) {
    const std::string rest = name.substr(kPackage.size());
    const std::string package = rest.substr(0, rest.find('/'));
    const fs::path folder = options_.find_package(package);
    if (!folder.empty() && rest.size() > package.size()) {
      return folder / rest.substr(package.size() + 1);
    }
    throw models::ModelError(fmt::format(
        "{}: mesh; got package '{}'; expected one that lies beside the robot's file or a folder "
        "above, or in OCA_PACKAGE_PATH",
        where, package));
  }
  const fs::path path = name.starts_with(kFile) ? name.substr(kFile.size()) : name;
  return options_.scene.parent_path() / path;
}

SolidText SceneShapes::MeshText(const fs::path& file, const std::string& named,
                                const std::string& where) {
  SolidText text;
  try {
    text.convex = geometry::LoadMeshHull(file).excess.empty();
  } catch (const models::ModelError& error) {
    throw models::ModelError(fmt::format("{}: {}", where, error.what()));
  }
  text.shape = fmt::format("{{type: mesh, file: {}{}}}", Quoted(named),
                           text.convex ? "" : ", collision: decomposition");
  return text;
}

SolidText SceneShapes::PlaneText(const scenes::SceneObject& object, const scenes::SceneBody& body,
                                 const scenes::ScenePlane& plane, const Eigen::Vector3d& p_O) {
  // A half-space is below its xy plane: z points to where the arm is.
  const Eigen::Vector3d p_B = body.X_OB.inverse() * p_O;
  const double side = plane.normal.dot(p_B) < plane.offset ? -1.0 : 1.0;
  options_.told(
      fmt::format("{}: plane of '{}' became a half-space: all behind it is solid, seen "
                  "from the arm",
                  body.where, object.id));
  SolidText text{"{type: half_space}", body.X_OB, false};
  Eigen::Isometry3d X_BP = Eigen::Isometry3d::Identity();
  X_BP.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), side * plane.normal)
                      .toRotationMatrix();
  X_BP.translation() = plane.offset * plane.normal;
  text.X_OS = body.X_OB * X_BP;
  return text;
}

SolidText SceneShapes::TextOf(const scenes::SceneObject& object, const scenes::SceneBody& body,
                              const Eigen::Vector3d& p_O) {
  SolidText text = std::visit(
      Cases{[](const geometry::Shape& shape) { return SolidText{PrimitiveText(shape)}; },
            [&](const geometry::TriangleMesh& mesh) {
              const fs::path file = Keep(object.id, mesh);
              return MeshText(file, file.filename().string(), body.where);
            },
            [&](const scenes::MeshResource& resource) {
              const fs::path file = FileOf(resource, body.where);
              if (resource.scale == Eigen::Vector3d::Ones()) {
                const bool package = resource.name.starts_with("package://");
                return MeshText(
                    file,
                    package ? resource.name : PathBeside(options_.diagram.parent_path(), file),
                    body.where);
              }
              const fs::path kept = Keep(object.id, geometry::LoadMesh(file, resource.scale));
              return MeshText(kept, kept.filename().string(), body.where);
            },
            [&](const scenes::ScenePlane& plane) { return PlaneText(object, body, plane, p_O); }},
      body.shape);
  if (!std::holds_alternative<scenes::ScenePlane>(body.shape)) text.X_OS = body.X_OB;
  return text;
}

std::vector<BodyText> SceneShapes::BodiesOf(const scenes::SceneObject& object,
                                            const Eigen::Vector3d& p_O) {
  std::vector<SolidText> solids;
  for (const scenes::SceneBody& body : object.bodies) solids.push_back(TextOf(object, body, p_O));
  const bool convex = std::all_of(solids.begin(), solids.end(),
                                  [](const SolidText& solid) { return solid.convex; });
  std::vector<BodyText> bodies;
  if (solids.size() == 1 || !convex) {
    for (const SolidText& solid : solids) {
      bodies.push_back({Unused(object.id), solid.shape, solid.X_OS});
    }
    if (solids.size() > 1) {
      options_.told(fmt::format("{}: object '{}' became {} bodies, the first of its name",
                                object.where, object.id, solids.size()));
    }
    return bodies;
  }
  std::string parts;
  for (const SolidText& solid : solids) {
    parts +=
        fmt::format("\n            - {{shape: {}, pose: {}}}", solid.shape, PoseText(solid.X_OS));
  }
  return {{Unused(object.id), "\n          type: compound\n          parts:" + parts}};
}

}  // namespace oca::drafts::internal
