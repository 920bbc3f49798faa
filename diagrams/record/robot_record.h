// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "oca/models/robot/robot_model.h"

namespace oca::record {

/// What a model does not know of itself.
struct RobotSource {
  std::string file;                     ///< that it was read from
  std::string srdf{};                   ///< empty: none
  std::vector<std::string> warnings{};  ///< lines of its load
  std::string remedy{};                 ///< how DescribeUnseen ends
};

/// A robot that no run moves, for the page to look at and to move.
struct RobotRecord {
  std::string mcap;                   ///< bytes of a record, see docs/reference/record_format.md
  std::vector<std::string> warnings;  ///< of `source`, of links that distances do not see, of
                                      ///< meshes that cannot be read: what the page lists
};

/// The robot stands at 0, or where its limits let it come nearest to it. On `/robot` stand its
/// links and joints, the pairs of own links that are checked for contact (Clearance), and each
/// warning with the links that it names; on `/tf` and `/scene/robots` what a run shows, save that a
/// link without visuals is not drawn; on `/scene/collisions` the shapes that distances see.
/// throws ModelError for a solid that MakeCollider refuses
RobotRecord RecordRobot(const std::shared_ptr<const robot::RobotModel>& model,
                        const RobotSource& source);

}  // namespace oca::record
