// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace oca::internal {

/// Of a system or a port, so that paths and files can say it. `what` it is: "system".
/// throws WiringError unless it is made of letters, digits and underscores, one at least
void CheckName(const std::string& name, const char* what);
/// The same of names with dots between them.
void CheckPath(const std::string& path, const char* what);

}  // namespace oca::internal
