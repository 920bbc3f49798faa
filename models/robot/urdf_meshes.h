// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace oca::robot {

/// A URDF with the meshes of its links renamed: `rename` is given the name of each, as LoadUrdf
/// reads it, and returns the one to put in its place. What is no mesh of a link, in comments or
/// elements of other tools, stays. The text is the same to the bit if no name changes.
/// throws ModelError as ParseXml does; `where` begins the message
std::string RenameMeshes(const std::string& urdf, const std::string& where,
                         const std::function<std::string(const std::string& name)>& rename);

}  // namespace oca::robot
