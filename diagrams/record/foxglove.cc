// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/foxglove.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>
#include <variant>

#include "oca/diagrams/record/message_values.h"
#include "oca/models/geometry/convex_hull.h"
#include "oca/models/json_values.h"

namespace oca::record {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using models::internal::AppendQuoted;

void AppendColour(std::string& out, const Colour& colour) {
  char separator = '{';
  for (int i = 0; i < 4; ++i) {
    out += separator;
    out += '"';
    out += "rgba"[i];
    out += "\":";
    AppendShort(out, colour[i]);
    separator = ',';
  }
  out += '}';
}

void AppendPose(std::string& out, const Isometry3d& pose) {
  out += "{\"position\":";
  AppendXyz(out, pose.translation());
  out += ",\"orientation\":";
  AppendQuaternion(out, Eigen::Quaterniond(pose.linear()));
  out += '}';
}

void AppendMember(std::string& out, std::string_view key, double value) {
  out += ",\"";
  out += key;
  out += "\":";
  AppendShort(out, value);
}

/// Begins an item of a list that holds `list` so far: `{"pose":...`.
void BeginItem(std::string& list, const Isometry3d& pose) {
  list += list.empty() ? "{\"pose\":" : ",{\"pose\":";
  AppendPose(list, pose);
}

void EndItem(std::string& list, const Colour& colour) {
  list += ",\"color\":";
  AppendColour(list, colour);
  list += '}';
}

Isometry3d Offset(const Isometry3d& pose, double z) {
  Isometry3d moved = pose;
  moved.translate(Vector3d(0.0, 0.0, z));
  return moved;
}

}  // namespace

void SceneEntity::Clear() {
  for (std::string* list :
       {&arrows_, &cubes_, &spheres_, &cylinders_, &lines_, &models_, &metadata_}) {
    list->clear();
  }
}

void SceneEntity::AddArrow(const Vector3d& from, const Vector3d& vector, const Colour& colour) {
  const double length = vector.norm();
  if (!(length > 0.0)) return;
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = from;
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), vector).toRotationMatrix();
  const double head = std::min(0.05, 0.4 * length);
  BeginItem(arrows_, pose);
  AppendMember(arrows_, "shaft_length", length - head);
  AppendMember(arrows_, "shaft_diameter", 0.012);
  AppendMember(arrows_, "head_length", head);
  AppendMember(arrows_, "head_diameter", 0.028);
  EndItem(arrows_, colour);
}

void SceneEntity::AddLines(std::span<const Vector3d> points, std::span<const Colour> colours,
                           bool strip) {
  if (points.empty() || colours.empty()) return;
  BeginItem(lines_, Isometry3d::Identity());
  lines_ += strip ? ",\"type\":0" : ",\"type\":2";
  lines_ += ",\"thickness\":2,\"scale_invariant\":true,\"indices\":[],\"points\":";
  char separator = '[';
  for (const Vector3d& point : points) {
    lines_ += separator;
    AppendXyz(lines_, point);
    separator = ',';
  }
  lines_ += "],\"colors\":[";
  for (std::size_t i = 0; colours.size() == points.size() && i < colours.size(); ++i) {
    if (i > 0) lines_ += ',';
    AppendColour(lines_, colours[i]);
  }
  lines_ += ']';
  EndItem(lines_, colours.front());
}

void SceneEntity::AddBox(const Isometry3d& pose, const Vector3d& size, const Colour& colour) {
  BeginItem(cubes_, pose);
  cubes_ += ",\"size\":";
  AppendXyz(cubes_, size);
  EndItem(cubes_, colour);
}

void SceneEntity::AddSphere(const Isometry3d& pose, const Vector3d& size, const Colour& colour) {
  BeginItem(spheres_, pose);
  spheres_ += ",\"size\":";
  AppendXyz(spheres_, size);
  EndItem(spheres_, colour);
}

void SceneEntity::AddCylinder(const Isometry3d& pose, double radius, double length,
                              double top_scale, const Colour& colour) {
  BeginItem(cylinders_, pose);
  cylinders_ += ",\"size\":";
  AppendXyz(cylinders_, Vector3d(2.0 * radius, 2.0 * radius, length));
  cylinders_ += ",\"bottom_scale\":1";
  AppendMember(cylinders_, "top_scale", top_scale);
  EndItem(cylinders_, colour);
}

