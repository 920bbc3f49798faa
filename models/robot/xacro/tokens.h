// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "oca/models/robot/xacro/python_value.h"

namespace oca::robot::xacro {

struct Token {
  enum class Kind { kEnd, kName, kOperator, kConstant };
  Kind kind{Kind::kEnd};
  std::string text{};   ///< as written
  PythonValue value{};  ///< of a constant
};

/// The tokens of an expression, with one of kEnd at the end.
/// throws Mistake for characters, numbers and texts that are none
std::vector<Token> ReadTokens(std::string_view text);

}  // namespace oca::robot::xacro
