// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "oca/models/error.h"
#include "oca/models/robot/urdf.h"

namespace oca::robot {

/// The file that a URDF's mesh `name` means: package://NAME/rest as LoadOptions says, file://path,
/// or a path relative to `directory`. `where` begins the message.
/// throws ModelError if there is no such file, with the places looked at
std::filesystem::path FindMesh(const std::string& name, const std::filesystem::path& directory,
                               const LoadOptions& options, const std::string& where);

/// A mesh that a robot cannot be without; `where` begins the message.
struct NeededMesh {
  std::string name, where;
};

/// Adds an error for each that FindMesh does not find, but one for all those of a package that is
/// nowhere.
void CheckMeshes(const std::vector<NeededMesh>& meshes, const std::filesystem::path& directory,
                 const LoadOptions& options, models::ModelErrors& errors);

}  // namespace oca::robot
