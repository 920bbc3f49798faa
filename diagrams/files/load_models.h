// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "oca/diagrams/files/diagram_file.h"
#include "oca/diagrams/files/package_paths.h"
#include "oca/systems/signals/model_set.h"

namespace oca::files {

/// Takes what there is to know of a model that was loaded, a line each.
using Warn = std::function<void(const std::string& line)>;

/// The robots of a diagram that is made in C++, by name, each as an entry of section `models`:
///
///     const auto models = LoadModels({{"arm", {.urdf = "package://ur5e/ur5e.urdf"}}});
///
/// Files are looked up from where the program runs; `package://NAME/` in OCA_PACKAGE_PATH, then
/// among the models that come with OCA, then near the robot's file (PackageFor).
/// throws ConfigError if a name is taken, a package is not found or a parameter is wrong;
///        ModelError if a file cannot be read
systems::ModelSet LoadModels(const std::vector<std::pair<std::string, ModelParams>>& models,
                             const Warn& warn = {});

/// One of them, its files being paths. `where` begins the messages about parameters and the lines
/// of `warn`; `packages` are looked in first, PackageFor the robot last if `near_robot`. It is
/// found as it was read (models::FileCache) if nothing but its place differs.
std::shared_ptr<const robot::RobotModel> LoadModel(const std::string& where,
                                                   const ModelParams& params,
                                                   const PackageMap& packages, const Warn& warn,
                                                   bool near_robot = false);

}  // namespace oca::files
