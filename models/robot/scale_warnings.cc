// SPDX-License-Identifier: BSD-3-Clause
#include "oca/models/robot/scale_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "oca/models/geometry/collider.h"
#include "oca/models/geometry/convex_hull.h"

namespace oca::robot {
namespace {

constexpr double kManyRobots = 10.0;  // a shape so many times as long as the robot is none of it
constexpr double kLargeShape = 10.0;  // m; what is smaller than that may be a tool

/// No point of the shape lies farther from the frame that `X_FS` is given in, m.
double FarthestOf(const geometry::Shape& shape, const Eigen::Isometry3d& X_FS) {
  double farthest = 0.0;
  if (const auto* const mesh = std::get_if<geometry::ConvexMesh>(&shape)) {
    for (const Eigen::Vector3d& vertex : mesh->hull->vertices) {
      farthest = std::max(farthest, (X_FS * vertex).norm());
    }
  } else if (const auto* const compound = std::get_if<geometry::Compound>(&shape)) {
    for (const geometry::CompoundPart& part : compound->parts) {
      farthest = std::max(farthest, FarthestOf(part.shape, X_FS * part.X_SP));
    }
  } else {
    const geometry::Collider collider(shape, "");
    farthest = (X_FS * collider.centre()).norm() + collider.bounding_radius();
  }
  return farthest;
}

}  // namespace

std::vector<std::string> ScaleWarnings(const RobotModel& model) {
  std::vector<double> away(static_cast<std::size_t>(model.num_links()), 0.0);  // along the joints
  std::vector<bool> moves(away.size(), false);
  for (const Joint& joint : model.joints()) {  // parents first
    const auto parent = static_cast<std::size_t>(joint.parent_link);
    const auto child = static_cast<std::size_t>(joint.child_link);
    // What stands, and where the arm stands on it, is the place and not the arm.
    away[child] = moves[parent] ? away[parent] + joint.X_PJ.translation().norm() : 0.0;
    moves[child] = moves[parent] || joint.movable();
  }
  if (std::count(moves.begin(), moves.end(), true) == 0) return {};
  const double longest = *std::max_element(away.begin(), away.end());
  if (longest > kLongestArm) {
    return {fmt::format("the robot is {:.0f} m long; URDF has metres, are these millimetres?",
                        longest)};
  }
  if (longest == 0.0) return {};  // a turntable has the size that it has
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const Link& link = model.links()[i];
    for (const CollisionElement& element : link.collisions) {
      if (!moves[i]) continue;
      const double size = FarthestOf(element.shape, element.X_LC);
      if (size < std::max(kLargeShape, kManyRobots * longest)) continue;
      return {fmt::format(
          "{} reaches {:.0f} m from its link, and the robot is {:.2g} m long; URDF has metres, is "
          "this in millimetres (a mesh: scale=\"0.001 0.001 0.001\")?",
          element.source, size, longest)};
    }
  }
  return {};
}

}  // namespace oca::robot
