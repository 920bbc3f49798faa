// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/value.h"

namespace oca::files {

/// What an unquoted scalar of a YAML file means: true, false, a number or text. `problem` says why
/// it is refused: `no`, `010` and their like, which YAML readers take in surprising ways, null, and
/// numbers that no double can hold.
Value::Data ReadPlainScalar(const std::string& text, std::string& problem);

}  // namespace oca::files
