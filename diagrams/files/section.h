// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oca/framework/dataflow/value.h"

namespace oca::files {

/// Section `key` of a diagram file as a map; an empty one if it is missing, or, with a problem, if
/// it is something else.
const Value::Map& SectionOf(const Value& root, const char* key, Problems& problems);

}  // namespace oca::files
