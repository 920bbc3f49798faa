// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/value.h"

namespace oca::files {

/// Section `key` of a diagram file as a map; an empty one if it is missing, or, with a problem, if
/// it is something else.
const Value::Map& SectionOf(const Value& root, const char* key, Problems& problems);

/// Where a tree has what a message begins with, `key_points[2].position: ...`, as far as it has it;
/// nullptr: it has nothing of that.
const Value* FindSpokenOf(const Value& tree, const std::string& message);

}  // namespace oca::files