void SceneEntity::AddShape(const geometry::Shape& shape, const Isometry3d& X_FS,
                           const Colour& colour) {
  std::visit(
      [&](const auto& solid) {
        using Solid = std::decay_t<decltype(solid)>;
        if constexpr (std::is_same_v<Solid, geometry::Sphere>) {
          AddSphere(X_FS, Vector3d::Constant(2.0 * solid.radius), colour);
        } else if constexpr (std::is_same_v<Solid, geometry::Ellipsoid>) {
          AddSphere(X_FS, 2.0 * solid.radii, colour);
        } else if constexpr (std::is_same_v<Solid, geometry::Box>) {
          AddBox(X_FS, solid.size, colour);
        } else if constexpr (std::is_same_v<Solid, geometry::Cylinder>) {
          AddCylinder(X_FS, solid.radius, solid.length, 1.0, colour);
        } else if constexpr (std::is_same_v<Solid, geometry::Cone>) {
          AddCylinder(X_FS, solid.radius, solid.length, 0.0, colour);
        } else if constexpr (std::is_same_v<Solid, geometry::Capsule>) {
          AddCylinder(X_FS, solid.radius, solid.length, 1.0, colour);
          for (const double side : {-0.5, 0.5}) {
            AddSphere(Offset(X_FS, side * solid.length), Vector3d::Constant(2.0 * solid.radius),
                      colour);
          }
        } else if constexpr (std::is_same_v<Solid, geometry::ConvexMesh>) {
          AddModel(BinaryStl(solid.hull->vertices, solid.hull->triangles), "model/stl", X_FS,
                   colour);
        } else if constexpr (std::is_same_v<Solid, geometry::HalfSpace>) {
          constexpr double kDrawn = 6.0;  // m; a piece of the surface
          AddBox(Offset(X_FS, -0.005), {kDrawn, kDrawn, 0.01}, colour);
        } else {
          for (const auto& part : solid.parts) AddShape(part.shape, X_FS * part.X_SP, colour);
        }
      },
      shape);
}

void SceneEntity::AddModel(std::string_view bytes, std::string_view media_type,
                           const Isometry3d& X_FM, const Colour& colour) {
  BeginItem(models_, X_FM);
  models_ += ",\"scale\":{\"x\":1,\"y\":1,\"z\":1},\"override_color\":true,\"url\":\"\"";
  models_ += ",\"media_type\":";
  AppendQuoted(models_, media_type);
  models_ += ",\"data\":\"";
  AppendBase64(models_, bytes);
  models_ += '"';
  EndItem(models_, colour);
}

void SceneEntity::AddMetadata(std::string_view key, std::string_view value) {
  metadata_ += metadata_.empty() ? "{\"key\":" : ",{\"key\":";
  AppendQuoted(metadata_, key);
  metadata_ += ",\"value\":";
  AppendQuoted(metadata_, value);
  metadata_ += '}';
}

void SceneEntity::Append(std::string& out, std::uint64_t time, bool locked) const {
  out += "{\"timestamp\":";
  AppendTime(out, time);
  out += ",\"frame_id\":";
  AppendQuoted(out, frame_);
  out += ",\"id\":";
  AppendQuoted(out, id_);
  out += ",\"lifetime\":{\"sec\":0,\"nsec\":0},\"frame_locked\":";
  out += locked ? "true" : "false";
  out += ",\"triangles\":[],\"texts\":[]";
  const std::array<std::pair<const char*, const std::string*>, 7> lists{{{"metadata", &metadata_},
                                                                         {"arrows", &arrows_},
                                                                         {"cubes", &cubes_},
                                                                         {"spheres", &spheres_},
                                                                         {"cylinders", &cylinders_},
                                                                         {"lines", &lines_},
                                                                         {"models", &models_}}};
  for (const auto& [key, list] : lists) {
    out += ",\"";
    out += key;
    out += "\":[";
    out += *list;
    out += ']';
  }
  out += '}';
}

void AppendTransform(std::string& out, std::uint64_t time, std::string_view child,
                     const Isometry3d& X_WF) {
  out += "{\"timestamp\":";
  AppendTime(out, time);
  out += ",\"parent_frame_id\":\"world\",\"child_frame_id\":";
  AppendQuoted(out, child);
  out += ",\"translation\":";
  AppendXyz(out, X_WF.translation());
  out += ",\"rotation\":";
  AppendQuaternion(out, Eigen::Quaterniond(X_WF.linear()));
  out += '}';
}

std::string LogMessage(std::uint64_t time, int level, std::string_view text) {
  std::string out = "{\"timestamp\":";
  AppendTime(out, time);
  out += ",\"level\":" + std::to_string(level) + ",\"message\":";
  AppendQuoted(out, text);
  out += ",\"name\":\"oca\",\"file\":\"\",\"line\":0}";
  return out;
}

std::string BinaryStl(std::span<const Vector3d> vertices,
                      std::span<const std::array<int, 3>> triangles) {
  std::string out(80, ' ');  // a heading that must not begin with `solid`
  const auto append = [&out](const auto& number) {
    out.append(reinterpret_cast<const char*>(&number), sizeof number);
  };
  append(static_cast<std::uint32_t>(triangles.size()));
  for (const auto& [a, b, c] : triangles) {
    const Vector3d normal = (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
    for (const Vector3d& v :
         {Vector3d(normal.normalized()), vertices[a], vertices[b], vertices[c]}) {
      for (const double x : v) append(static_cast<float>(x));
    }
    append(std::uint16_t{0});
  }
  return out;
}

}  // namespace oca::record
