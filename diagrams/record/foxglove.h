// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "oca/models/geometry/shape.h"

namespace oca::record {

// Messages that Foxglove and Lichtblick know by name, as JSON. Lengths m, colours in [0, 1].
// source https://docs.foxglove.dev/docs/visualization/message-schemas

/// JSON Schema of `foxglove.FrameTransforms`, `foxglove.SceneUpdate` or `foxglove.Log`.
std::string FoxgloveSchema(std::string_view name);

using Colour = Eigen::Vector4d;  ///< red, green, blue, alpha

/// One entity of a SceneUpdate: primitives in a frame. Text is gathered a kind at a time and put
/// together by Append.
class SceneEntity {
 public:
  SceneEntity(std::string id, std::string frame) : id_(std::move(id)), frame_(std::move(frame)) {}

  void Clear();
  void AddArrow(const Eigen::Vector3d& from, const Eigen::Vector3d& vector, const Colour& colour);
  /// Segments between `points` in pairs, or a line through all of them; a colour a point or one.
  void AddLines(std::span<const Eigen::Vector3d> points, std::span<const Colour> colours,
                bool strip);
  /// The shape at pose X_FS in the entity's frame.
  void AddShape(const geometry::Shape& shape, const Eigen::Isometry3d& X_FS, const Colour& colour);
  /// A model file, `media_type` as in `model/stl`.
  void AddModel(std::string_view bytes, std::string_view media_type, const Eigen::Isometry3d& X_FM,
                const Colour& colour);
  /// Words beside the picture.
  void AddMetadata(std::string_view key, std::string_view value);
  /// Appends the entity as JSON. It stays until another one of its id comes, and moves with its
  /// frame if `locked`.
  void Append(std::string& out, std::uint64_t time, bool locked) const;
  const std::string& id() const { return id_; }

 private:
  void AddBox(const Eigen::Isometry3d& pose, const Eigen::Vector3d& size, const Colour& colour);
  void AddSphere(const Eigen::Isometry3d& pose, const Eigen::Vector3d& size, const Colour& colour);
  void AddCylinder(const Eigen::Isometry3d& pose, double radius, double length, double top_scale,
                   const Colour& colour);

  std::string id_, frame_;
  std::string arrows_, cubes_, spheres_, cylinders_, lines_, models_, metadata_;
};

/// A transform of a FrameTransforms message, appended; X_WF in the frame `world`.
void AppendTransform(std::string& out, std::uint64_t time, std::string_view child,
                     const Eigen::Isometry3d& X_WF);

/// `level` 1 debug, 2 info, 3 warning, 4 error.
std::string LogMessage(std::uint64_t time, int level, std::string_view text);

/// Triangles as a binary STL file.
std::string BinaryStl(std::span<const Eigen::Vector3d> vertices,
                      std::span<const std::array<int, 3>> triangles);

}  // namespace oca::record
