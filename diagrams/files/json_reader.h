// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "oca/framework/dataflow/value.h"

namespace oca::files {

/// Reads JSON into the tree that YAML is read into; every node stands at `name`.
/// throws ConfigError saying where it breaks off, for duplicate keys and for null.
Value ReadJson(std::string_view text, const std::string& name);

}  // namespace oca::files
