// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "oca/models/robot/urdf.h"

namespace oca::robot {

/// The file that a URDF's mesh `name` means: package://NAME/rest as LoadOptions says, file://path,
/// or a path relative to `directory`. `where` begins the message.
/// throws ModelError if there is no such file, with the places looked at
std::filesystem::path FindMesh(const std::string& name, const std::filesystem::path& directory,
                               const LoadOptions& options, const std::string& where);

}  // namespace oca::robot
