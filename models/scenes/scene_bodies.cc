// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/scenes/scene_bodies.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "oca/models/error.h"
#include "oca/models/nearest_name.h"
#include "oca/models/table_text.h"

namespace oca::scenes::internal {
namespace {

constexpr double kLargestSize = 1e6;  // m; nobody means more

struct PrimitiveKind {
  const char* name;
  const char* number;  // of shape_msgs/SolidPrimitive
  std::size_t sizes;
  const char* meaning;
};
constexpr std::array kKinds{PrimitiveKind{"box", "1", 3, "3 edge lengths"},
                            PrimitiveKind{"sphere", "2", 1, "1, the radius"},
                            PrimitiveKind{"cylinder", "3", 2, "2, height and radius"},
                            PrimitiveKind{"cone", "4", 2, "2, height and radius"}};

[[noreturn]] void Refuse(const std::string& where, std::string_view what, const std::string& got,
                         std::string_view expected) {
  throw models::ModelError(fmt::format("{}: {}; got {}; expected {}", where, what, got, expected));
}

geometry::TriangleMesh MeshOf(const Foreign& tree) {
  geometry::TriangleMesh mesh;
  for (const Foreign& vertex : tree.Get("vertices").Items()) {
    mesh.vertices.push_back(vertex.Vector());
  }
  constexpr std::size_t kMost = 100'000'000;
  for (const Foreign& triangle : tree.Get("triangles").Items()) {
    const Foreign corners = triangle.is_map() ? triangle.Get("vertex_indices") : triangle;
    const auto items = corners.Items();
    if (items.size() != 3) corners.Refuse("3 indices of vertices");
    std::array<int, 3> indices{};
    for (std::size_t i = 0; i < 3; ++i) indices[i] = static_cast<int>(items[i].Count(kMost));
    mesh.triangles.push_back(indices);
  }
  CheckTriangles(mesh, tree.where() + ": " + tree.path());
  return mesh;
}

MeshResource ResourceOf(const Foreign& tree) {
  MeshResource resource{tree.Get("resource").Text()};
  for (const char* key : {"scale", "dimensions"}) {
    const auto scale = tree.Find(key);
    if (!scale) continue;
    resource.scale = scale->Vector();
    if ((resource.scale.array() == 0.0).any()) scale->Refuse("numbers other than 0");
  }
  return resource;
}

/// Shapes of one kind with their poses; MoveIt takes poses that are missing for none at all.
template <class Read>
void AddBodies(const Foreign& object, const char* shapes, const char* poses, const Read& read,
               std::vector<SceneBody>& bodies) {
  const auto shape_list = object.Items(shapes);
  const auto pose_list = object.Items(poses);
  if (!pose_list.empty() && pose_list.size() != shape_list.size()) {
    object.Get(poses).Refuse(fmt::format("{} poses", pose_list.size()),
                             fmt::format("{}, one of each of {}", shape_list.size(), shapes));
  }
  for (std::size_t i = 0; i < shape_list.size(); ++i) {
    SceneBody body{.where = shape_list[i].where()};
    body.shape = read(shape_list[i]);
    if (!pose_list.empty()) body.X_OB = pose_list[i].Pose();
    bodies.push_back(std::move(body));
  }
}

std::vector<SceneFrame> SubframesOf(const Foreign& object) {
  const auto names = object.Texts("subframe_names");
  const auto poses = object.Items("subframe_poses");
  if (names.size() != poses.size()) {
    Refuse(object.where(), object.path() + ": subframes",
           fmt::format("{} names and {} poses", names.size(), poses.size()), "as many of each");
  }
  std::vector<SceneFrame> frames;
  for (std::size_t i = 0; i < names.size(); ++i) {
    frames.push_back({names[i], "", poses[i].Pose(), poses[i].where()});
  }
  // As MotionBenchMaker writes them.
  for (const Foreign& frame : object.Items("subframes")) {
    const auto pose = frame.Find("pose");
    frames.push_back(
        {frame.Get("name").Text(), "", pose ? pose->Pose() : frame.Pose(), frame.where()});
  }
  return frames;
}

void CheckOperation(const Foreign& object) {
  const auto operation = object.Find("operation");
  if (!operation || operation->Text() == "0" || operation->Text() == "add") return;
  operation->Refuse("0 or add: a scene as it is, not what changes it");
}

}  // namespace

geometry::Shape PrimitiveOf(std::string_view type, std::span<const double> sizes,
                            const std::string& where) {
  const std::string word = models::internal::Lower(type);
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const PrimitiveKind& known) {
    return word == known.name || word == known.number;
  });
  if (kind == kKinds.end()) {
    std::vector<std::string> names;
    for (const PrimitiveKind& known : kKinds) names.emplace_back(known.name);
    Refuse(where, "type of primitive", fmt::format("'{}'", models::internal::Shown(type)),
           fmt::format("box, sphere, cylinder or cone, nearest is '{}'",
                       models::NearestName(word, names)));
  }
  if (sizes.size() != kind->sizes) {
    Refuse(where, fmt::format("dimensions of a {}", kind->name),
           fmt::format("{} numbers", sizes.size()), kind->meaning);
  }
  for (const double size : sizes) {
    if (size > 0.0 && size <= kLargestSize) continue;
    Refuse(where, fmt::format("dimensions of a {}", kind->name), fmt::format("{}", size),
           "numbers above 0, in m");
  }
  switch (kind->number[0]) {
    case '1':
      return geometry::Box{{sizes[0], sizes[1], sizes[2]}};
    case '2':
      return geometry::Sphere{sizes[0]};
    case '3':
      return geometry::Cylinder{sizes[1], sizes[0]};
    default:
      return geometry::Cone{sizes[1], sizes[0]};
  }
}

