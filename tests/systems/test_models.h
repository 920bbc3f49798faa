// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "oca/models/robot/urdf.h"
#include "oca/systems/signals/model_set.h"

namespace oca::systems {

/// A robot or a world of the product by the name of its folder, its SRDF included.
inline std::shared_ptr<const robot::RobotModel> LoadTestModel(
    const std::string& name, const Eigen::Isometry3d& X_WB = Eigen::Isometry3d::Identity()) {
  namespace fs = std::filesystem;
  const fs::path models = fs::path(OCA_SOURCE_DIR) / "models";
  const fs::path world = models / "worlds" / name;
  const fs::path folder = fs::exists(world) ? world : models / "robots" / name;
  robot::LoadOptions options;
  options.X_WB = X_WB;
  if (fs::exists(folder / (name + ".srdf"))) options.srdf = folder / (name + ".srdf");
  return std::make_shared<const robot::RobotModel>(
      robot::LoadUrdf(folder / (name + ".urdf"), options));
}

/// The model alone, under its own name.
inline ModelSet TestModels(const std::string& name) {
  ModelSet set;
  set.Add(name, LoadTestModel(name));
  return set;
}

}  // namespace oca::systems
