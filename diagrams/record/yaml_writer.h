// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/framework/dataflow/value.h"

namespace oca::record {

/// A tree as YAML that ReadYaml reads back to the same values, numbers to the last bit. Maps are
/// indented, lists in brackets; entries without a value are left out.
std::string WriteYaml(const Value& map);

/// One value on one line.
std::string WriteYamlValue(const Value& value);

}  // namespace oca::record
