// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Private to the parameter types.

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "oca/framework/dataflow/params.h"

namespace oca::internal {

/// `where[i]`
std::string NameOfItem(const std::string& where, std::size_t i);

/// Adds `where: got X; expected Y`.
void AddMismatch(const Value& value, const std::string& where, const std::string& expected,
                 Problems& problems);

/// Reads a finite number within the field's bounds; false, with a problem, if it is none.
bool ReadNumber(const Value& value, const FieldInfo& field, const std::string& where, double& out,
                Problems& problems);

/// Adds to `problems` if the number is not finite, or not within the field's bounds.
void CheckNumber(double number, const FieldInfo& field, const std::string& where,
                 std::vector<std::string>& problems);

/// JSON Schema of a number within the field's bounds.
nlohmann::ordered_json NumberSchema(const FieldInfo& field, const char* type = "number");

/// Whole numbers without a point. Infinity and NaN, which mean none and unset, are null: JSON has
/// no word for them.
nlohmann::ordered_json NumberJson(double number);

}  // namespace oca::internal
