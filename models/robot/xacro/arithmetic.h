// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "oca/models/robot/xacro/python_value.h"

namespace oca::robot::xacro {

/// `a word b` with word one of + - * / // % **, as Python has it for numbers, texts and lists.
/// throws Mistake for types that have none, a zero to divide by, and results that are too large
PythonValue Calculate(const PythonValue& a, const std::string& word, const PythonValue& b);

/// -value of a number.
PythonValue Negative(const PythonValue& value);

/// `item in container`. throws Mistake if that is no container of such
bool Contains(const PythonValue& container, const PythonValue& item);

}  // namespace oca::robot::xacro
