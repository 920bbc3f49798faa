// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/robot_drawing.h"

#include "oca/models/error.h"
#include "oca/models/geometry/mesh.h"

namespace oca::record {

void DrawLink(const robot::Link& link, SceneEntity& entity) {
  // A picture may lack a part; what the run computes with has been loaded.
  const std::size_t lost = DrawVisuals(link, entity).size();
  if (lost == link.visuals.size()) DrawCollisions(link, {0.62, 0.66, 0.72, 1.0}, entity);
}

std::vector<std::string> DrawVisuals(const robot::Link& link, SceneEntity& entity) {
  std::vector<std::string> lost;
  for (const robot::VisualElement& visual : link.visuals) {
    if (visual.shape) {
      entity.AddShape(*visual.shape, visual.X_LV, visual.colour);
      continue;
    }
    try {
      const geometry::TriangleMesh mesh = geometry::LoadMesh(visual.mesh_file, visual.mesh_scale);
      entity.AddModel(BinaryStl(mesh.vertices, mesh.triangles), "model/stl", visual.X_LV,
                      visual.colour);
    } catch (const models::ModelError& error) {
      lost.emplace_back(error.what());
    }
  }
  return lost;
}

void DrawCollisions(const robot::Link& link, const Colour& colour, SceneEntity& entity) {
  for (const robot::CollisionElement& element : link.collisions) {
    entity.AddShape(element.shape, element.X_LC, colour);
  }
}

}  // namespace oca::record