void CheckTriangles(const geometry::TriangleMesh& mesh, const std::string& where) {
  if (mesh.triangles.empty()) Refuse(where, "triangles", "none", "one at least");
  const auto count = static_cast<int>(mesh.vertices.size());
  for (const auto& triangle : mesh.triangles) {
    for (const int index : triangle) {
      if (index >= 0 && index < count) continue;
      Refuse(where, "a triangle", fmt::format("vertex {}", index),
             fmt::format("one of the {} vertices, the first is 0", count));
    }
  }
}

ScenePlane PlaneOf(std::span<const double> coefficients, const std::string& where) {
  if (coefficients.size() != 4) {
    Refuse(where, "plane", fmt::format("{} numbers", coefficients.size()),
           "4: a, b, c, d of a x + b y + c z + d = 0");
  }
  const Eigen::Vector3d normal(coefficients[0], coefficients[1], coefficients[2]);
  const double length = normal.norm();
  const double offset = -coefficients[3] / length;
  if (!std::isfinite(length) || !std::isfinite(offset) || std::fabs(offset) > kLargestSize) {
    Refuse(where, "plane",
           fmt::format("{}, {}, {}, {}", coefficients[0], coefficients[1], coefficients[2],
                       coefficients[3]),
           "a normal a, b, c other than 0");
  }
  return {normal / length, offset};
}

PlacedName FrameOf(const Foreign& tree) {
  const auto header = tree.Find("header");
  const auto id = header ? header->Find("frame_id") : std::nullopt;
  if (!id) return {"", tree.where()};
  PlacedName frame = NameOf(*id);
  if (frame.text.starts_with('/')) frame.text.erase(0, 1);
  return frame;
}

void NoteUnknown(const Foreign& tree, std::initializer_list<std::string_view> known,
                 std::vector<std::string>& notes) {
  for (const std::string& key : tree.Unknown(known)) {
    notes.push_back(fmt::format("{}: not known here, not read", key));
  }
}

SceneObject ObjectOf(const Foreign& tree, std::vector<std::string>& notes) {
  NoteUnknown(
      tree,
      {"header", "pose", "id", "type", "primitives", "primitive_poses", "meshes", "mesh_poses",
       "planes", "plane_poses", "subframe_names", "subframe_poses", "subframes", "operation"},
      notes);
  CheckOperation(tree);
  SceneObject object;
  object.id = tree.Get("id").Text();
  if (object.id.empty()) tree.Get("id").Refuse("a name");
  object.where = tree.where();
  object.frame = FrameOf(tree);
  if (const auto pose = tree.Find("pose")) object.X_FO = pose->Pose();
  AddBodies(
      tree, "primitives", "primitive_poses",
      [](const Foreign& primitive) -> geometry::Shape {
        return PrimitiveOf(primitive.Get("type").Text(), primitive.Get("dimensions").Numbers(),
                           primitive.where() + ": " + primitive.path());
      },
      object.bodies);
  AddBodies(
      tree, "meshes", "mesh_poses",
      [](const Foreign& mesh) -> decltype(SceneBody::shape) {
        if (mesh.Find("resource")) return ResourceOf(mesh);
        return MeshOf(mesh);
      },
      object.bodies);
  AddBodies(
      tree, "planes", "plane_poses",
      [](const Foreign& plane) {
        return PlaneOf(plane.Get("coef").Numbers(), plane.where() + ": " + plane.path());
      },
      object.bodies);
  if (object.bodies.empty()) tree.Refuse("no shape", "primitives, meshes or planes");
  object.subframes = SubframesOf(tree);
  return object;
}

JointPositions JointsOf(const Foreign& robot_state, std::vector<std::string>& notes) {
  JointPositions joints;
  NoteUnknown(robot_state,
              {"joint_state", "multi_dof_joint_state", "attached_collision_objects", "is_diff"},
              notes);
  if (const auto differs = robot_state.Find("is_diff")) joints.differs = differs->Bool();
  if (const auto state = robot_state.Find("joint_state")) {
    const auto names = state->Texts("name");
    const auto positions = state->Numbers("position");
    if (names.size() != positions.size()) {
      state->Refuse(fmt::format("{} names and {} positions", names.size(), positions.size()),
                    "as many of each");
    }
    joints.where = state->where();
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (joints.Find(names[i]) != nullptr) {
        state->Refuse(fmt::format("joint '{}' twice", models::internal::Shown(names[i])),
                      "it once");
      }
      joints.positions.emplace_back(names[i], positions[i]);
    }
  }
  if (const auto state = robot_state.Find("multi_dof_joint_state")) {
    const auto names = state->Texts("joint_names");
    const auto transforms = state->Items("transforms");
    if (names.size() != transforms.size()) {
      state->Refuse(fmt::format("{} names and {} transforms", names.size(), transforms.size()),
                    "as many of each");
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      joints.bases.push_back(
          {names[i], FrameOf(*state).text, transforms[i].Pose(), transforms[i].where()});
    }
  }
  return joints;
}

}  // namespace oca::scenes::internal
