// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "oca/models/robot/xacro/python_value.h"

namespace oca::robot::xacro {

/// The tree of an expression.
struct Expression {
  enum class Kind {
    kConstant,     ///< value
    kName,         ///< text
    kNot,          ///< parts[0]
    kNegative,     ///< parts[0]
    kPositive,     ///< parts[0]
    kArithmetic,   ///< parts[0] text parts[1]
    kComparison,   ///< parts[0] words[0] parts[1] words[1] parts[2] ...
    kAnd,          ///< of all parts
    kOr,           ///< of all parts
    kConditional,  ///< parts[0] if parts[1] else parts[2]
    kList,
    kTuple,
    kDict,       ///< key, value, key, value, ...
    kSubscript,  ///< parts[0][parts[1]]
    kSlice,      ///< parts[0][parts[1]:parts[2]:parts[3]], nullptr where nothing stands
    kAttribute,  ///< parts[0].text
    kCall,       ///< parts[0](parts[1], ...); the last of them have the names in words
  };
  Kind kind{Kind::kConstant};
  PythonValue value{};
  std::string text{};
  std::vector<std::string> words{};
  std::vector<std::unique_ptr<Expression>> parts{};
  int depth{1};
};
using ExpressionPtr = std::unique_ptr<Expression>;

/// Reads the subset of Python's expressions that kExpressionParts says.
/// throws Mistake if it is none of them, longer than 20 000 characters or nested deeper than 100
ExpressionPtr ParseExpression(std::string_view text);

/// What an expression may consist of, for messages.
inline constexpr std::string_view kExpressionParts =
    "numbers, 'texts', [lists], (tuples), {dictionaries}, names, + - * / // % **, comparisons, in, "
    "and, or, not, a if c else b, subscripts, attributes and calls of known functions";

}  // namespace oca::robot::xacro
