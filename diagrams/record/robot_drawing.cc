// SPDX-License-Identifier: BSD-3-Clause
#include "oca/diagrams/record/robot_drawing.h"

#include "oca/models/error.h"
#include "oca/models/geometry/mesh.h"

namespace oca::record {

void DrawLink(const robot::Link& link, SceneEntity& entity) {
  bool drawn = false;
  for (const robot::VisualElement& visual : link.visuals) {
    if (visual.shape) {
      entity.AddShape(*visual.shape, visual.X_LV, visual.colour);
      drawn = true;
      continue;
    }
    try {
      const geometry::TriangleMesh mesh = geometry::LoadMesh(visual.mesh_file, visual.mesh_scale);
      entity.AddModel(BinaryStl(mesh.vertices, mesh.triangles), "model/stl", visual.X_LV,
                      visual.colour);
      drawn = true;
    } catch (const models::ModelError&) {
      // A picture may lack a part; what the run computes with has been loaded.
    }
  }
  if (drawn) return;
  for (const robot::CollisionElement& element : link.collisions) {
    entity.AddShape(element.shape, element.X_LC, {0.62, 0.66, 0.72, 1.0});
  }
}

}  // namespace oca::record
