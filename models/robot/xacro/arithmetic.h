// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/models/robot/xacro/value.h"

namespace oca::robot::xacro {

/// `a word b` with word one of + - * / // % **, as Python has it for numbers, texts and lists.
/// throws Mistake for types that have none, a zero to divide by, and results that are too large
Value Calculate(const Value& a, const std::string& word, const Value& b);

/// -value of a number.
Value Negative(const Value& value);

/// `item in container`. throws Mistake if that is no container of such
bool Contains(const Value& container, const Value& item);

}  // namespace oca::robot::xacro
