// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "framework/value.h"

namespace oca::diagrams {

/// Section `key` of a diagram file as a map; an empty one if it is missing, or, with a problem, if
/// it is something else.
const Value::Map& SectionOf(const Value& root, const char* key, Problems& problems);

}  // namespace oca::diagrams
