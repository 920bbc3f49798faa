// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the parameter types.

#include <nlohmann/json.hpp>
#include <string>

#include "framework/params.h"

namespace oca::internal {

/// Adds `where: got X; expected Y`.
void AddMismatch(const Value& value, const std::string& where, const std::string& expected,
                 Problems& problems);

/// Reads a finite number within the field's bounds; false, with a problem, if it is none.
bool ReadNumber(const Value& value, const FieldInfo& field, const std::string& where, double& out,
                Problems& problems);

/// JSON Schema of a number within the field's bounds.
nlohmann::ordered_json NumberSchema(const FieldInfo& field, const char* type = "number");

/// Infinity and NaN, which mean none and unset, are null: JSON has no word for them.
std::string ShowNumber(double number);

}  // namespace oca::internal
