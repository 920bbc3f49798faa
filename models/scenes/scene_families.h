// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "oca/models/random.h"
#include "oca/models/scenes/planning_scene.h"

namespace oca::scenes {

/// Kinds of scenes that arms are judged in: those of MotionBenchMaker.
inline constexpr std::array<std::string_view, 7> kSceneFamilies{
    "bookshelf_small", "bookshelf_tall",  "bookshelf_thin", "box", "cage",
    "table_pick",      "table_under_pick"};

/// Furniture, and what shall be grasped.
struct FurnishedScene {
  std::vector<SceneObject> objects{};
  Eigen::Isometry3d X_WF{Eigen::Isometry3d::Identity()};  ///< x away from the arm, z up
  Eigen::Vector3d target{Eigen::Vector3d::Zero()};        ///< its middle, world, m
  double target_radius{0.0};                              ///< m; about its axis
  double target_height{0.0};                              ///< m
  /// From where a hand comes, world: into a shelf, or down onto a table.
  Eigen::Vector3d approach{Eigen::Vector3d::UnitX()};
  double table{0.0};         ///< m; height of the table, of families that have one
  bool starts_below{false};  ///< the arm starts below that table
};

/// A scene of a family around an arm that stands at the origin of the world. Lengths go with
/// `scale`, 1 for an arm that reaches 0.9 m from its shoulder. What is drawn comes from `random`.
/// throws ModelError if there is no such family
FurnishedScene Furnish(std::string_view family, double scale, models::Random& random);

}  // namespace oca::scenes
