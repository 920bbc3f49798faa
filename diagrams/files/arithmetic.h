// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>

#include "oca/framework/dataflow/error_base.h"

namespace oca::files {

/// Letters, digits and underscores, no digit first.
bool IsName(const std::string& text);
/// Whether arithmetic takes a name for something of its own: pi, deg, true, false or a function.
bool IsReserved(const std::string& name);
/// The words of an expression that may be names, those of functions among them.
std::set<std::string> NamesIn(const std::string& expression);

struct ArithmeticResult {
  double number;
  int count;  ///< of values, of which `number` is the last
};

/// What is wrong with an expression.
struct ArithmeticError : Error {
  ArithmeticError(const std::string& what, std::string unknown_name)
      : Error(what), unknown(std::move(unknown_name)) {}
  const std::string unknown;  ///< a name that has no number; empty: something else is wrong
};

/// Works out `a + 2 * sin(b)` and the like with numbers for the names in it. A models::FileCache in
/// use keeps results, for to read an expression takes longer than most that is done with it.
/// throws ArithmeticError
ArithmeticResult Calculate(const std::string& expression,
                           const std::map<std::string, double>& numbers);

}  // namespace oca::files
