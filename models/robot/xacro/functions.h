// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "oca/models/robot/xacro/budget.h"
#include "oca/models/robot/xacro/python_value.h"

namespace oca::robot::xacro {

/// Of a call.
struct Arguments {
  PythonValue::Items values{};
  std::vector<std::pair<std::string, PythonValue>> named{};
};

/// xacro.NAME, which need to know where they are called.
inline constexpr std::array kXacroFunctions = {"load_yaml", "abs_filename",  "arg",     "dotify",
                                               "tokenize",  "message",       "warning", "error",
                                               "fatal",     "print_location"};

/// Calls a function of Python, or of its module math, that xacro lets expressions use.
/// throws Mistake if there is none of that name, naming those that there are, or the arguments are
/// wrong
PythonValue CallFunction(const std::string& name, const Arguments& arguments, Budget& budget);

/// The same for those of module math that give numbers; nothing if there is none of that name.
std::optional<PythonValue> CallMath(const std::string& name, const Arguments& arguments);
std::vector<std::string> MathFunctions();

/// pi, e, tau, inf and nan.
std::optional<double> ConstantNamed(std::string_view name);

/// Calls a method of a text, list or dictionary. throws Mistake as CallFunction
PythonValue CallMethod(const PythonValue& of, const std::string& name, const Arguments& arguments,
                       Budget& budget);

/// `format % value` of a text.
PythonValue FormatPercent(const std::string& format, const PythonValue& value);

/// The whole number that a float stands for. throws Mistake if 64 bits do not hold it
std::int64_t ToWhole(double number, std::string_view what);
/// As Python's int() and float() of a text; nothing if they refuse it or 64 bits do not hold it.
std::optional<std::int64_t> WholeOf(std::string_view text);
std::optional<double> NumberOf(std::string_view text);

/// Offsets of the characters of a UTF-8 text, and its length at the end.
std::vector<std::size_t> CharacterOffsets(const std::string& text);

/// Refuses other than `least` to `most` arguments, and named ones.
void CheckCount(std::string_view what, const Arguments& arguments, std::size_t least,
                std::size_t most);
double NumberArgument(std::string_view what, const PythonValue& value);
const std::string& TextArgument(std::string_view what, const Arguments& arguments, std::size_t i);

}  // namespace oca::robot::xacro
