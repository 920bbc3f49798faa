// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <urdf_model/model.h>

#include <memory>
#include <string>

namespace oca::robot {

/// Parses URDF text with urdfdom, which prints nothing meanwhile. It drops in silence what it does
/// not know: see ReadUrdfOutline. Safe to call from several threads, one of which then waits.
/// throws ModelError with what urdfdom would have printed as an error; `where` names the file
std::shared_ptr<urdf::ModelInterface> ParseWithUrdfdom(const std::string& text,
                                                       const std::string& where);

}  // namespace oca::robot
